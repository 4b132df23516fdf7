//! From points to the profile: project, keep the height band, count into bins.
//!
//! Cost: O(n log(n / bins)) time, 21 n bytes. The result does not depend on the order of the points, not even in
//! its last bit: selections are by value and sums run over fixed point.

use super::band::{Band, Layer};
use super::cells::Cells;
use super::edges::Edges;
use super::polar::Eye;
use super::statistics::{mean, median_of_bits};
use super::survey::Survey;
use super::{PointCounts, RangeProfile, Samples};
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
        Self::of_cleaned(points, &[], virtual_points, agent, plane, config)
    }

    /// The profile of a map that was cleaned: `kept` and `doubtful`, what the cleaning took out, both make the profile,
    /// so that no far point behind a door is lost; what is seen mostly by doubtful points is believed less.
    ///
    /// # Errors
    /// As [`RangeProfile::of_points`].
    pub fn of_cleaned<P: PointLike>(
        kept: &[P],
        doubtful: &[[f64; 3]],
        virtual_points: &[[f64; 3]],
        agent: [f64; 3],
        plane: &AffinePlane,
        config: &ExitConfig,
    ) -> Result<Self, ExitError> {
        config.validate()?;
        let eye = Eye::new(agent, plane)?;
        let edges = Edges::new(config.bins);
        let mut counts = PointCounts {
            given: kept.len() + doubtful.len(),
            ..Default::default()
        };
        let points = || {
            let kept = kept.iter().map(|&point| point.into());
            kept.chain(doubtful.iter().copied())
        };
        let survey = Survey::of(kept, doubtful, (&eye, &edges), &mut counts);
        let band = Band::of(config.band, &survey);
        let mut layers = survey.layers(kept, doubtful, &eye, &band);
        let mut ranges = survey.in_band(&layers);
        counts.used = ranges.len();
        counts.outside_band = layers.iter().flatten().count() - counts.used;
        check_support(&counts, config)?;

        let mean_range = mean(ranges.iter().copied());
        let median_range = median_of_bits(&mut ranges).unwrap_or(f64::INFINITY);
        let radius = match config.rule {
            Rule::Paper(reading) if reading.range_from == RangeFrom::PlaneOrigin => {
                let used = points().zip(&layers);
                let used = used.filter(|(_, layer)| layer.is_some_and(Layer::in_band));
                mean(used.map(|(point, _)| eye.distance_from_origin(point).to_bits()))
            }
            _ => mean_range,
        };
        let closing = closing(virtual_points, &eye, &edges);
        counts.virtual_used = closing.len();
        let taken_out = doubtful_samples(&survey, kept.len(), config.bins);
        counts.hidden = close_doors(&survey, &mut layers, &closing, config.bins);

        let seen = layers.iter().zip(&survey.bins).zip(&survey.ranges);
        let seen =
            seen.filter_map(|((layer, &bin), &range)| Some((bin as usize, (*layer)?, range)));
        let cells = Cells::of(
            config.bins,
            config.quantile,
            seen.chain(closing.iter().copied()),
        );
        Ok(Self {
            plane: *plane,
            agent,
            bins: cells.bins,
            seen: cells.seen,
            level: cells.level,
            any_height: cells.any_height,
            above: cells.above,
            doubtful: taken_out,
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

/// Ranges of the doubtful points, which follow the first `kept` ones.
fn doubtful_samples(survey: &Survey, kept: usize, n: usize) -> Samples {
    let mut ranges = vec![Vec::new(); n];
    for (&bin, &range) in survey.bins.iter().zip(&survey.ranges).skip(kept) {
        if range > 0.0 {
            ranges[bin as usize].push(range.to_bits());
        }
    }
    let mut samples = Samples::with_capacity(n);
    for ranges in &mut ranges {
        ranges.sort_unstable();
        samples.push_sorted(ranges);
    }
    samples
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
fn closing(virtual_points: &[[f64; 3]], eye: &Eye, edges: &Edges) -> Vec<(usize, Layer, f64)> {
    let mut ignored = PointCounts::default();
    let seen = virtual_points.iter().filter_map(|&point| {
        let p = eye.look(point, edges, &mut ignored)?;
        Some((p.bin as usize, Layer::Level, p.range))
    });
    seen.collect()
}

/// Takes away the layers of the points that virtual points hide: a closed door shows nothing behind it.
/// Returns how many of them were in the band.
fn close_doors(
    survey: &Survey,
    layers: &mut [Option<Layer>],
    closing: &[(usize, Layer, f64)],
    n: usize,
) -> usize {
    if closing.is_empty() {
        return 0;
    }
    let mut nearest = vec![f64::INFINITY; n];
    for &(bin, _, range) in closing {
        nearest[bin] = nearest[bin].min(range);
    }
    let mut hidden = 0;
    for ((layer, &bin), &range) in layers.iter_mut().zip(&survey.bins).zip(&survey.ranges) {
        if range > nearest[bin as usize] {
            hidden += usize::from(layer.take().is_some_and(Layer::in_band));
        }
    }
    hidden
}
