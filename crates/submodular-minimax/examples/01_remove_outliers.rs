//! A flat patch, one stray point and a floating clump: who goes, and how sure is the solver?
//!
//! Expected output: 901 and the clump's five indices are removed, 900 points stay.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use submodular_minimax::{OutlierConfig, Solver, remove_outliers};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut points: Vec<[f64; 3]> = (0..900)
        .map(|i| [f64::from(i % 30) * 0.1, f64::from(i / 30) * 0.1, 0.0])
        .collect();
    points.push([1.0, 1.0, 4.0]);
    points.extend((0..5).map(|i| [2.0, 2.0 + 0.05 * f64::from(i), 2.0]));

    for solver in [Solver::ClosedForm, Solver::IterativeXGrowing] {
        let config = OutlierConfig {
            solver,
            ..OutlierConfig::default()
        };
        let cleaned = remove_outliers(&points, None, &config)?;
        println!(
            "{solver:?}: {} kept, removed {:?}, {} iterations, stopped {:?}, within {:.1} x optimum",
            cleaned.kept.len(),
            cleaned.removed,
            cleaned.iterations,
            cleaned.stop,
            cleaned.certificate.ratio(),
        );
    }
    let paper = remove_outliers(&points, None, &OutlierConfig::paper())?;
    println!("constants as printed: removed {:?}", paper.removed);
    Ok(())
}
