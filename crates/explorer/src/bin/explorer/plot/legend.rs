//! Where a figure's legend hides least: the corner with the fewest points under it.

use plotters::prelude::SeriesLabelPosition;

use super::figure::{Figure, Layer, Shape};
use super::frame::Frame;

/// A corner of the drawing area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Corner {
    right: bool,
    upper: bool,
}

impl Corner {
    /// In the order in which they are taken when they are equally empty.
    const ALL: [Self; 4] = [
        Self {
            right: true,
            upper: true,
        },
        Self {
            right: false,
            upper: true,
        },
        Self {
            right: true,
            upper: false,
        },
        Self {
            right: false,
            upper: false,
        },
    ];

    pub(super) fn position(self) -> SeriesLabelPosition {
        match (self.right, self.upper) {
            (true, true) => SeriesLabelPosition::UpperRight,
            (false, true) => SeriesLabelPosition::UpperLeft,
            (true, false) => SeriesLabelPosition::LowerRight,
            (false, false) => SeriesLabelPosition::LowerLeft,
        }
    }
}

/// Pixels: a letter's width, a line's height, and what mark and border take.
const LETTER: f64 = 7.6;
const LINE: f64 = 20.0;
const BORDER: [f64; 2] = [56.0, 22.0];
/// Steps along a stroke, which may cross a corner without an end in it.
const STEPS: u32 = 8;

/// The corner with the fewest points of the figure in it; `size` is the drawing area's in pixels.
pub(super) fn emptiest_corner(figure: &Figure, frame: &Frame, size: (f64, f64)) -> Corner {
    let labels: Vec<&str> = figure
        .layers
        .iter()
        .filter(|layer| !layer.is_empty())
        .filter_map(|layer| layer.label.as_deref())
        .collect();
    let longest = labels.iter().map(|label| label.chars().count()).max();
    let width = BORDER[0] + LETTER * longest.unwrap_or(0) as f64;
    let height = BORDER[1] + LINE * labels.len() as f64;
    let mut under = [0_usize; 4];
    for point in figure.layers.iter().flat_map(samples) {
        let (x, y) = frame.pixel(point, size);
        for (corner, count) in Corner::ALL.iter().zip(&mut under) {
            let across = if corner.right { size.0 - x } else { x };
            let down = if corner.upper { y } else { size.1 - y };
            let inside = (0.0..width).contains(&across) && (0.0..height).contains(&down);
            *count += usize::from(inside);
        }
    }
    let least = Corner::ALL
        .iter()
        .zip(under)
        .min_by_key(|(_, count)| *count);
    least.map_or(Corner::ALL[0], |(corner, _)| *corner)
}

/// The layer's coordinates, and places along its strokes.
fn samples(layer: &Layer) -> Vec<[f64; 2]> {
    match &layer.shape {
        Shape::Dots { .. } | Shape::Crosses { .. } => layer.coordinates(),
        Shape::Segments { ends, .. } => ends.iter().flat_map(|&[a, b]| along(a, b)).collect(),
        Shape::Line { through, .. } => stroke(through),
        Shape::Polygons { rings, .. } => rings.iter().flat_map(|ring| stroke(ring)).collect(),
    }
}

fn stroke(through: &[[f64; 2]]) -> Vec<[f64; 2]> {
    through
        .windows(2)
        .flat_map(|pair| along(pair[0], pair[1]))
        .collect()
}

fn along(a: [f64; 2], b: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    (0..=STEPS).map(move |step| {
        let share = f64::from(step) / f64::from(STEPS);
        [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(at: Vec<[f64; 2]>) -> Corner {
        // The ends of the diagonal make the frame the unit square.
        let ends = vec![[0.0, 0.0], [1.0, 1.0]];
        let dots = |label: &str, at| Layer::new(label, (0, 0, 0), Shape::Dots { at, radius: 1.0 });
        let figure = Figure {
            layers: vec![dots("ends", ends), dots("cloud", at)],
            ..Figure::default()
        };
        emptiest_corner(&figure, &Frame::around(&figure, 1.0), (600.0, 600.0))
    }

    #[test]
    fn the_legend_goes_where_nothing_is() {
        let (upper_left, lower_right) = (Corner::ALL[1], Corner::ALL[2]);
        assert_eq!(corner(Vec::new()), upper_left);
        assert_eq!(corner(vec![[0.05, 0.95]]), lower_right);
        // Three corners taken twice leave the one of a single point.
        let taken = vec![
            [0.05, 0.95],
            [0.06, 0.95],
            [0.95, 0.05],
            [0.94, 0.05],
            [0.05, 0.05],
        ];
        assert_eq!(corner(taken), Corner::ALL[0]);
    }
}
