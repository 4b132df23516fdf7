//! PNG by rendering the SVG, with a font that is part of the program: the same picture on every machine.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

/// Pixels of the PNG for one of the SVG.
const ZOOM: f32 = 1.5;

/// A picture that could not be rendered.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PngError {
    #[error("cannot render the picture: {0}")]
    Svg(#[from] usvg::Error),
    #[error("cannot render the picture: {width} x {height} pixels are no picture size")]
    Size { width: u32, height: u32 },
    #[error("cannot pack the picture as PNG: {0}")]
    Encode(String),
}

/// Renders an SVG document as PNG.
pub(crate) fn render(svg: &str) -> Result<Vec<u8>, PngError> {
    pixmap(svg, ZOOM)?
        .encode_png()
        .map_err(|error| PngError::Encode(error.to_string()))
}

/// Renders an SVG document, `zoom` pixels for one of its own.
pub(crate) fn pixmap(svg: &str, zoom: f32) -> Result<tiny_skia::Pixmap, PngError> {
    let mut options = usvg::Options::default();
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let tree = usvg::Tree::from_str(svg, &options)?;
    let size = tree.size();
    let (width, height) = ((size.width() * zoom) as u32, (size.height() * zoom) as u32);
    let mut pixmap =
        tiny_skia::Pixmap::new(width, height).ok_or(PngError::Size { width, height })?;
    let transform = tiny_skia::Transform::from_scale(zoom, zoom);
    resvg::render(&tree, transform, &mut pixmap.as_mut());
    Ok(pixmap)
}
