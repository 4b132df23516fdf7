//! Which part of the plane a figure shows: all that must show, clouds up to percentiles, equal scale.

use core::ops::Range;

use super::figure::{Demand, Figure, Layer};

/// Share of a cloud's coordinates left out at each end of each axis.
const TAIL: f64 = 0.01;
/// Space about everything, as a share of the extent.
const MARGIN: f64 = 0.06;

/// The visible rectangle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Frame {
    pub(crate) x: Range<f64>,
    pub(crate) y: Range<f64>,
}

impl Frame {
    /// The rectangle for a drawing area of this width over height.
    pub(crate) fn around(figure: &Figure, aspect: f64) -> Self {
        let axis = |index: usize| {
            let demanded = extent(figure, index, |layer| layer.demand);
            // A picture of nothing else shows most of what may be cut.
            let range = demanded.or_else(|| extent(figure, index, |_| Demand::Most));
            range.unwrap_or(-1.0..1.0)
        };
        let (x, y) = (axis(0), axis(1));
        let height = (length(&y)).max(length(&x) / aspect).max(1e-6) * (1.0 + 2.0 * MARGIN);
        Self {
            x: about(&x, height * aspect),
            y: about(&y, height),
        }
    }

    /// Where a point lies in a drawing area of this size, pixels from its upper left corner.
    pub(crate) fn pixel(&self, [x, y]: [f64; 2], (width, height): (f64, f64)) -> (f64, f64) {
        let right = (x - self.x.start) / length(&self.x) * width;
        let down = (self.y.end - y) / length(&self.y) * height;
        (right, down)
    }

    pub(crate) fn contains(&self, [x, y]: [f64; 2]) -> bool {
        self.x.contains(&x) && self.y.contains(&y)
    }

    /// How many coordinates of clouds lie outside, and of how many.
    pub(crate) fn clipped(&self, figure: &Figure) -> (usize, usize) {
        let clouds = figure
            .layers
            .iter()
            .filter(|layer| layer.demand != Demand::All);
        let coordinates: Vec<[f64; 2]> = clouds.flat_map(Layer::coordinates).collect();
        let outside = coordinates
            .iter()
            .filter(|point| !self.contains(**point))
            .count();
        (outside, coordinates.len())
    }
}

/// What the layers demand along one axis, if they demand anything.
fn extent(figure: &Figure, axis: usize, demand: impl Fn(&Layer) -> Demand) -> Option<Range<f64>> {
    let mut range = f64::INFINITY..f64::NEG_INFINITY;
    for layer in &figure.layers {
        let values = layer.coordinates().into_iter().map(|point| point[axis]);
        let extent = match demand(layer) {
            Demand::All => extremes(values),
            Demand::Most => percentiles(values.collect()),
            Demand::Nothing => continue,
        };
        range = range.start.min(extent.start)..range.end.max(extent.end);
    }
    (range.start <= range.end).then_some(range)
}

fn length(range: &Range<f64>) -> f64 {
    range.end - range.start
}

fn about(range: &Range<f64>, wanted: f64) -> Range<f64> {
    let middle = f64::midpoint(range.start, range.end);
    middle - wanted / 2.0..middle + wanted / 2.0
}

fn extremes(values: impl Iterator<Item = f64>) -> Range<f64> {
    values
        .filter(|value| value.is_finite())
        .fold(f64::INFINITY..f64::NEG_INFINITY, |r, x| {
            r.start.min(x)..r.end.max(x)
        })
}

fn percentiles(mut values: Vec<f64>) -> Range<f64> {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    let at = |share: f64| values.get((share * last).round() as usize).copied();
    match (at(TAIL), at(1.0 - TAIL)) {
        (Some(low), Some(high)) => low..high,
        _ => f64::INFINITY..f64::NEG_INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::super::figure::Shape;
    use super::*;

    #[test]
    fn what_was_removed_does_not_shrink_the_rest() {
        let dots = |at| Layer::new("", (0, 0, 0), Shape::Dots { at, radius: 1.0 });
        let kept = dots(vec![[0.0, 0.0], [1.0, 1.0]]);
        let removed = dots(vec![[50.0, 0.0]; 100]).may_be_cut();
        let both = Figure {
            layers: vec![kept, removed.clone()],
            ..Figure::default()
        };
        let frame = Frame::around(&both, 1.0);
        assert!(!frame.contains([50.0, 0.0]) && frame.contains([1.0, 1.0]));
        assert_eq!(frame.clipped(&both), (100, 100));
        let alone = Figure {
            layers: vec![removed],
            ..Figure::default()
        };
        assert!(Frame::around(&alone, 1.0).contains([50.0, 0.0]));
    }

    #[test]
    fn an_empty_figure_has_a_frame() {
        let frame = Frame::around(&Figure::default(), 2.0);
        assert_eq!(
            frame.pixel([frame.x.start, frame.y.end], (300.0, 200.0)),
            (0.0, 0.0)
        );
        assert!((length(&frame.x) / length(&frame.y) - 2.0).abs() < 1e-12);
    }
}
