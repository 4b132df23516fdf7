//! CPU time of cleaning against the number of points, 1,000 to 1,000,000: it grows near-linearly.
//!
//! `cargo run --release -p submodular-minimax --example 04_growth [LARGEST] [GROWTH.svg]`
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/labelled/mod.rs"]
mod labelled;

use labelled::cpu_seconds;
use labelled::room::Room;
use std::error::Error;
use std::fmt::Write;
use submodular_minimax::{OutlierConfig, remove_outliers};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let largest: usize = arguments.next().map_or(Ok(1_000_000), |n| n.parse())?;
    let mut curve = Vec::new();
    println!("{:>9} {:>12} {:>12}", "points", "default ms", "µs / point");
    for n in [
        1_000, 3_000, 10_000, 30_000, 50_000, 100_000, 200_000, 500_000, 1_000_000,
    ] {
        if n > largest {
            break;
        }
        let cloud = Room::for_timing(n).make();
        let (before, config) = (cpu_seconds()?, OutlierConfig::default());
        let repeats = (20_000 / n).max(1);
        for _ in 0..repeats {
            remove_outliers(&cloud.points, None, &config)?;
        }
        let seconds = (cpu_seconds()? - before) / repeats as f64;
        let (ms, each) = (1e3 * seconds, 1e6 * seconds / n as f64);
        println!("{n:9} {ms:12.1} {each:12.2}");
        curve.push((n as f64, seconds));
    }
    if let Some(file) = arguments.next() {
        std::fs::write(file, svg(&curve)?)?;
    }
    Ok(())
}

/// Points against seconds, both axes logarithmic, with a decade's grid and the line of linear growth.
fn svg(curve: &[(f64, f64)]) -> Result<String, std::fmt::Error> {
    let mut text = axes()?;
    if let (Some(first), Some(last)) = (curve.first(), curve.last()) {
        let linear = (last.0, first.1 * last.0 / first.0);
        let ((a, b), (c, d)) = (place(*first), place(linear));
        writeln!(
            text,
            r##"<path d="M{a:.1} {b:.1}L{c:.1} {d:.1}" stroke="#888" stroke-dasharray="5 4"/>"##
        )?;
        let (x, y) = (c - 4.0, d + 66.0);
        writeln!(
            text,
            r##"<text x="{x:.1}" y="{y:.1}" text-anchor="end" fill="#666">linear growth</text>"##
        )?;
    }
    text += r##"<polyline fill="none" stroke="#1f5fa8" stroke-width="2" points=""##;
    for &point in curve {
        let (x, y) = place(point);
        write!(text, "{x:.1},{y:.1} ")?;
    }
    text += "\"/>\n";
    for &point in curve {
        let (x, y) = place(point);
        writeln!(
            text,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="3.5" fill="#1f5fa8"/>"##
        )?;
    }
    text += "</svg>\n";
    Ok(text)
}

/// Pixels of so many points in so many seconds.
fn place((points, seconds): (f64, f64)) -> (f64, f64) {
    (
        80.0 + 150.0 * (points.log10() - 3.0),
        350.0 - 80.0 * (seconds.log10() + 3.0),
    )
}

/// The picture without its curve.
fn axes() -> Result<String, std::fmt::Error> {
    let mut text = String::from(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="580" height="420" viewBox="0 0 580 420" font-family="sans-serif" font-size="13">
<rect width="580" height="420" fill="#fff"/>
<text x="80" y="20" font-size="15">CPU time of outlier removal, one core</text>
"##,
    );
    for (points, name) in [
        (1e3, "1,000"),
        (1e4, "10,000"),
        (1e5, "100,000"),
        (1e6, "1,000,000"),
    ] {
        let x = place((points, 1.0)).0;
        writeln!(text, r##"<path d="M{x:.1} 30V350" stroke="#ddd"/>"##)?;
        writeln!(
            text,
            r#"<text x="{x:.1}" y="370" text-anchor="middle">{name}</text>"#
        )?;
    }
    for seconds in [0.001, 0.01, 0.1, 1.0, 10.0] {
        let y = place((1e3, seconds)).1;
        writeln!(text, r##"<path d="M80 {y:.1}H530" stroke="#ddd"/>"##)?;
        writeln!(
            text,
            r#"<text x="72" y="{:.1}" text-anchor="end">{seconds} s</text>"#,
            y + 4.0
        )?;
    }
    writeln!(
        text,
        r#"<text x="305" y="402" text-anchor="middle">points</text>"#
    )?;
    Ok(text)
}
