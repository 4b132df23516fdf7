//! CPU time of cleaning against the number of points, 1,000 to 1,000,000: it grows near-linearly.
//!
//! `cargo run --release -p submodular-minimax --example 04_growth [LARGEST] [GROWTH.svg]`
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/labelled/mod.rs"]
mod labelled;

use labelled::room::Room;
use std::error::Error;
use std::fmt::Write;
use submodular_minimax::baseline::{StatisticalConfig, statistical};
use submodular_minimax::{OutlierConfig, remove_outliers};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let largest: usize = arguments.next().map_or(Ok(1_000_000), |n| n.parse())?;
    let mut curve = Vec::new();
    println!(
        "{:>9} {:>12} {:>12} {:>12}",
        "points", "default ms", "µs / point", "SOR ms"
    );
    for n in [
        1_000, 3_000, 10_000, 30_000, 50_000, 100_000, 200_000, 500_000, 1_000_000,
    ] {
        if n > largest {
            break;
        }
        let cloud = Room {
            points: n,
            outliers: 0.15,
            patches: 100 + n / 50,
            seed: 1,
        }
        .make();
        let (before, config) = (cpu_seconds()?, OutlierConfig::default());
        let repeats = (20_000 / n).max(1);
        for _ in 0..repeats {
            remove_outliers(&cloud.points, None, &config)?;
        }
        let between = cpu_seconds()?;
        let ours = (between - before) / repeats as f64;
        statistical(&cloud.points, &StatisticalConfig::default())?;
        let sor = cpu_seconds()? - between;
        let (ms, each) = (1e3 * ours, 1e6 * ours / n as f64);
        println!("{n:9} {ms:12.1} {each:12.2} {:12.1}", 1e3 * sor);
        curve.push((n as f64, ours));
    }
    if let Some(file) = arguments.next() {
        std::fs::write(file, svg(&curve)?)?;
    }
    Ok(())
}

/// CPU time of this thread, from the scheduler's statistics of Linux.
fn cpu_seconds() -> Result<f64, Box<dyn Error>> {
    let statistics = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds = statistics.split(' ').next().unwrap_or_default();
    Ok(nanoseconds.parse::<f64>()? / 1e9)
}

/// Points against seconds, both logarithmic, three decades wide and four high.
fn svg(curve: &[(f64, f64)]) -> Result<String, std::fmt::Error> {
    let place = |(n, s): (f64, f64)| {
        (
            40.0 + 120.0 * (n.log10() - 3.0),
            380.0 - 80.0 * (s.log10() + 4.0),
        )
    };
    let mut text = String::from(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="440" height="450" viewBox="0 -30 440 450">"#,
    );
    text += r#"<text x="100" y="412">points, 10³ to 10⁶; seconds, 10⁻⁴ to 10¹</text>"#;
    text += r##"<rect x="40" y="-20" width="360" height="400" fill="none" stroke="#888"/>"##;
    text += r#"<polyline fill="none" stroke="black" points=""#;
    for &point in curve {
        let (x, y) = place(point);
        write!(text, "{x:.1},{y:.1} ")?;
    }
    text += r#""/></svg>"#;
    Ok(text)
}
