//! Layers as SVG: one path element for thousands of dots or segments.

use core::fmt::Write as _;

use super::figure::{Layer, Shape};
use super::frame::Frame;

/// Dots of a smaller radius are drawn as squares, pixels.
const FINE: f64 = 1.5;

/// All layers in a nested `svg` element, which also cuts off what lies outside; `origin` and `size`
/// are the drawing area's in pixels.
pub(super) fn element(
    layers: &[Layer],
    frame: &Frame,
    origin: (i32, i32),
    size: (f64, f64),
) -> String {
    let (x, y) = origin;
    let (width, height) = size;
    let mut svg = format!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\">\n");
    for layer in layers.iter().filter(|layer| !layer.is_empty()) {
        svg.push_str(&layer_element(layer, frame, size));
        svg.push('\n');
    }
    svg.push_str("</svg>");
    svg
}

fn layer_element(layer: &Layer, frame: &Frame, size: (f64, f64)) -> String {
    let pixel = |point: &[f64; 2]| frame.pixel(*point, size);
    match &layer.shape {
        Shape::Dots { at, radius } => {
            let at = at.iter().filter(|point| frame.contains(**point));
            dots(layer, at.map(pixel), *radius)
        }
        Shape::Crosses { at, arm, width } => {
            let mut data = String::new();
            for (x, y) in at.iter().filter(|point| frame.contains(**point)).map(pixel) {
                let (left, up, long) = (x - arm, y - arm, 2.0 * arm);
                let _ = write!(
                    data,
                    "M{left:.1} {up:.1}l{long} {long}m0 -{long}l-{long} {long}"
                );
            }
            stroke(layer, &data, *width)
        }
        Shape::Segments { ends, width } => {
            let mut data = String::with_capacity(ends.len() * 24);
            for [a, b] in ends {
                let ((x0, y0), (x1, y1)) = (pixel(a), pixel(b));
                let _ = write!(data, "M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}");
            }
            stroke(layer, &data, *width)
        }
        Shape::Line {
            through,
            width,
            dashed,
        } => {
            let line = stroke(layer, &open_ring(through, pixel), *width);
            if *dashed {
                line.replace("/>", " stroke-dasharray=\"7 6\"/>")
            } else {
                line
            }
        }
        Shape::Polygons { rings, rim } => {
            let data: String = rings
                .iter()
                .map(|ring| open_ring(ring, pixel) + "Z")
                .collect();
            let [fill, opacity] = [hex(layer), format!("{:.2}", layer.opacity)];
            format!(
                "<path d=\"{data}\" fill=\"{fill}\" fill-opacity=\"{opacity}\" stroke=\"{fill}\" \
                 stroke-width=\"{rim}\" stroke-linejoin=\"round\"/>"
            )
        }
    }
}

/// Round dots are lines of hardly any length with round ends. Browsers draw no ends to lines thinner
/// than a pixel, so that fine dots would vanish where a page shrinks the picture: those are squares.
fn dots(layer: &Layer, at: impl Iterator<Item = (f64, f64)>, radius: f64) -> String {
    let mut data = String::new();
    // A `String` takes everything that is written.
    if radius < FINE {
        for (x, y) in at {
            let _ = write!(data, "M{:.1} {y:.1}h{:.1}", x - radius, 2.0 * radius);
        }
        return capped(layer, &data, 2.0 * radius, "butt");
    }
    for (x, y) in at {
        let _ = write!(data, "M{x:.1} {y:.1}h.01");
    }
    stroke(layer, &data, 2.0 * radius)
}

fn open_ring(corners: &[[f64; 2]], pixel: impl Fn(&[f64; 2]) -> (f64, f64)) -> String {
    let mut data = String::with_capacity(corners.len() * 12);
    for (index, (x, y)) in corners.iter().map(pixel).enumerate() {
        let _ = write!(data, "{}{x:.1} {y:.1}", if index == 0 { 'M' } else { 'L' });
    }
    data
}

fn stroke(layer: &Layer, data: &str, width: f64) -> String {
    capped(layer, data, width, "round")
}

fn capped(layer: &Layer, data: &str, width: f64, cap: &str) -> String {
    let color = hex(layer);
    let opacity = layer.opacity;
    format!(
        "<path d=\"{data}\" fill=\"none\" stroke=\"{color}\" stroke-opacity=\"{opacity:.2}\" \
         stroke-width=\"{width:.1}\" stroke-linecap=\"{cap}\" stroke-linejoin=\"round\"/>"
    )
}

fn hex(layer: &Layer) -> String {
    let (r, g, b) = layer.color;
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fine_dots_have_an_area_without_round_ends() {
        let layer = Layer::new(
            "",
            (0, 0, 0),
            Shape::Dots {
                at: vec![],
                radius: 0.6,
            },
        );
        let fine = dots(&layer, [(10.0, 20.0)].into_iter(), 0.6);
        assert!(
            fine.contains("M9.4 20.0h1.2\"") && fine.contains("linecap=\"butt\""),
            "{fine}"
        );
        let round = dots(&layer, [(10.0, 20.0)].into_iter(), 7.0);
        assert!(
            round.contains("h.01\"") && round.contains("linecap=\"round\""),
            "{round}"
        );
    }
}
