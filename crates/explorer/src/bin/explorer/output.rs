//! What goes to the terminal: results to stdout, complaints to stderr.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use serde::Serialize;

use crate::args::Output;
use crate::failure::Failure;
use crate::plot::{self, Figure};

/// Prints a result: the JSON object with `--json`, else the text; then draws the picture if asked for.
pub(crate) fn deliver(
    output: &Output,
    json: &impl Serialize,
    text: &str,
    figure: impl FnOnce() -> Result<Figure, Failure>,
) -> Result<(), Failure> {
    if let Some(path) = &output.plot {
        plot::save(&figure()?, path)?;
    }
    let text = match output.json {
        true => serde_json::to_string(json).map_err(Failure::internal)?,
        false => text.trim_end().to_owned(),
    };
    // A reader that has gone away (a closed pipe) is no failure of ours.
    let _ = writeln!(io::stdout().lock(), "{text}");
    if let (Some(path), false) = (&output.plot, output.json) {
        let _ = writeln!(io::stdout().lock(), "picture: {}", path.display());
    }
    Ok(())
}

/// Prints why a command failed, in one line on stderr.
pub(crate) fn complain(failure: &Failure) {
    let _ = writeln!(io::stderr().lock(), "explorer: {failure}");
}

/// Writes a file through a buffer.
pub(crate) fn write_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    let written = File::create(path).and_then(|file| {
        let mut file = BufWriter::new(file);
        write(&mut file)?;
        file.flush()
    });
    written.map_err(|error| Failure::write(path, &error))
}
