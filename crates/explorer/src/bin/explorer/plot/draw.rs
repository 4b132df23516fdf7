//! Drawing a figure as SVG: titles, axes and legend by plotters, the layers between them by us.

use core::fmt;
use core::ops::Range;

use plotters::coord::{Shift, types::RangedCoordf64};
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::figure::{Figure, Layer, Shape};
use super::frame::Frame;
use super::legend::emptiest_corner;
use super::shapes;

/// Size of a figure, pixels.
const SIZE: (u32, u32) = (900, 640);
/// Space for titles and axis labels, pixels.
const LEFT: u32 = 76;
const RIGHT: u32 = 16;
const TOP: u32 = 64;
const BOTTOM: u32 = 56;
/// Of these the part between the outermost label and the picture's edge.
const EDGE: u32 = 10;

const TEXT: RGBColor = RGBColor(40, 44, 52);
const FAINT: RGBColor = RGBColor(112, 118, 128);
/// Stands where the layers go: above the grid, below the legend.
const PLACE: &str = "@@layers@@";

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A figure that could not be drawn; drawing into memory leaves hardly a reason.
#[derive(Debug)]
pub(crate) struct DrawError(String);

impl fmt::Display for DrawError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot draw the picture: {}", self.0)
    }
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for DrawError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self(error.to_string())
    }
}

impl Figure {
    /// The figure as an SVG document.
    pub(crate) fn to_svg(&self) -> Result<String, DrawError> {
        let size = area();
        let frame = Frame::around(self, size.0 / size.1);
        let mut svg = String::new();
        self.draw_around_layers(&mut svg, &frame)?;
        let origin = (LEFT as i32, TOP as i32);
        Ok(put_layers(
            &svg,
            &shapes::element(&self.layers, &frame, origin, size),
        ))
    }

    fn draw_around_layers(&self, svg: &mut String, frame: &Frame) -> Result<(), DrawError> {
        let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        self.draw_titles(&root, frame)?;
        let mut chart = ChartBuilder::on(&root)
            .margin_top(TOP)
            .margin_bottom(EDGE)
            .margin_right(RIGHT)
            .margin_left(EDGE)
            .set_label_area_size(LabelAreaPosition::Left, LEFT - EDGE)
            .set_label_area_size(LabelAreaPosition::Bottom, BOTTOM - EDGE)
            .build_cartesian_2d(frame.x.clone(), frame.y.clone())?;
        chart
            .configure_mesh()
            .x_desc(self.axes[0].as_str())
            .y_desc(self.axes[1].as_str())
            .x_label_formatter(&|value| tick(*value, &frame.x))
            .y_label_formatter(&|value| tick(*value, &frame.y))
            .axis_desc_style(font(17.0, TEXT))
            .label_style(font(15.0, TEXT))
            .axis_style(FAINT)
            .bold_line_style(RGBColor(226, 229, 234))
            .light_line_style(TRANSPARENT)
            .draw()?;
        root.draw(&Text::new(PLACE, (0, 0), font(10.0, TEXT)))?;
        self.draw_legend(&mut chart, frame)?;
        root.present()?;
        Ok(())
    }

    fn draw_titles(&self, root: &Area<'_>, frame: &Frame) -> Result<(), DrawError> {
        let x = LEFT as i32;
        root.draw(&Text::new(self.title.clone(), (x, 12), font(23.0, TEXT)))?;
        let subtitle = match frame.clipped(self) {
            (0, _) => self.subtitle.clone(),
            (1, _) => format!("{}; 1 point lies outside the picture", self.subtitle),
            (outside, _) => format!(
                "{}; {outside} points lie outside the picture",
                self.subtitle
            ),
        };
        root.draw(&Text::new(subtitle, (x, 40), font(15.5, FAINT)))?;
        Ok(())
    }

    fn draw_legend<'a>(&self, chart: &mut Chart<'a, 'a>, frame: &Frame) -> Result<(), DrawError> {
        let mut lines = 0;
        for layer in self.layers.iter().filter(|layer| !layer.is_empty()) {
            let Some(label) = &layer.label else { continue };
            let mark = layer.clone();
            chart
                .draw_series(core::iter::empty::<Circle<(f64, f64), i32>>())?
                .label(label)
                .legend(move |at| sample(&mark, at));
            lines += 1;
        }
        if lines > 0 {
            chart
                .configure_series_labels()
                .position(emptiest_corner(self, frame, area()).position())
                .background_style(WHITE.mix(0.86))
                .border_style(RGBColor(206, 210, 216))
                .label_font(font(15.0, TEXT))
                .draw()?;
        }
        Ok(())
    }
}

/// A layer's mark in the legend, 20 pixels wide.
fn sample<'a>(
    layer: &Layer,
    (x, y): (i32, i32),
) -> DynElement<'static, SVGBackend<'a>, (i32, i32)> {
    let (r, g, b) = layer.color;
    // As pale as the layer itself, though not so pale that a lone mark is not seen.
    let color = RGBColor(r, g, b).mix(layer.opacity.max(PALEST));
    match &layer.shape {
        Shape::Dots { .. } => Circle::new((x + 10, y), 4, color.filled()).into_dyn(),
        Shape::Crosses { .. } => Cross::new((x + 10, y), 4, color.stroke_width(2)).into_dyn(),
        Shape::Line { dashed: true, .. } => {
            let ends = [(x + 1, y), (x + 19, y)];
            DashedPathElement::new(ends, 7, 4, color.stroke_width(3)).into_dyn()
        }
        Shape::Segments { .. } | Shape::Line { .. } => {
            PathElement::new([(x + 1, y), (x + 19, y)], color.stroke_width(3)).into_dyn()
        }
        Shape::Polygons { .. } => {
            Rectangle::new([(x + 3, y - 5), (x + 17, y + 5)], color.filled()).into_dyn()
        }
    }
}

/// Least opacity of a mark in the legend.
const PALEST: f64 = 0.3;

/// Width and height of the drawing area, pixels.
fn area() -> (f64, f64) {
    (
        f64::from(SIZE.0 - LEFT - RIGHT),
        f64::from(SIZE.1 - TOP - BOTTOM),
    )
}

/// A number on an axis, with as many decimals as its ten or so steps need; never a negative zero.
fn tick(value: f64, range: &Range<f64>) -> String {
    let step = (range.end - range.start) / 10.0;
    let decimals = (-step.log10()).ceil().clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    match text
        .trim_start_matches('-')
        .chars()
        .all(|c| matches!(c, '0' | '.'))
    {
        true => text.trim_start_matches('-').to_owned(),
        false => text,
    }
}

fn font(size: f64, color: RGBColor) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&color)
}

/// Puts the layers in place of the mark's whole text element.
fn put_layers(svg: &str, layers: &str) -> String {
    let place = svg.split_once(PLACE).and_then(|(before, after)| {
        Some((
            before.rsplit_once("<text")?.0,
            after.split_once("</text>")?.1,
        ))
    });
    match place {
        Some((before, after)) => [before, layers, after].concat(),
        None => svg.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dashed_line_has_a_dashed_mark() {
        let marks = |dashed| {
            let line = Shape::Line {
                through: vec![[0.0, 0.0], [1.0, 1.0]],
                width: 2.0,
                dashed,
            };
            let figure = Figure {
                layers: vec![Layer::new("path", (1, 2, 3), line)],
                ..Figure::default()
            };
            let svg = figure.to_svg().expect("a picture");
            svg.matches("stroke=\"#010203\" stroke-width=\"3\"").count()
        };
        // Strokes of the mark, and the line itself.
        assert_eq!((marks(false), marks(true)), (1, 2));
    }

    #[test]
    fn a_mark_is_as_pale_as_its_layer() {
        let at = vec![[0.0, 0.0], [1.0, 1.0]];
        for (opacity, shown) in [(1.0, "1"), (0.45, "0.45"), (0.1, "0.3")] {
            let dots = Shape::Dots {
                at: at.clone(),
                radius: 2.0,
            };
            let figure = Figure {
                layers: vec![Layer::new("points", (1, 2, 3), dots).opacity(opacity)],
                ..Figure::default()
            };
            let svg = figure.to_svg().expect("a picture");
            let mark = svg
                .split("<circle")
                .nth(1)
                .and_then(|rest| rest.split("/>").next());
            let mark = mark.expect("a mark");
            let expected = format!("opacity=\"{shown}\" fill=\"#010203\"");
            assert!(mark.contains(&expected), "{mark}");
        }
    }

    #[test]
    fn ticks_have_the_decimals_of_their_steps_and_zero_no_sign() {
        assert_eq!(tick(-1e-17, &(-0.9..0.1)), "0.0");
        assert_eq!(tick(-0.05, &(-0.2..0.2)), "-0.05");
        assert_eq!(tick(-6.0, &(-9.0..7.0)), "-6");
    }
}
