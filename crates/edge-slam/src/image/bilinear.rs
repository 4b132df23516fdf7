//! Bilinear interpolation: the pixels around a sub-pixel place, and what they amount to there.
//!
//! The only definition of it: grey values, depth, patches of the trackers and resized images all go through [`Between`].

use super::GrayView;

/// Two neighbours along one axis, and how far a place lies from the first to the second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Between {
    pub(crate) before: usize,
    /// The last pixel is its own neighbour.
    pub(crate) after: usize,
    /// In 0..1.
    pub(crate) share: f64,
}

impl Between {
    /// The neighbours of a place, pixel centres at whole numbers; places beyond the outermost centres count as these, NaN as the
    /// first. `count`, the pixels along the axis, is at least 1.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "clamped to the axis"
    )]
    pub(crate) fn nearest(place: f64, count: usize) -> Self {
        let last = count.saturating_sub(1);
        let place = place.max(0.0).min(last as f64);
        let before = place as usize;
        Self {
            before,
            after: (before + 1).min(last),
            share: place - before as f64,
        }
    }

    /// The neighbours of a place; `None` beyond the outermost centres, and for NaN.
    #[expect(clippy::cast_precision_loss, reason = "sides of images are small")]
    fn inside(place: f64, count: usize) -> Option<Self> {
        let last = count.checked_sub(1)?;
        (place >= 0.0 && place <= last as f64).then(|| Self::nearest(place, count))
    }
}

/// Columns and rows around a place of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neighbourhood {
    column: Between,
    row: Between,
}

impl Neighbourhood {
    /// The pixels around (x, y). `None` outside the centres of the outermost pixels, and for NaN.
    pub(crate) fn of(x: f64, y: f64, width: usize, height: usize) -> Option<Self> {
        let (column, row) = (Between::inside(x, width)?, Between::inside(y, height)?);
        Some(Self { column, row })
    }

    pub(crate) fn columns(&self) -> [usize; 2] {
        [self.column.before, self.column.after]
    }

    pub(crate) fn rows(&self) -> [usize; 2] {
        [self.row.before, self.row.after]
    }

    /// Of the upper left, upper right, lower left and lower right pixel; their sum is 1.
    fn weights(&self) -> [f64; 4] {
        let (a, b) = (self.column.share, self.row.share);
        [(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b]
    }

    /// The value at the place, given those of the four pixels in the order of their weights.
    pub(crate) fn blend(&self, corners: [f64; 4]) -> f64 {
        let weighted = self.weights().into_iter().zip(corners);
        weighted.map(|(weight, value)| weight * value).sum()
    }
}

/// The square of values up to `radius` pixels around a sub-pixel place, row by row; `None` where it leaves the image.
///
/// All of them have the same weights, so that a row is blended at once.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "weights, and sides of images"
)]
pub(crate) fn sample_square(
    view: &GrayView<'_>,
    [x, y]: [f64; 2],
    radius: usize,
    into: &mut Vec<f32>,
) -> Option<()> {
    let reach = radius as f64;
    let (right, bottom) = (view.width() as f64 - 2.0, view.height() as f64 - 2.0);
    if !(x - reach >= 0.0 && y - reach >= 0.0 && x + reach <= right && y + reach <= bottom) {
        return None;
    }
    let near = Neighbourhood::of(x, y, view.width(), view.height())?;
    let (left, top) = (near.column.before - radius, near.row.before - radius);
    let [own, east, south, corner] = near.weights().map(|weight| weight as f32);
    let side = 2 * radius + 1;
    into.clear();
    for row in top..top + side {
        let [upper, lower] = [row, row + 1].map(|row| &view.row(row)[left..=left + side]);
        let right = upper[1..].iter().zip(&lower[1..]);
        let blend = |((p, r), (q, s)): ((&u8, &u8), (&u8, &u8))| {
            let [p, q, r, s] = [p, q, r, s].map(|&grey| f32::from(grey));
            own * p + east * q + (south * r + corner * s)
        };
        into.extend(upper.iter().zip(lower).zip(right).map(blend));
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_plane_is_met_exactly(
            x in 0.0..6.0f64, y in 0.0..4.0f64, slope in prop::array::uniform2(-9.0..9.0f64),
        ) {
            let near = Neighbourhood::of(x, y, 7, 5).unwrap();
            let plane = |x: f64, y: f64| slope[0] * x + slope[1] * y + 2.0;
            let [left, right] = near.columns().map(|k| k as f64);
            let [top, bottom] = near.rows().map(|k| k as f64);
            let corners = [
                plane(left, top), plane(right, top), plane(left, bottom), plane(right, bottom),
            ];
            prop_assert!((near.blend(corners) - plane(x, y)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_last_pixel_is_inside_and_nothing_beyond() {
        let corner = Neighbourhood::of(2.0, 1.0, 3, 2).unwrap();
        assert_eq!((corner.columns(), corner.rows()), ([2, 2], [1, 1]));
        assert_eq!(Neighbourhood::of(2.001, 0.0, 3, 2), None);
        assert_eq!(Neighbourhood::of(0.0, -0.001, 3, 2), None);
        assert_eq!(Neighbourhood::of(f64::NAN, 0.0, 3, 2), None);
        assert_eq!(Neighbourhood::of(0.0, 0.0, 0, 2), None);
    }

    proptest! {
        #[test]
        fn a_square_is_made_of_single_values(
            pixels in prop::collection::vec(0u8.., 17 * 13),
            x in 0.0..17.0f64, y in 0.0..13.0f64, radius in 0usize..5,
        ) {
            let view = GrayView::new(&pixels, 17, 13).unwrap();
            let mut square = Vec::new();
            let reach = radius as f64;
            let fits = x >= reach && y >= reach && x + reach <= 15.0 && y + reach <= 11.0;
            prop_assert_eq!(sample_square(&view, [x, y], radius, &mut square).is_some(), fits);
            let side = 2 * radius + 1;
            for (index, value) in square.iter().enumerate() {
                let [dx, dy] = [index % side, index / side].map(|k| k as f64 - reach);
                let expected = view.bilinear(x + dx, y + dy).unwrap();
                prop_assert!((f64::from(*value) - expected).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn beyond_the_ends_the_nearest_pixel_counts() {
        for (place, before, share) in [
            (-3.0, 0, 0.0),
            (1.25, 1, 0.25),
            (9.0, 3, 0.0),
            (f64::NAN, 0, 0.0),
        ] {
            let near = Between::nearest(place, 4);
            assert_eq!((near.before, near.share), (before, share));
            assert_eq!(near.after, (before + 1).min(3));
        }
    }
}
