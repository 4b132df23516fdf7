//! The strip of elevations that a turning camera saw, and how far it leans.
//!
//! A camera that turns on the spot maps a strip of constant elevation. A monocular map's axes are those
//! of its first frame, which is rarely level, so in the map the strip leans: its slope as a function of
//! the bearing is s(θ) = s₀ + a cos θ + b sin θ, where (a, b) is the tilt of `up` and s₀ the pitch of the
//! camera. The three numbers are fitted to the median slope (height / range) of 36 sectors by iteratively
//! reweighted least squares (L1), with a weak pull of a and b to zero for partial scans.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

const SECTORS: usize = 36;
/// Slopes are counted in cells of less than a degree up to this steepness, steeper ones at the ends.
const CELLS: usize = 256;
const STEEPEST: f64 = 1.5;
/// Sectors with fewer points have no say.
const MIN_POINTS: u32 = 5;
/// Pull of the tilt to zero, in sectors of unit residual.
const PULL: f64 = 1.0;
const ROUNDS: usize = 10;

/// Slope s₀, a, b of the strip, height per range.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Strip {
    /// Slope of the camera's axis, the same in all bearings.
    pub pitch: f64,
    /// Slope towards bearing 0 and towards a quarter turn.
    pub tilt: [f64; 2],
}

impl Strip {
    /// Slope of the middle of the strip in a bearing.
    pub fn slope(&self, bearing_rad: f64) -> f64 {
        let (sin, cos) = bearing_rad.sin_cos();
        self.pitch + self.tilt[0] * cos + self.tilt[1] * sin
    }

    /// Height of the middle of the strip at an offset from the agent.
    pub(crate) fn height_at(&self, offset: [f64; 2], range: f64) -> f64 {
        self.pitch * range + self.tilt[0] * offset[0] + self.tilt[1] * offset[1]
    }
}

/// How many points of each sector have which slope.
pub(crate) struct Slopes {
    n: usize,
    sector_of: Vec<usize>,
    histogram: Vec<[u32; CELLS]>,
}

impl Slopes {
    pub(crate) fn new(n: usize) -> Self {
        let sectors = SECTORS.min(n);
        Self {
            n,
            sector_of: (0..n).map(|bin| bin * sectors / n).collect(),
            histogram: vec![[0; CELLS]; sectors],
        }
    }

    /// Adds a point seen in a bin.
    #[inline]
    pub(crate) fn add(&mut self, bin: u32, slope: f64) {
        let cell = (slope / STEEPEST * 0.5 + 0.5) * CELLS as f64;
        // By way of u32, which takes half the instructions.
        self.histogram[self.sector_of[bin as usize]][(cell as u32 as usize).min(CELLS - 1)] += 1;
    }

    /// The strip; level when there are too few points to tell.
    pub(crate) fn strip(&self) -> Strip {
        let (n, sectors) = (self.n, self.histogram.len());
        // Where bins do not divide evenly among the sectors, a sector lies where its bins lie.
        let start = |sector: usize| (sector * n).div_ceil(sectors) as f64 * TAU / n as f64;
        let samples: Vec<(Vector3<f64>, f64)> = self
            .histogram
            .iter()
            .enumerate()
            .filter_map(|(sector, cells)| {
                let middle = f64::midpoint(start(sector), start(sector + 1));
                let (sin, cos) = middle.sin_cos();
                Some((Vector3::new(1.0, cos, sin), median_slope(cells)?))
            })
            .collect();
        fit(&samples)
    }
}

/// Median of a histogram of slopes, interpolated in its cell; `None` for too few points.
fn median_slope(cells: &[u32; CELLS]) -> Option<f64> {
    let total: u32 = cells.iter().sum();
    if total < MIN_POINTS {
        return None;
    }
    let half = 0.5 * f64::from(total);
    let mut below = 0.0;
    for (cell, &count) in cells.iter().enumerate() {
        if below + f64::from(count) >= half {
            let share = (half - below) / f64::from(count);
            return Some(((cell as f64 + share) / CELLS as f64 - 0.5) * 2.0 * STEEPEST);
        }
        below += f64::from(count);
    }
    None
}

fn fit(samples: &[(Vector3<f64>, f64)]) -> Strip {
    let mut solution = Vector3::zeros();
    let mut weights = vec![1.0; samples.len()];
    for _ in 0..ROUNDS {
        let mut normal = Matrix3::from_diagonal(&Vector3::new(0.0, PULL, PULL));
        let mut right = Vector3::zeros();
        for ((row, slope), weight) in samples.iter().zip(&weights) {
            normal += row * row.transpose() * *weight;
            right += row * (*weight * slope);
        }
        let Some(inverse) = normal.try_inverse() else {
            return Strip::default();
        };
        solution = inverse * right;
        for ((row, slope), weight) in samples.iter().zip(&mut weights) {
            // Residuals below 0.05 (3 degrees) count fully, larger ones by their absolute value.
            *weight = 1.0 / ((row.dot(&solution) - slope).abs() / 0.05).max(1.0);
        }
    }
    if solution.iter().all(|x| x.is_finite()) {
        Strip {
            pitch: solution.x,
            tilt: [solution.y, solution.z],
        }
    } else {
        Strip::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_turn_gives_pitch_and_tilt() {
        let mut slopes = Slopes::new(360);
        for degrees in (0..360u32).step_by(3) {
            let bearing = f64::from(degrees).to_radians();
            let slope = -0.1 + 0.2 * bearing.cos() - 0.15 * bearing.sin();
            (0..9).for_each(|k| slopes.add(degrees, slope + 0.1 * (f64::from(k) - 4.0)));
        }
        let strip = slopes.strip();
        assert!((strip.pitch + 0.1).abs() < 0.02, "{strip:?}");
        assert!((strip.tilt[0] - 0.2).abs() < 0.02 && (strip.tilt[1] + 0.15).abs() < 0.02);
    }

    #[test]
    fn nothing_seen_is_level() {
        assert_eq!(Slopes::new(360).strip(), Strip::default());
    }
}
