//! The direction of a corner: from its centre to the intensity centroid of a disc around it (Rosin 1999).

use crate::image::GrayView;
use crate::simd::Kernel;

/// Radius of the disc, pixels (the ORB paper's 31 x 31 patch).
pub(super) const DISC_RADIUS: usize = 15;

/// Half widths of the disc's rows at distance 0..=15 from its centre.
const HALF_WIDTHS: [usize; DISC_RADIUS + 1] = half_widths();

const fn half_widths() -> [usize; DISC_RADIUS + 1] {
    let mut widths = [0; DISC_RADIUS + 1];
    let mut row = 0;
    while row <= DISC_RADIUS {
        let mut width = DISC_RADIUS;
        // Rounded radius: (r + ½)².
        while width * width + row * row > DISC_RADIUS * DISC_RADIUS + DISC_RADIUS {
            width -= 1;
        }
        widths[row] = width;
        row += 1;
    }
    widths
}

/// A row of the disc, padded to a whole vector.
const LANES: usize = 2 * DISC_RADIUS + 2;

/// All ones where a row at distance 0..=15 from the centre lies in the disc.
const INSIDE: [[u8; LANES]; DISC_RADIUS + 1] = {
    let mut inside = [[0; LANES]; DISC_RADIUS + 1];
    let mut row = 0;
    while row <= DISC_RADIUS {
        let mut column = DISC_RADIUS - HALF_WIDTHS[row];
        while column <= DISC_RADIUS + HALF_WIDTHS[row] {
            inside[row][column] = u8::MAX;
            column += 1;
        }
        row += 1;
    }
    inside
};

/// The angle of the centroid, radians in (−π, π], 0 along +x, growing towards +y (clockwise on the screen).
///
/// The disc must lie inside the image. A disc without any gradient has angle 0.
pub(super) struct Orientation<'a> {
    pub(super) view: &'a GrayView<'a>,
    pub(super) x: usize,
    pub(super) y: usize,
}

impl Orientation<'_> {
    /// A row of the disc, zero outside.
    #[inline(always)]
    fn line(&self, y: usize, inside: &[u8; LANES]) -> [i16; LANES] {
        let left = self.x - DISC_RADIUS;
        let mut line = [0_u8; LANES];
        line[..LANES - 1].copy_from_slice(&self.view.row(y)[left..left + LANES - 1]);
        let mut wide = [0; LANES];
        for i in 0..LANES {
            wide[i] = i16::from(line[i] & inside[i]);
        }
        wide
    }
}

impl Kernel for Orientation<'_> {
    type Output = f32;

    #[inline(always)]
    fn run(self) -> f32 {
        let y = self.y;
        // Per column: the sum of grey levels (at most 31 · 255) and the moment downwards (at most 120 · 255).
        let mut sums = self.line(y, &INSIDE[0]);
        let mut moments = [0_i16; LANES];
        for (distance, inside) in (0_i16..).zip(&INSIDE).skip(1) {
            let offset = usize::from(distance.unsigned_abs());
            let (lower, upper) = (self.line(y + offset, inside), self.line(y - offset, inside));
            for i in 0..LANES {
                sums[i] += lower[i] + upper[i];
                moments[i] += (lower[i] - upper[i]) * distance;
            }
        }
        let down: i32 = moments.iter().map(|&moment| i32::from(moment)).sum();
        let columns = (0_i32..).zip(sums);
        let across: i32 = columns
            .map(|(column, sum)| (column - 15) * i32::from(sum))
            .sum();
        #[expect(
            clippy::cast_precision_loss,
            reason = "moments of a disc of bytes stay below 2^24"
        )]
        let angle = (down as f32).atan2(across as f32);
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;

    fn orientation(image: &GrayImage, x: usize, y: usize) -> f32 {
        Orientation {
            view: &image.view(),
            x,
            y,
        }
        .run()
    }

    #[test]
    fn ramps_point_uphill() {
        for degrees in (-170..=180).step_by(10) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let ramp = |i: i32| {
                let (x, y) = (f64::from(i % 31 - 15), f64::from(i / 31 - 15));
                (128.0 + 5.0 * (cos * x + sin * y)).round() as u8
            };
            let image = GrayImage::new((0..31 * 31).map(ramp).collect(), 31, 31).unwrap();
            let found = orientation(&image, 15, 15).to_degrees();
            assert!((found - degrees as f32).abs() < 0.5, "{degrees} {found}");
        }
    }

    #[test]
    fn moments_are_those_of_the_disc() {
        let pixel = |i: usize| (i * 7919 % 251) as u8;
        let image = GrayImage::new((0..40 * 40).map(pixel).collect(), 40, 40).unwrap();
        let (mut across, mut down) = (0, 0);
        for (x, y) in (0..40 * 40).map(|i| (i % 40, i / 40)) {
            let (dx, dy) = (x as i32 - 19, y as i32 - 20);
            if dy.abs() <= 15
                && dx.unsigned_abs() as usize <= HALF_WIDTHS[dy.unsigned_abs() as usize]
            {
                across += dx * i32::from(pixel(y * 40 + x));
                down += dy * i32::from(pixel(y * 40 + x));
            }
        }
        let expected = (down as f32).atan2(across as f32);
        assert_eq!(orientation(&image, 19, 20), expected);
    }

    #[test]
    fn a_flat_disc_has_angle_zero() {
        let image = GrayImage::filled(31, 31, 200);
        assert_eq!(orientation(&image, 15, 15), 0.0);
    }
}
