//! From points to the profile: project, keep the height band, count into bins.
//!
//! Cost: O(n) time, 60 n bytes. The result does not depend on the order of the points, not even in
//! its last bit: selections are by value and sums run over fixed point.

use super::band::Band;
use super::cells::Cells;
use super::edges::Edges;
use super::polar::{Eye, Polar};
use super::statistics::{mean, median_of_bits};
use super::{PointCounts, RangeProfile};
use crate::config::{ExitConfig, RangeFrom, Rule};
use crate::error::ExitError;
use crate::plane::AffinePlane;
use crate::points::PointLike;

impl RangeProfile {
    /// The profile of `points` around `agent`; virtual points are binned but not averaged.
    ///
    /// # Errors
    /// [`ExitError::Config`], [`ExitError::Agent`], or [`ExitError::InsufficientMap`] when fewer
    /// than `config.min_points` points can be used.
    pub fn of_points<P: PointLike>(
        points: &[P],
        virtual_points: &[[f64; 3]],
        agent: [f64; 3],
        plane: &AffinePlane,
        config: &ExitConfig,
    ) -> Result<Self, ExitError> {
        config.validate()?;
        let eye = Eye::new(agent, plane)?;
        let edges = Edges::new(config.bins);
        let mut counts = PointCounts {
            given: points.len(),
            ..Default::default()
        };
        let mut sight: Vec<Polar> = Vec::with_capacity(points.len());
        for &point in points {
            sight.extend(eye.look(point.into(), &edges, &mut counts));
        }
        let band = Band::of(config.band, &sight, config.bins);
        let (mut seen, mut ranges) = in_band(&sight, &band);
        counts.used = seen.len();
        counts.outside_band = sight.len() - seen.len();
        check_support(&counts, config)?;

        let mean_range = mean(&ranges);
        let median_range = median_of_bits(&mut ranges).unwrap_or(f64::INFINITY);
        let radius = match config.rule {
            Rule::Paper(reading) if reading.range_from == RangeFrom::PlaneOrigin => {
                let kept = sight.iter().filter(|p| band.level_of(p).is_some());
                let distance = |p| eye.distance_from_origin(p).to_bits();
                mean(&kept.map(distance).collect::<Vec<u64>>())
            }
            _ => mean_range,
        };
        let closing = closing(virtual_points, &eye, &edges);
        counts.virtual_used = closing.len();
        counts.hidden = close_doors(&mut seen, closing, config.bins);

        let points = seen.iter().map(|p| (p.bin as usize, p.level, p.range));
        let cells = Cells::of(config.bins, config.quantile, points);
        Ok(Self {
            plane: *plane,
            agent,
            bins: cells.bins,
            seen: cells.seen,
            level: cells.level,
            mean_range,
            median_range,
            radius,
            band: band.heights,
            widening: band.widening,
            strip: band.strip,
            counts,
        })
    }
}

/// A point of the profile.
#[derive(Debug, Clone, Copy)]
struct Seen {
    bin: u32,
    level: bool,
    range: f64,
}

/// The points in the band, and the bits of their ranges.
fn in_band(sight: &[Polar], band: &Band) -> (Vec<Seen>, Vec<u64>) {
    let mut seen = Vec::with_capacity(sight.len());
    let mut ranges = Vec::with_capacity(sight.len());
    for p in sight {
        if let Some(level) = band.level_of(p) {
            let (bin, range) = (p.bin, p.range);
            seen.push(Seen { bin, level, range });
            ranges.push(range.to_bits());
        }
    }
    (seen, ranges)
}

pub(crate) fn check_support(counts: &PointCounts, config: &ExitConfig) -> Result<(), ExitError> {
    if counts.used >= config.min_points.max(1) {
        return Ok(());
    }
    Err(ExitError::InsufficientMap {
        given: counts.given,
        usable: counts.used,
        non_finite: counts.non_finite,
        at_agent: counts.at_agent,
        outside_band: counts.outside_band,
        needed: config.min_points.max(1),
    })
}

/// Virtual points count at any height, so they are level.
fn closing(virtual_points: &[[f64; 3]], eye: &Eye, edges: &Edges) -> Vec<Seen> {
    let mut ignored = PointCounts::default();
    let seen = virtual_points.iter().filter_map(|&point| {
        let p = eye.look(point, edges, &mut ignored)?;
        Some(Seen {
            bin: p.bin,
            level: true,
            range: p.range,
        })
    });
    seen.collect()
}

/// Adds virtual points and removes the points that they hide: a closed door shows nothing behind it.
/// Returns the number of points removed.
fn close_doors(seen: &mut Vec<Seen>, closing: Vec<Seen>, n: usize) -> usize {
    if closing.is_empty() {
        return 0;
    }
    let mut nearest = vec![f64::INFINITY; n];
    for p in &closing {
        let least = &mut nearest[p.bin as usize];
        *least = least.min(p.range);
    }
    let before = seen.len();
    seen.retain(|p| p.range <= nearest[p.bin as usize]);
    let hidden = before - seen.len();
    seen.extend(closing);
    hidden
}
