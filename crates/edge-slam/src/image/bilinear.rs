//! The four pixels around a sub-pixel place, and what they amount to there.

/// Columns and rows around a place of an image, and how far it lies from the first to the second of each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neighbourhood {
    pub(crate) columns: [usize; 2],
    pub(crate) rows: [usize; 2],
    share: [f64; 2],
}

impl Neighbourhood {
    /// The pixels around (x, y), pixel centres at whole numbers; on the last column or row both neighbours are the same.
    /// `None` outside the centres of the outermost pixels, and for NaN. `width` and `height` are at least 1.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the range is checked first"
    )]
    pub(crate) fn of(x: f64, y: f64, width: usize, height: usize) -> Option<Self> {
        let last = [width.checked_sub(1)?, height.checked_sub(1)?];
        if !(x >= 0.0 && y >= 0.0 && x <= last[0] as f64 && y <= last[1] as f64) {
            return None;
        }
        let (left, top) = (x as usize, y as usize);
        Some(Self {
            columns: [left, (left + 1).min(last[0])],
            rows: [top, (top + 1).min(last[1])],
            share: [x - left as f64, y - top as f64],
        })
    }

    /// The value at the place, given those of the upper left, upper right, lower left and lower right pixel.
    pub(crate) fn blend(&self, corners: [f64; 4]) -> f64 {
        let [a, b] = self.share;
        let upper = corners[0] * (1.0 - a) + corners[1] * a;
        let lower = corners[2] * (1.0 - a) + corners[3] * a;
        upper * (1.0 - b) + lower * b
    }
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
            let [left, right] = near.columns.map(|k| k as f64);
            let [top, bottom] = near.rows.map(|k| k as f64);
            let corners = [
                plane(left, top), plane(right, top), plane(left, bottom), plane(right, bottom),
            ];
            prop_assert!((near.blend(corners) - plane(x, y)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_last_pixel_is_inside_and_nothing_beyond() {
        let corner = Neighbourhood::of(2.0, 1.0, 3, 2).unwrap();
        assert_eq!((corner.columns, corner.rows), ([2, 2], [1, 1]));
        assert_eq!(Neighbourhood::of(2.001, 0.0, 3, 2), None);
        assert_eq!(Neighbourhood::of(0.0, -0.001, 3, 2), None);
        assert_eq!(Neighbourhood::of(f64::NAN, 0.0, 3, 2), None);
        assert_eq!(Neighbourhood::of(0.0, 0.0, 0, 2), None);
    }
}
