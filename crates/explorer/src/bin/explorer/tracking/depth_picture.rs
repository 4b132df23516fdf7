//! A depth image in colours, over a bar that says what they mean.

use core::fmt::Write as _;

use edge_slam::depth::DepthImage;
use resvg::tiny_skia::Pixmap;

use super::caption::{NARROWEST, begin, below, text};
use super::pictures::{hue, paint};
use crate::failure::Failure;

/// Height of the bar with its words, picture pixels.
const BAR: u32 = 102;
/// From the bar's end to the picture's.
const MARGIN: f64 = 40.0;
/// Colours that are told apart in the bar, and numbers below it.
const STEPS: u32 = 96;
const NUMBERS: u32 = 5;
/// Depths beyond these shares of the known ones have the end colours: a few far readings would take all colours.
const SHARES: [f64; 2] = [0.02, 0.98];

/// Near red to far blue between the 2nd and 98th percentile, metres; black where unknown. The bar, and `frame`, are below.
pub(super) fn depth_picture(depth: &DepthImage, frame: &str) -> Result<Pixmap, Failure> {
    let (width, height) = (depth.width(), depth.height());
    let range = Range::of(depth);
    let image = paint(width, height, |x, y| {
        let color = hue(TURN * range.share(depth.get(x, y)?)).to_color_u8();
        Some([color.red(), color.green(), color.blue()])
    })?;
    below(&image, &range.bar(image.width().max(NARROWEST), frame))
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
            near: at(SHARES[0]).unwrap_or(0.0),
            far: at(SHARES[1]).unwrap_or(1.0),
        }
    }

    fn share(&self, z: f64) -> f32 {
        ((z - self.near) / (self.far - self.near).max(1e-9)).clamp(0.0, 1.0) as f32
    }

    /// The bar as SVG: colours, five numbers, the unit, what has the end colours, the frame.
    fn bar(&self, width: u32, frame: &str) -> String {
        let long = f64::from(width) - 2.0 * MARGIN;
        let mut svg = begin(width, BAR);
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
        for k in 0..NUMBERS {
            let share = f64::from(k) / f64::from(NUMBERS - 1);
            let z = self.near + share * (self.far - self.near);
            svg.push_str(&text(
                MARGIN + share * long,
                38,
                "middle",
                &format!("{z:.2}"),
            ));
        }
        let [low, high] = SHARES.map(|share| 100.0 * share);
        let words = [
            "depth [m]; black: not known".to_owned(),
            format!(
                "the {low:.0} % nearest and the {:.0} % farthest have the end colours",
                100.0 - high
            ),
            frame.to_owned(),
        ];
        for (baseline, line) in (56..).step_by(20).zip(&words) {
            svg.push_str(&text(f64::from(width) / 2.0, baseline, "middle", line));
        }
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
        let bar = range.bar(460, "frame 3");
        for number in [
            "1.01",
            "1.25",
            "1.49",
            "1.73",
            "1.97",
            "depth [m]",
            "the 2 % nearest and the 2 % farthest",
            "frame 3",
        ] {
            assert!(bar.contains(&format!(">{number}")), "{number}: {bar}");
        }
        let picture = depth_picture(&depth, "frame 3").expect("a picture");
        assert_eq!((picture.width(), picture.height()), (NARROWEST, 20 + BAR));
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
        let picture = depth_picture(&nothing, "").expect("a picture");
        assert_eq!(picture.width(), NARROWEST);
        let pixel = picture.pixel(0, 0).expect("inside");
        assert_eq!((pixel.red(), pixel.green(), pixel.blue()), (0, 0, 0));
        assert_eq!(picture.height(), 2 * ZOOM as u32 + BAR);
    }
}
