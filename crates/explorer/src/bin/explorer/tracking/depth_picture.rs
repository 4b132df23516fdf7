//! A depth image in colours, over a bar that says what they mean.

use core::fmt::Write as _;

use edge_slam::depth::DepthImage;
use resvg::tiny_skia::{Pixmap, PixmapPaint, Transform};

use super::pictures::{hue, paint};
use crate::failure::Failure;
use crate::plot;

/// Height of the bar with its numbers, and the least width of the whole, picture pixels.
const BAR: u32 = 64;
const NARROWEST: u32 = 420;
/// From the bar's end to the picture's.
const MARGIN: f64 = 40.0;
/// Colours that are told apart in the bar, and numbers below it.
const STEPS: u32 = 96;
const NUMBERS: u32 = 5;

/// Near red to far blue between the 2nd and 98th percentile, metres; black where unknown. The bar is below.
pub(super) fn depth_picture(depth: &DepthImage) -> Result<Pixmap, Failure> {
    let (width, height) = (depth.width(), depth.height());
    let range = Range::of(depth);
    let image = paint(width, height, |x, y| {
        let color = hue(TURN * range.share(depth.get(x, y)?)).to_color_u8();
        Some([color.red(), color.green(), color.blue()])
    })?;
    let across = image.width().max(NARROWEST);
    let bar = plot::pixmap(&range.bar(across), 1.0).map_err(Failure::internal)?;
    let mut whole = Pixmap::new(across, image.height() + bar.height())
        .ok_or_else(|| Failure::internal(format!("{width} x {height} is no picture size")))?;
    whole.fill(resvg::tiny_skia::Color::BLACK);
    let below = i32::try_from(image.height()).map_err(Failure::internal)?;
    for (part, y) in [(&image, 0), (&bar, below)] {
        let plain = PixmapPaint::default();
        whole.draw_pixmap(0, y, part.as_ref(), &plain, Transform::identity(), None);
    }
    Ok(whole)
}

/// From red to blue, turns of the colour circle.
const TURN: f32 = 0.66;

/// Depths between which colours differ.
struct Range {
    near: f64,
    far: f64,
}

impl Range {
    fn of(depth: &DepthImage) -> Self {
        let width = depth.width();
        let mut known: Vec<f64> = (0..width * depth.height())
            .filter_map(|index| depth.get(index % width, index / width))
            .collect();
        known.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * (known.len().max(1) - 1) as f64) as usize;
            known.get(index).copied()
        };
        Self {
            near: at(0.02).unwrap_or(0.0),
            far: at(0.98).unwrap_or(1.0),
        }
    }

    fn share(&self, z: f64) -> f32 {
        ((z - self.near) / (self.far - self.near).max(1e-9)).clamp(0.0, 1.0) as f32
    }

    /// The bar as SVG: colours, five numbers, the unit.
    fn bar(&self, width: u32) -> String {
        let long = f64::from(width) - 2.0 * MARGIN;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{BAR}\">\
             <rect width=\"{width}\" height=\"{BAR}\" fill=\"white\"/>"
        );
        let step = long / f64::from(STEPS);
        for k in 0..STEPS {
            let color = hue(TURN * (k as f32 + 0.5) / STEPS as f32).to_color_u8();
            let (r, g, b) = (color.red(), color.green(), color.blue());
            let x = MARGIN + step * f64::from(k);
            // A little wider, or the seams would show.
            let _ = write!(
                svg,
                "<rect x=\"{x:.2}\" y=\"8\" width=\"{:.2}\" height=\"14\" fill=\"rgb({r},{g},{b})\"/>",
                step + 0.5
            );
        }
        let text = |x: f64, y: u32, what: &str| {
            format!(
                "<text x=\"{x:.1}\" y=\"{y}\" font-family=\"sans-serif\" font-size=\"14\" text-anchor=\"middle\">{what}</text>"
            )
        };
        for k in 0..NUMBERS {
            let share = f64::from(k) / f64::from(NUMBERS - 1);
            let z = self.near + share * (self.far - self.near);
            svg.push_str(&text(MARGIN + share * long, 38, &format!("{z:.2}")));
        }
        let middle = f64::from(width) / 2.0;
        svg.push_str(&text(middle, 56, "depth [m]; black: not known"));
        svg + "</svg>"
    }
}

#[cfg(test)]
mod tests {
    use super::super::pictures::ZOOM;
    use super::*;

    #[test]
    fn the_bar_says_what_the_colours_mean() {
        let values = (0..100).map(|k| 1.0 + 0.01 * k as f32).collect();
        let depth = DepthImage::new(values, 10, 10).expect("a depth image");
        let range = Range::of(&depth);
        assert!((range.near - 1.01).abs() < 1e-6 && (range.far - 1.97).abs() < 1e-6);
        let bar = range.bar(420);
        for number in ["1.01", "1.25", "1.49", "1.73", "1.97", "depth [m]"] {
            assert!(bar.contains(&format!(">{number}")), "{number}: {bar}");
        }
        let picture = depth_picture(&depth).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (420, 20 + BAR));
        // The nearest pixel is red, as the bar's left end.
        let at = |x, y| {
            let color = picture.pixel(x, y).expect("inside").demultiply();
            [color.red(), color.green(), color.blue()]
        };
        assert_eq!(at(0, 0), [255, 0, 0]);
        let left = at(MARGIN as u32 + 1, 20 + 15);
        assert!(left[0] > 240 && left[1] < 20 && left[2] < 20, "{left:?}");
    }

    #[test]
    fn a_depth_image_that_knows_nothing_is_black() {
        let nothing = DepthImage::new(vec![f32::NAN; 6], 3, 2).expect("a depth image");
        let picture = depth_picture(&nothing).expect("a picture");
        assert_eq!(picture.width(), NARROWEST);
        let pixel = picture.pixel(0, 0).expect("inside");
        assert_eq!((pixel.red(), pixel.green(), pixel.blue()), (0, 0, 0));
        assert_eq!(picture.height(), 2 * ZOOM as u32 + BAR);
    }
}
