//! Problem: how much of the true surface does proven free space leave open to a drone, and how much room does it give?
//!
//! Run: `cargo run --release -p examples --example measure_free_space MAP_FOLDER SEQUENCE_FOLDER [REFERENCE_TRAJECTORY]`
//! (`--help` lists the options). The map's keyframes are brought to the reference trajectory by the similarity that fits
//! them best; depth images tell where surfaces truly are. Prints a table: the hulls' view, rays, rays and triangles.

use std::error::Error;
use std::io::{self, ErrorKind, Write};

mod arguments;
mod map;
mod measure;
mod planner;
mod table;
#[cfg(test)]
mod tests;
mod truth;

use arguments::{Arguments, HELP};

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let mut out = io::stdout().lock();
    let done = match words.iter().any(|word| word == "--help" || word == "-h") {
        true => write!(out, "{HELP}").map_err(Into::into),
        false => Arguments::parse(words).and_then(|arguments| run(&arguments, &mut out)),
    };
    let closed = |error: &(dyn Error + 'static)| {
        (error.downcast_ref::<io::Error>()).is_some_and(|e| e.kind() == ErrorKind::BrokenPipe)
    };
    match done {
        // The reader has seen enough, as in `| head -1`.
        Err(error) if closed(&*error) => Ok(()),
        Err(error) => {
            writeln!(io::stderr(), "error: {}", chain(&*error))?;
            std::process::exit(1)
        }
        done => done,
    }
}

/// An error and its causes.
fn chain(error: &(dyn Error + 'static)) -> String {
    match error.source() {
        Some(cause) => format!("{error}: {}", chain(cause)),
        None => error.to_string(),
    }
}

/// Reads, measures and prints.
fn run(arguments: &Arguments, out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let reference = map::reference(arguments)?;
    let map = map::aligned(&arguments.map, &reference)?;
    let progress = |done: usize, of: usize| {
        // A terminal that is gone is no reason to stop.
        let _ = write!(io::stderr(), "\rdepth images {done} of {of}");
    };
    let surface = truth::surface(arguments, &reference, progress)?;
    let _ = writeln!(io::stderr());
    table::introduction(out, &map, &surface, arguments)?;
    table::hulls(out, measure::hulls_view(&map, &surface), surface.len())?;
    for setting in measure::settings(arguments) {
        let measured = measure::proven(&map, &surface, &setting, arguments.radius)?;
        table::row(out, &setting, &measured, surface.len())?;
    }
    let planner = planner::measured(&map, &surface, arguments)?;
    table::planner(out, &planner, surface.len())?;
    Ok(())
}
