//! From points to the profile: project, keep the height band, count into bins, sort each bin.
//!
//! Cost: O(n log(n / bins)) time, 16 n bytes. The result does not depend on the order of the points,
//! not even in its last bit, because every bin is summed in ascending order.

use std::f64::consts::TAU;

use super::statistics::median;
use super::strip::Strip;
use super::{BinStats, PointCounts, RangeProfile};
use crate::angle::wrap;
use crate::config::{ExitConfig, HeightBand, RangeFrom, Rule};
use crate::error::ExitError;
use crate::plane::AffinePlane;
use crate::points::PointLike;
use crate::vector::is_finite;

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
        let mut counts = PointCounts {
            given: points.len(),
            ..Default::default()
        };
        let mut polar: Vec<Polar> = points
            .iter()
            .filter_map(|&p| eye.look(p.into(), &mut counts))
            .collect();
        let (strip, widening) = match config.band {
            HeightBand::Strip(share) => (Strip::of(&polar), share),
            _ => (Strip::default(), 0.0),
        };
        let band = resolve_band(config.band, &polar);
        counts.outside_band = keep_band(&mut polar, band, &strip, widening);
        counts.used = polar.len();
        check_support(&counts, config)?;

        let mean_range = ordered_mean(polar.iter().map(|p| p.range).collect());
        let radius = match config.rule {
            Rule::Paper(reading) if reading.range_from == RangeFrom::PlaneOrigin => {
                ordered_mean(polar.iter().map(|p| eye.distance_from_origin(p)).collect())
            }
            _ => mean_range,
        };
        let mut ranges: Vec<f64> = polar.iter().map(|p| p.range).collect();
        let median_range = median(&mut ranges).unwrap_or(f64::INFINITY);
        let mut ignored = PointCounts::default();
        let closing: Vec<Polar> = virtual_points
            .iter()
            .filter_map(|&p| eye.look(p, &mut ignored))
            .collect();
        counts.virtual_used = closing.len();
        counts.hidden = close_doors(&mut polar, closing, config.bins);

        let bins = statistics_of(&polar, config);
        Ok(Self {
            plane: *plane,
            agent,
            bins,
            mean_range,
            median_range,
            radius,
            band,
            strip,
            counts,
        })
    }
}

/// A point as the agent sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Polar {
    pub(crate) bearing: f64,
    pub(crate) range: f64,
    pub(crate) height: f64,
    /// Offset from the agent in plane coordinates.
    pub(crate) offset: [f64; 2],
}

/// The agent as the centre of bearings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Eye {
    plane: AffinePlane,
    centre: [f64; 2],
    height: f64,
}

impl Eye {
    pub(crate) fn new(agent: [f64; 3], plane: &AffinePlane) -> Result<Self, ExitError> {
        if !is_finite(agent) {
            return Err(ExitError::Agent { position: agent });
        }
        Ok(Self {
            plane: *plane,
            centre: plane.project(agent),
            height: plane.height(agent),
        })
    }

    /// Distance of a polar point from the plane's origin, in plane coordinates.
    fn distance_from_origin(&self, p: &Polar) -> f64 {
        let (sin, cos) = p.bearing.sin_cos();
        (self.centre[0] + p.range * cos).hypot(self.centre[1] + p.range * sin)
    }

    /// Bearing, range and height of a point; counts it in `counts` when it has none.
    pub(crate) fn look(&self, point: [f64; 3], counts: &mut PointCounts) -> Option<Polar> {
        let q = self.plane.project(point);
        let (dx, dy) = (q[0] - self.centre[0], q[1] - self.centre[1]);
        let squared = dx * dx + dy * dy;
        let height = self.plane.height(point) - self.height;
        if !(squared + height.abs()).is_finite() {
            counts.non_finite += 1;
            return None;
        }
        if squared <= 0.0 {
            counts.at_agent += 1;
            return None;
        }
        Some(Polar {
            bearing: wrap(dy.atan2(dx)),
            range: squared.sqrt(),
            height,
            offset: [dx, dy],
        })
    }
}

pub(crate) fn resolve_band(band: HeightBand, polar: &[Polar]) -> Option<[f64; 2]> {
    match band {
        HeightBand::Off => None,
        HeightBand::Absolute { from, to } => Some([from, to]),
        HeightBand::Relative(share) | HeightBand::Strip(share) => {
            let mut ranges: Vec<f64> = polar.iter().map(|p| p.range).collect();
            let reach = share * median(&mut ranges)?;
            Some([-reach, reach])
        }
    }
}

fn keep_band(
    polar: &mut Vec<Polar>,
    band: Option<[f64; 2]>,
    strip: &Strip,
    widening: f64,
) -> usize {
    let before = polar.len();
    if let Some([from, to]) = band {
        polar.retain(|p| {
            let height = p.height - strip.height_at(p.offset, p.range);
            let widened = widening * p.range;
            height >= from.min(-widened) && height <= to.max(widened)
        });
    }
    before - polar.len()
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

/// Mean in a fixed order, so that permuted input gives the same bits.
///
/// The sum runs over 64-bit fixed point of 2⁻⁴⁰ of the largest value, which is associative.
fn ordered_mean(values: Vec<f64>) -> f64 {
    let largest = values.iter().fold(0.0f64, |m, &v| m.max(v));
    if largest <= 0.0 {
        return 0.0;
    }
    let unit = largest * (-40f64).exp2();
    let inverse = 1.0 / unit;
    let sum: i128 = values
        .iter()
        .map(|&v| i128::from((v * inverse) as i64))
        .sum();
    sum as f64 * unit / values.len() as f64
}

fn bin_of(p: &Polar, n: usize) -> usize {
    ((p.bearing / (TAU / n as f64)) as usize).min(n - 1)
}

/// Adds virtual points at any height and removes the points that they hide: a closed door shows
/// nothing behind it. Returns the number of points removed.
fn close_doors(polar: &mut Vec<Polar>, closing: Vec<Polar>, n: usize) -> usize {
    if closing.is_empty() {
        return 0;
    }
    let mut nearest = vec![f64::INFINITY; n];
    for p in &closing {
        let bin = bin_of(p, n);
        nearest[bin] = nearest[bin].min(p.range);
    }
    let before = polar.len();
    polar.retain(|p| p.range <= nearest[bin_of(p, n)]);
    let hidden = before - polar.len();
    polar.extend(closing);
    hidden
}

fn statistics_of(polar: &[Polar], config: &ExitConfig) -> Vec<BinStats> {
    let n = config.bins;
    let bin_of = |p: &Polar| bin_of(p, n);
    let mut ends = vec![0usize; n + 1];
    for p in polar {
        ends[bin_of(p) + 1] += 1;
    }
    for bin in 0..n {
        ends[bin + 1] += ends[bin];
    }
    let mut cursor = ends.clone();
    let mut ranges = vec![0.0; polar.len()];
    for p in polar {
        let slot = &mut cursor[bin_of(p)];
        ranges[*slot] = p.range;
        *slot += 1;
    }
    (0..n)
        .map(|bin| {
            let own = &mut ranges[ends[bin]..ends[bin + 1]];
            own.sort_unstable_by(f64::total_cmp);
            BinStats::of_sorted(own, config.quantile)
        })
        .collect()
}
