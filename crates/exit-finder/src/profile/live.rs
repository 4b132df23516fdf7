//! A profile that follows a changing map: an update costs only the changed points.

use super::band::{Band, Layer};
use super::binning::check_support;
use super::edges::Edges;
use super::polar::Eye;
use super::running_median::RunningMedian;
use super::samples::Samples;
use super::survey::Survey;
use super::{BinStats, PointCounts, RangeProfile};
use crate::config::ExitConfig;
use crate::error::ExitError;
use crate::plane::AffinePlane;

/// Where a point went, so that it can be taken out again.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Bin {
        bin: usize,
        layer: Layer,
        range: f64,
    },
    NonFinite,
    AtAgent,
}

/// The range profile of a map whose points come, move and go.
///
/// The agent, the plane and the height band stay fixed; the band and its lean are those of the points
/// given at the start. Insert, remove and move: O(points in the bin + log points) each; the statistics of
/// untouched bins are kept.
#[derive(Debug, Clone)]
pub struct LiveProfile {
    eye: Eye,
    edges: Edges,
    plane: AffinePlane,
    agent: [f64; 3],
    config: ExitConfig,
    band: Band,
    /// Bit patterns of the ranges, ascending per bin: those of each layer, in the band, and at any height.
    layers: [Vec<Vec<u64>>; 4],
    seen: Vec<Vec<u64>>,
    any_height: Vec<Vec<u64>>,
    stats: Vec<BinStats>,
    median: RunningMedian,
    counts: PointCounts,
    /// Points whose statistics were taken again, to prove what an update costs.
    #[cfg(test)]
    visited: usize,
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
        let edges = Edges::new(config.bins);
        let mut ignored = PointCounts::default();
        let survey = Survey::of(points, &[], (&eye, &edges), &mut ignored);
        let band = Band::of(config.band, &survey);
        let mut live = Self {
            eye,
            edges,
            plane: *plane,
            agent,
            config: *config,
            band,
            layers: std::array::from_fn(|_| vec![Vec::new(); config.bins]),
            seen: vec![Vec::new(); config.bins],
            any_height: vec![Vec::new(); config.bins],
            stats: vec![BinStats::EMPTY; config.bins],
            median: RunningMedian::default(),
            counts: PointCounts::default(),
            #[cfg(test)]
            visited: 0,
        };
        for &point in points {
            let place = live.place(point);
            if let Place::Bin { bin, layer, range } = place {
                for list in live.lists(bin, layer) {
                    list.push(range.to_bits());
                }
                if layer.in_band() {
                    live.median.insert(range);
                }
            }
            live.count(place, true);
        }
        for bin in 0..config.bins {
            let layers = live.layers.iter_mut().map(|lists| &mut lists[bin]);
            for list in layers.chain([&mut live.seen[bin], &mut live.any_height[bin]]) {
                list.sort_unstable();
            }
            live.refresh(bin);
        }
        Ok(live)
    }

    /// Adds a point.
    pub fn insert(&mut self, point: [f64; 3]) {
        let place = self.place(point);
        self.count(place, true);
        if let Place::Bin { bin, layer, range } = place {
            for list in self.lists(bin, layer) {
                let at = list.partition_point(|&bits| bits < range.to_bits());
                list.insert(at, range.to_bits());
            }
            if layer.in_band() {
                self.median.insert(range);
                self.refresh(bin);
            }
        }
    }

    /// Takes out a point that was inserted with exactly these coordinates; false when there is none, and then nothing has
    /// changed.
    pub fn remove(&mut self, point: [f64; 3]) -> bool {
        let place = self.place(point);
        if !matches!(place, Place::Bin { .. }) && *self.counter(place) == 0 {
            return false;
        }
        if let Place::Bin { bin, layer, range } = place {
            // The list of its own layer tells: a point at another height may share bin and range.
            let own = &self.layers[layer as usize][bin];
            if own.binary_search(&range.to_bits()).is_err() {
                return false;
            }
            for list in self.lists(bin, layer) {
                if let Ok(at) = list.binary_search(&range.to_bits()) {
                    list.remove(at);
                }
            }
            if layer.in_band() {
                self.median.remove(range);
                self.refresh(bin);
            }
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

    /// The profile of the points held now, for [`crate::exits_of_profile`]. O(bins).
    ///
    /// # Errors
    /// [`ExitError::InsufficientMap`].
    pub fn profile(&self) -> Result<RangeProfile, ExitError> {
        check_support(&self.counts, &self.config)?;
        let seen = self.stats.iter().filter(|stats| stats.count > 0);
        let sum: f64 = seen.map(|stats| stats.mean * stats.count as f64).sum();
        let mean_range = sum / self.counts.used.max(1) as f64;
        Ok(RangeProfile {
            plane: self.plane,
            agent: self.agent,
            bins: self.stats.clone(),
            seen: samples(&self.seen),
            level: samples(&self.layers[Layer::Level as usize]),
            any_height: samples(&self.any_height),
            above: samples(&self.layers[Layer::Above as usize]),
            doubtful: samples(&vec![Vec::new(); self.config.bins]),
            mean_range,
            median_range: self.median.median().unwrap_or(f64::INFINITY),
            radius: mean_range,
            band: self.band.heights,
            widening: self.band.widening,
            strip: self.band.strip,
            counts: self.counts,
        })
    }

    fn place(&self, point: [f64; 3]) -> Place {
        let mut skipped = PointCounts::default();
        let Some(p) = self.eye.look(point, &self.edges, &mut skipped) else {
            return if skipped.at_agent > 0 {
                Place::AtAgent
            } else {
                Place::NonFinite
            };
        };
        Place::Bin {
            bin: p.bin as usize,
            layer: self.band.layer_of(p.offset, p.range, p.height),
            range: p.range,
        }
    }

    fn count(&mut self, place: Place, added: bool) {
        let change = |count: &mut usize| {
            *count = if added {
                *count + 1
            } else {
                count.saturating_sub(1)
            };
        };
        change(self.counter(place));
        change(&mut self.counts.given);
    }

    /// What counts the points of this kind.
    fn counter(&mut self, place: Place) -> &mut usize {
        let counts = &mut self.counts;
        match place {
            Place::Bin { layer, .. } if layer.in_band() => &mut counts.used,
            Place::Bin { .. } => &mut counts.outside_band,
            Place::NonFinite => &mut counts.non_finite,
            Place::AtAgent => &mut counts.at_agent,
        }
    }

    /// The lists that hold a point of this bin.
    fn lists(&mut self, bin: usize, layer: Layer) -> impl Iterator<Item = &mut Vec<u64>> {
        let seen = layer.in_band().then_some(&mut self.seen[bin]);
        [
            &mut self.layers[layer as usize][bin],
            &mut self.any_height[bin],
        ]
        .into_iter()
        .chain(seen)
    }

    fn refresh(&mut self, bin: usize) {
        #[cfg(test)]
        {
            self.visited += self.seen[bin].len();
        }
        self.stats[bin] = BinStats::of_sorted(&self.seen[bin], self.config.quantile);
    }
}

fn samples(lists: &[Vec<u64>]) -> Samples {
    let mut samples = Samples::with_capacity(lists.len());
    lists.iter().for_each(|list| samples.push_sorted(list));
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::HeightBand;
    use proptest::prelude::*;

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

    fn level_with_a_band() -> (AffinePlane, ExitConfig) {
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let band = HeightBand::Absolute {
            from: -0.2,
            to: 0.25,
        };
        let config = ExitConfig {
            band,
            ..Default::default()
        };
        (plane, config)
    }

    #[test]
    fn updates_equal_a_rebuild() {
        let (plane, config) = level_with_a_band();
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
        assert_eq!(
            (updated.seen, updated.level, updated.any_height),
            (rebuilt.seen, rebuilt.level, rebuilt.any_height)
        );
        assert_eq!(updated.above, rebuilt.above);
        assert_eq!(updated.counts, rebuilt.counts);
        assert_eq!(updated.median_range, rebuilt.median_range);
        assert!((updated.mean_range - rebuilt.mean_range).abs() < 1e-9);
    }

    #[test]
    fn what_is_not_there_is_not_removed_and_changes_nothing() {
        let (plane, config) = level_with_a_band();
        let mut points = cloud(100);
        points.push([2.0, 0.0, 0.0]);
        points.push([0.0, -1.5, 1.0]);
        let mut live = LiveProfile::new(&points, [0.0; 3], &plane, &config).unwrap();
        let before = live.profile().unwrap();
        // Bin and range of the first ones are those of a point at another height.
        let absent = [
            [2.0, 0.0, 1.0],
            [2.0, 0.0, -1.0],
            [0.0, -1.5, 0.0],
            [0.0, -1.5, -1.0],
            [2.5, 0.0, 0.0],
            [0.0; 3],
            [f64::NAN, 0.0, 0.0],
        ];
        for point in absent {
            assert!(!live.remove(point), "{point:?}");
            assert_eq!(live.profile().unwrap(), before, "{point:?}");
        }
        live.insert([f64::NAN, 0.0, 0.0]);
        assert!(live.remove([f64::NAN, 0.0, 0.0]));
        assert_eq!(live.profile().unwrap(), before);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Two ways to the same numbers: list by list as here, and in two passes with counted cells and merged samples.
        #[test]
        fn inserting_points_equals_binning_them(
            points in prop::collection::vec(prop::array::uniform3(-3.0f64..3.0), 30..900),
            bins in 8usize..120, share in 0.05f64..0.6, kind in 0u8..4,
        ) {
            let plane = AffinePlane::from_up([0.1, 0.2, 1.0], [0.0; 3]).unwrap();
            let band = match kind {
                0 => HeightBand::Off,
                1 => HeightBand::Relative(share),
                2 => HeightBand::Strip(share),
                _ => HeightBand::Absolute { from: -2.0 * share, to: share },
            };
            let config = ExitConfig { bins, band, min_points: 1, ..Default::default() };
            let binned = RangeProfile::of_points(&points, &[], [0.0; 3], &plane, &config);
            let live = LiveProfile::new(&points, [0.0; 3], &plane, &config).unwrap();
            let (Ok(mut binned), Ok(inserted)) = (binned, live.profile()) else {
                return Ok(());
            };
            prop_assert!((binned.mean_range - inserted.mean_range).abs() < 1e-9);
            (binned.mean_range, binned.radius) = (inserted.mean_range, inserted.radius);
            prop_assert_eq!(binned, inserted);
        }
    }

    #[test]
    fn an_update_visits_only_the_bins_it_changes() {
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let points = cloud(20_000);
        let mut live = LiveProfile::new(&points, [0.0; 3], &plane, &ExitConfig::default()).unwrap();
        assert_eq!(live.visited, live.counts.used);
        let bins = live.stats.clone();
        let fullest = bins.iter().map(|stats| stats.count).max().unwrap();
        for (k, &point) in points.iter().enumerate().step_by(997) {
            live.visited = 0;
            assert!(live.relocate(point, points[(k + 1) % points.len()]));
            assert!(live.visited <= 2 * fullest + 1 && live.visited < points.len() / 20);
        }
        let changed = bins.iter().zip(&live.stats).filter(|(a, b)| a != b).count();
        assert!(changed > 0 && changed <= 2 * points.len().div_ceil(997));
    }
}
