//! The direction of a corner: from its centre to the intensity centroid of a disc around it (Rosin 1999).

use crate::image::GrayView;

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

/// Weights −15..=15 for a row's columns, as the moments need them.
const COLUMNS: [i32; 2 * DISC_RADIUS + 1] = {
    let mut columns = [0; 2 * DISC_RADIUS + 1];
    let mut k = 0;
    while k < columns.len() {
        columns[k] = k as i32 - DISC_RADIUS as i32;
        k += 1;
    }
    columns
};

/// The angle of the centroid, radians in (−π, π], 0 along +x, growing towards +y (clockwise on the screen).
///
/// The disc must lie inside the image. A disc without any gradient has angle 0.
#[inline(always)]
pub(super) fn orientation(view: &GrayView<'_>, x: usize, y: usize) -> f32 {
    let (mut across, mut down) = (0_i32, 0_i32);
    for (distance, &half) in HALF_WIDTHS.iter().enumerate() {
        let span = x - half..x + half + 1;
        let weights = &COLUMNS[DISC_RADIUS - half..DISC_RADIUS + half + 1];
        let (lower_sum, lower_moment) = moments(&view.row(y + distance)[span.clone()], weights);
        across += lower_moment;
        if distance > 0 {
            let (upper_sum, upper_moment) = moments(&view.row(y - distance)[span], weights);
            across += upper_moment;
            down += (lower_sum - upper_sum) * i32::try_from(distance).unwrap_or(0);
        }
    }
    #[expect(
        clippy::cast_precision_loss,
        reason = "moments of a disc of bytes stay below 2^24"
    )]
    let angle = (down as f32).atan2(across as f32);
    angle
}

#[inline(always)]
fn moments(pixels: &[u8], weights: &[i32]) -> (i32, i32) {
    let (mut sum, mut moment) = (0, 0);
    for (&pixel, &weight) in pixels.iter().zip(weights) {
        sum += i32::from(pixel);
        moment += i32::from(pixel) * weight;
    }
    (sum, moment)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;

    #[test]
    fn ramps_point_uphill() {
        for degrees in (-170..=180).step_by(10) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let ramp = |i: i32| {
                let (x, y) = (f64::from(i % 31 - 15), f64::from(i / 31 - 15));
                (128.0 + 5.0 * (cos * x + sin * y)).round() as u8
            };
            let image = GrayImage::new((0..31 * 31).map(ramp).collect(), 31, 31).unwrap();
            let found = orientation(&image.view(), 15, 15).to_degrees();
            assert!((found - degrees as f32).abs() < 0.5, "{degrees} {found}");
        }
    }

    #[test]
    fn a_flat_disc_has_angle_zero() {
        let image = GrayImage::filled(31, 31, 200);
        assert_eq!(orientation(&image.view(), 15, 15), 0.0);
    }
}
