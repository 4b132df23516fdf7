//! What a map unit is in metres and which way is up, from moves whose metric size was commanded.
//!
//! Input:  displacements in map units, each with the commanded metres and whether the move was vertical or level.
//! Output: metres per map unit, and the unit up vector in the map's frame.
//! Method: scale = median of commanded length over measured length. Up = the direction that level moves least follow and vertical moves
//!         most follow: the smallest eigenvector of Σ d dᵀ (level) − Σ d dᵀ (vertical), the plane fit (A, v) of the
//!         paper's flown triangle (section IV-C) with the climbs as further evidence.
//! Cost:   O(n log n) in the number of moves.
//! Degenerate input: without a usable move the scale is unknown and up is the first camera's up (0, −1, 0).

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Moves shorter than this say little: the drone's and the map's noise are about a centimetre.
const SHORTEST_USABLE_M: f64 = 0.15;

/// No toy drone moves further at one command; squares of far longer ones overflow, and the eigenvalues of what is not finite are
/// sought without end.
const LONGEST_USABLE_M: f64 = 1000.0;

/// Up in the first camera's frame: a camera that looks level has y down.
const CAMERA_UP: Vector3<f64> = Vector3::new(0.0, -1.0, 0.0);

/// Which way a move was commanded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveKind {
    /// Straight up or down.
    Vertical,
    /// At constant height.
    Level,
    /// Anything else: says something about scale alone.
    Slanted,
}

/// Collects commanded moves and what the map made of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Calibration {
    ratios: Vec<f64>,
    level: Matrix3<f64>,
    vertical: Matrix3<f64>,
    climb: Vector3<f64>,
}

impl Calibration {
    /// Adds one finished move: `commanded` in metres, body frame with z up; `measured` in map units. Moves shorter than 0.15 m, longer
    /// than a kilometre or not finite are left out.
    pub fn add(&mut self, commanded: Vector3<f64>, measured: Vector3<f64>) {
        let meters = commanded.norm();
        let units = measured.norm();
        let is_usable = (SHORTEST_USABLE_M..=LONGEST_USABLE_M).contains(&meters)
            && units > f64::EPSILON
            && units.is_finite();
        if !is_usable {
            return;
        }
        self.ratios.push(meters / units);
        // Weighted by the commanded length in metres, so that the map's arbitrary unit does not weigh in.
        let direction = measured / units;
        let scatter = direction * direction.transpose() * (meters * meters);
        match kind(&commanded) {
            MoveKind::Vertical => {
                self.vertical += scatter;
                self.climb += direction * commanded.z;
            }
            MoveKind::Level => self.level += scatter,
            MoveKind::Slanted => {}
        }
    }

    /// How many moves count.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ratios.len()
    }

    /// Whether no move counts yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ratios.is_empty()
    }

    /// Metres per map unit, the median over all moves; `None` before the first usable one.
    #[must_use]
    pub fn meters_per_unit(&self) -> Option<f64> {
        let mut sorted = self.ratios.clone();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.len() / 2;
        let upper = *sorted.get(middle)?;
        if sorted.len() % 2 == 1 {
            return Some(upper);
        }
        Some(0.5 * (upper + sorted.get(middle.wrapping_sub(1)).copied().unwrap_or(upper)))
    }

    /// Unit up vector in the map's frame.
    #[must_use]
    pub fn up(&self) -> Vector3<f64> {
        let prior = if self.climb.norm() > SHORTEST_USABLE_M {
            self.climb.normalize()
        } else {
            CAMERA_UP
        };
        let evidence = self.level - self.vertical;
        // The prior keeps the direction defined while all moves lie on one line.
        let regular =
            evidence - prior * prior.transpose() * (SHORTEST_USABLE_M * SHORTEST_USABLE_M);
        let eigen = SymmetricEigen::new(regular);
        let smallest = eigen.eigenvalues.imin();
        let axis: Vector3<f64> = eigen.eigenvectors.column(smallest).into_owned();
        if axis.dot(&prior) < 0.0 { -axis } else { axis }
    }
}

/// Sorts a commanded move by its slope: within five degrees counts as level or vertical.
fn kind(commanded: &Vector3<f64>) -> MoveKind {
    let level = commanded.xy().norm();
    let climb = commanded.z.abs();
    let slope = 5.0_f64.to_radians().tan();
    if level <= climb * slope {
        MoveKind::Vertical
    } else if climb <= level * slope {
        MoveKind::Level
    } else {
        MoveKind::Slanted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Unit};

    #[test]
    fn recovers_scale_and_up_of_a_tilted_map() {
        let axis = Unit::new_normalize(Vector3::new(0.3, 1.0, -0.2));
        // Body z up to camera −y, then a tilt that nobody told.
        let tilt = Rotation3::from_axis_angle(&axis, 0.7)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), 1.2);
        let scale = 0.4;
        let mut calibration = Calibration::default();
        for commanded in [
            Vector3::new(0.0, 0.0, 0.4),
            Vector3::new(0.0, 0.0, -0.4),
            Vector3::new(0.4, 0.0, 0.0),
            Vector3::new(0.0, 0.5, 0.0),
            Vector3::new(-0.3, -0.3, 0.0),
        ] {
            calibration.add(commanded, tilt * commanded / scale);
        }
        let up = tilt * Vector3::z();
        assert!(
            (calibration.up() - up).norm() < 1e-9,
            "{} against {up}",
            calibration.up()
        );
        assert!((calibration.meters_per_unit().unwrap() - scale).abs() < 1e-12);
    }

    #[test]
    fn knows_nothing_before_the_first_move() {
        let mut calibration = Calibration::default();
        calibration.add(Vector3::new(0.01, 0.0, 0.0), Vector3::new(1.0, 0.0, 0.0));
        calibration.add(
            Vector3::new(f64::NAN, 0.0, 0.0),
            Vector3::new(1.0, 0.0, 0.0),
        );
        for _ in 0..4 {
            calibration.add(Vector3::new(1.3e154, 0.0, 0.0), Vector3::x());
        }
        assert!(calibration.is_empty());
        assert_eq!(calibration.meters_per_unit(), None);
        assert!((calibration.up() - CAMERA_UP).norm() < 1e-12);
    }
}
