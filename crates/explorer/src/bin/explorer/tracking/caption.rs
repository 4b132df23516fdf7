//! What a picture shows, in words and colours below it.

use core::fmt::Write as _;

use resvg::tiny_skia::{Color, Pixmap, PixmapPaint, Transform};

use crate::failure::Failure;
use crate::plot;

/// Least width of a picture with its caption, picture pixels: small images get an empty side.
pub(super) const NARROWEST: u32 = 460;
/// Of a line of text, and from the picture's edge to it.
const LINE: u32 = 20;
const MARGIN: u32 = 12;
/// About a letter's width at this size.
const SIZE: u32 = 14;
const LETTER: usize = 7;

/// Lines of text and, before them, colours with their meanings in one row.
#[derive(Debug, Clone, Default)]
pub(super) struct Caption {
    pub(super) lines: Vec<String>,
    pub(super) colors: Vec<(Color, String)>,
}

impl Caption {
    /// The picture with the caption below.
    pub(super) fn under(&self, picture: &Pixmap) -> Result<Pixmap, Failure> {
        let width = picture.width().max(NARROWEST);
        below(picture, &self.svg(width))
    }

    fn svg(&self, width: u32) -> String {
        let rows = self.lines.len() + usize::from(!self.colors.is_empty());
        let height = LINE * rows as u32 + MARGIN;
        let mut svg = begin(width, height);
        let mut baseline = LINE;
        let mut x = MARGIN;
        for (color, meaning) in &self.colors {
            let (c, top) = (color.to_color_u8(), baseline - 11);
            let _ = write!(
                svg,
                "<rect x=\"{x}\" y=\"{top}\" width=\"14\" height=\"12\" fill=\"rgb({},{},{})\"/>",
                c.red(),
                c.green(),
                c.blue()
            );
            svg.push_str(&text(f64::from(x + 18), baseline, "start", meaning));
            x += 18 + (LETTER * meaning.chars().count()) as u32 + 14;
        }
        if !self.colors.is_empty() {
            baseline += LINE;
        }
        for line in &self.lines {
            svg.push_str(&text(f64::from(MARGIN), baseline, "start", line));
            baseline += LINE;
        }
        svg + "</svg>"
    }
}

/// An SVG of this size with a white ground.
pub(super) fn begin(width: u32, height: u32) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>"
    )
}

/// A line of text; `anchor` is start or middle.
pub(super) fn text(x: f64, baseline: u32, anchor: &str, what: &str) -> String {
    format!(
        "<text x=\"{x:.1}\" y=\"{baseline}\" font-family=\"sans-serif\" font-size=\"{SIZE}\" text-anchor=\"{anchor}\">{what}</text>"
    )
}

/// A picture above an SVG, which must be as wide as it or wider.
pub(super) fn below(picture: &Pixmap, svg: &str) -> Result<Pixmap, Failure> {
    let bar = plot::pixmap(svg, 1.0).map_err(Failure::internal)?;
    let mut whole = Pixmap::new(bar.width(), picture.height() + bar.height())
        .ok_or_else(|| Failure::internal("the picture with its caption has no size"))?;
    whole.fill(Color::BLACK);
    let under = i32::try_from(picture.height()).map_err(Failure::internal)?;
    for (part, y) in [(picture, 0), (&bar, under)] {
        let plain = PixmapPaint::default();
        whole.draw_pixmap(0, y, part.as_ref(), &plain, Transform::identity(), None);
    }
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_and_colour_is_below_the_picture() {
        let caption = Caption {
            lines: vec!["frame 3 of 9".to_owned(), "second".to_owned()],
            colors: vec![(Color::from_rgba8(1, 2, 3, 255), "arms".to_owned())],
        };
        let svg = caption.svg(500);
        for part in ["frame 3 of 9", "second", "arms", "rgb(1,2,3)"] {
            assert!(svg.contains(part), "{part}: {svg}");
        }
        let picture = Pixmap::new(20, 10).expect("a picture");
        let whole = caption.under(&picture).expect("a picture");
        assert_eq!((whole.width(), whole.height()), (NARROWEST, 10 + 72));
        let colour = whole.pixel(MARGIN + 3, 10 + 14).expect("inside");
        assert_eq!((colour.red(), colour.green(), colour.blue()), (1, 2, 3));
    }
}
