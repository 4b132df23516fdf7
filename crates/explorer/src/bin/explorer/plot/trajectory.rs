//! Trajectories drawn in the two axes along which they reach farthest.

use super::figure::{Color, Figure, Layer, Shape};

/// A trajectory with its legend.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub(crate) label: String,
    pub(crate) color: Color,
    pub(crate) dashed: bool,
    pub(crate) through: Vec<[f64; 3]>,
}

/// The plane of two of the world's axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AxisPair(usize, usize);

impl AxisPair {
    /// x to the right and z ahead: the ground of a camera's frame.
    pub(crate) const FROM_ABOVE: Self = Self(0, 2);

    /// The two axes of greatest extent, in the order x, y, z.
    pub(crate) fn widest<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for point in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let extent = |axis: &usize| high[*axis] - low[*axis];
        let narrowest = (0..3).min_by(|a, b| extent(a).total_cmp(&extent(b)));
        match narrowest {
            Some(0) => Self(1, 2),
            Some(1) => Self(0, 2),
            _ => Self(0, 1),
        }
    }

    pub(crate) fn project(self, point: &[f64; 3]) -> [f64; 2] {
        [point[self.0], point[self.1]]
    }

    fn names(self, unit: &str) -> [String; 2] {
        [self.0, self.1].map(|axis| format!("{} [{unit}]", ["x", "y", "z"][axis]))
    }
}

/// A figure of trajectories; layers drawn below and above them are added by the caller.
pub(crate) fn figure(
    title: &str,
    subtitle: &str,
    unit: &str,
    axes: AxisPair,
    tracks: &[Track],
) -> Figure {
    let layer = |track: &Track| {
        let through = track.through.iter().map(|point| axes.project(point));
        let shape = Shape::Line {
            through: through.collect(),
            width: if track.dashed { 2.0 } else { 2.4 },
            dashed: track.dashed,
        };
        Layer::new(track.label.clone(), track.color, shape)
    };
    Figure {
        title: title.to_owned(),
        subtitle: subtitle.to_owned(),
        axes: axes.names(unit),
        layers: tracks.iter().map(layer).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_narrowest_axis_is_left_out() {
        let pair = |points: &[[f64; 3]]| AxisPair::widest(points.iter()).names("m");
        assert_eq!(
            pair(&[[0.0, 0.0, 0.0], [3.0, 0.1, 2.0]]),
            ["x [m]", "z [m]"]
        );
        assert_eq!(
            pair(&[[0.0, 0.0, 0.0], [0.1, 3.0, 2.0]]),
            ["y [m]", "z [m]"]
        );
        assert_eq!(pair(&[]), ["y [m]", "z [m]"]);
    }
}
