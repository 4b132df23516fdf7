//! Writing a figure to a file, as its name says: .svg or .png.

use std::fs;
use std::path::Path;

use super::{figure::Figure, png};
use crate::failure::Failure;

/// Draws the figure into a file.
pub(crate) fn save(figure: &Figure, path: &Path) -> Result<(), Failure> {
    let svg = figure.to_svg().map_err(Failure::internal)?;
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    let bytes = match extension.as_str() {
        "svg" => svg.into_bytes(),
        "png" => png::render(&svg).map_err(Failure::internal)?,
        _ => {
            let reason = format!("{}: pictures are .svg or .png", path.display());
            return Err(Failure::new(
                reason,
                "name the picture FILE.svg or FILE.png",
            ));
        }
    };
    fs::write(path, bytes).map_err(|error| Failure::write(path, &error))
}
