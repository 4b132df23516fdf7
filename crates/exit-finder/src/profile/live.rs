//! A profile that follows a changing map: an update costs only the changed points.

use std::f64::consts::TAU;

use super::binning::{Eye, check_support, resolve_band};
use super::statistics::median;
use super::strip::Strip;
use super::{BinStats, PointCounts, RangeProfile};
use crate::config::{ExitConfig, HeightBand};
use crate::error::ExitError;
use crate::plane::AffinePlane;

/// Where a point went, so that it can be taken out again.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Bin { bin: usize, range: f64 },
    NonFinite,
    AtAgent,
    OutsideBand,
}

/// The range profile of a map whose points come, move and go.
///
/// The agent, the plane and the height band stay fixed; the band and its lean are those of the points
/// given at the start. Insert, remove and move: O(points in the bin) each; the statistics of
/// untouched bins are kept.
#[derive(Debug, Clone)]
pub struct LiveProfile {
    eye: Eye,
    plane: AffinePlane,
    agent: [f64; 3],
    config: ExitConfig,
    band: Option<[f64; 2]>,
    strip: Strip,
    widening: f64,
    ranges: Vec<Vec<f64>>,
    stats: Vec<BinStats>,
    counts: PointCounts,
}

impl LiveProfile {
    /// Starts with the points known now. O(n log n).
    ///
    /// # Errors
    /// [`ExitError::Config`], [`ExitError::Agent`]. Too few points are no error here, see
    /// [`LiveProfile::profile`].
    pub fn new(
        points: &[[f64; 3]],
        agent: [f64; 3],
        plane: &AffinePlane,
        config: &ExitConfig,
    ) -> Result<Self, ExitError> {
        config.validate()?;
        let eye = Eye::new(agent, plane)?;
        let mut ignored = PointCounts::default();
        let polar: Vec<_> = points
            .iter()
            .filter_map(|&p| eye.look(p, &mut ignored))
            .collect();
        let (strip, widening) = match config.band {
            HeightBand::Strip(share) => (Strip::of(&polar), share),
            _ => (Strip::default(), 0.0),
        };
        let mut live = Self {
            eye,
            plane: *plane,
            agent,
            config: *config,
            band: resolve_band(config.band, &polar),
            strip,
            widening,
            ranges: vec![Vec::new(); config.bins],
            stats: vec![BinStats::EMPTY; config.bins],
            counts: PointCounts::default(),
        };
        for &point in points {
            if let Place::Bin { bin, range } = live.place(point) {
                live.ranges[bin].push(range);
            }
            live.count(live.place(point), true);
        }
        for bin in 0..config.bins {
            live.ranges[bin].sort_unstable_by(f64::total_cmp);
            live.refresh(bin);
        }
        Ok(live)
    }

    /// Adds a point.
    pub fn insert(&mut self, point: [f64; 3]) {
        let place = self.place(point);
        self.count(place, true);
        if let Place::Bin { bin, range } = place {
            let at = self.ranges[bin].partition_point(|&other| other < range);
            self.ranges[bin].insert(at, range);
            self.refresh(bin);
        }
    }

    /// Takes out a point that was inserted with exactly these coordinates; false when there is none.
    pub fn remove(&mut self, point: [f64; 3]) -> bool {
        let place = self.place(point);
        if let Place::Bin { bin, range } = place {
            let at = self.ranges[bin].partition_point(|&other| other < range);
            if self.ranges[bin].get(at) != Some(&range) {
                return false;
            }
            self.ranges[bin].remove(at);
            self.refresh(bin);
        }
        self.count(place, false);
        true
    }

    /// Moves a point, for example after an optimisation of the map; false when it was not there.
    pub fn relocate(&mut self, from: [f64; 3], to: [f64; 3]) -> bool {
        let found = self.remove(from);
        if found {
            self.insert(to);
        }
        found
    }

    /// The profile of the points held now, for [`crate::exits_of_profile`]. O(points + bins).
    ///
    /// # Errors
    /// [`ExitError::InsufficientMap`].
    pub fn profile(&self) -> Result<RangeProfile, ExitError> {
        check_support(&self.counts, &self.config)?;
        let sum: f64 = self
            .stats
            .iter()
            .filter(|s| s.count > 0)
            .map(|s| s.mean * s.count as f64)
            .sum();
        let mut all: Vec<f64> = self.ranges.iter().flatten().copied().collect();
        let mean_range = sum / self.counts.used.max(1) as f64;
        Ok(RangeProfile {
            plane: self.plane,
            agent: self.agent,
            bins: self.stats.clone(),
            mean_range,
            median_range: median(&mut all).unwrap_or(f64::INFINITY),
            radius: mean_range,
            band: self.band,
            strip: self.strip,
            counts: self.counts,
        })
    }

    fn place(&self, point: [f64; 3]) -> Place {
        let mut skipped = PointCounts::default();
        let Some(p) = self.eye.look(point, &mut skipped) else {
            return if skipped.at_agent > 0 {
                Place::AtAgent
            } else {
                Place::NonFinite
            };
        };
        let height = p.height - self.strip.height_at(p.offset, p.range);
        let widened = self.widening * p.range;
        if self
            .band
            .is_some_and(|[from, to]| height < from.min(-widened) || height > to.max(widened))
        {
            return Place::OutsideBand;
        }
        let n = self.config.bins;
        let bin = ((p.bearing / (TAU / n as f64)) as usize).min(n - 1);
        Place::Bin {
            bin,
            range: p.range,
        }
    }

    fn count(&mut self, place: Place, added: bool) {
        let counts = &mut self.counts;
        let slot = match place {
            Place::Bin { .. } => &mut counts.used,
            Place::NonFinite => &mut counts.non_finite,
            Place::AtAgent => &mut counts.at_agent,
            Place::OutsideBand => &mut counts.outside_band,
        };
        for slot in [slot, &mut counts.given] {
            *slot = if added {
                *slot + 1
            } else {
                slot.saturating_sub(1)
            };
        }
    }

    fn refresh(&mut self, bin: usize) {
        self.stats[bin] = BinStats::of_sorted(&self.ranges[bin], self.config.quantile);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(n: u32) -> Vec<[f64; 3]> {
        (0..n)
            .map(|i| {
                let t = f64::from(i);
                [
                    3.0 * (0.7 * t).sin(),
                    2.0 * (1.1 * t).cos(),
                    0.3 * (0.3 * t).sin(),
                ]
            })
            .collect()
    }

    #[test]
    fn updates_equal_a_rebuild() {
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let config = ExitConfig {
            band: HeightBand::Absolute {
                from: -0.2,
                to: 0.25,
            },
            ..Default::default()
        };
        let points = cloud(500);
        let mut live = LiveProfile::new(&points[..300], [0.0; 3], &plane, &config).unwrap();
        for &point in &points[300..] {
            live.insert(point);
        }
        for &point in &points[100..150] {
            assert!(live.remove(point));
        }
        assert!(live.relocate(points[0], [1.0, 1.0, 0.0]));
        assert!(!live.remove([9.0, 9.0, 0.0]));
        let mut now: Vec<[f64; 3]> = [&points[1..100], &points[150..]].concat();
        now.push([1.0, 1.0, 0.0]);
        let rebuilt = RangeProfile::of_points(&now, &[], [0.0; 3], &plane, &config).unwrap();
        let updated = live.profile().unwrap();
        assert_eq!(updated.bins, rebuilt.bins);
        assert_eq!(updated.counts, rebuilt.counts);
        assert_eq!(updated.median_range, rebuilt.median_range);
        assert!((updated.mean_range - rebuilt.mean_range).abs() < 1e-9);
    }
}
