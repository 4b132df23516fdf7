//! The k most representative of n points: bounded greedy against lazy and naive greedy.
//!
//! `cargo run --release -p submodular-minimax --example 05_facility_location [LARGEST]`
//!
//! No kernel matrix is stored. The three select the same points.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/labelled/mod.rs"]
mod labelled;

use labelled::cpu_seconds;
use labelled::room::Room;
use std::error::Error;
use submodular_minimax::functions::{FacilityLocation, Kernel, Points};
use submodular_minimax::maximize::{Greedy, LazyGreedy, Maximizer};

fn main() -> Result<(), Box<dyn Error>> {
    let largest: usize = std::env::args().nth(1).map_or(Ok(10_000), |n| n.parse())?;
    println!(
        "{:>6} {:>26} {:>10} {:>10} {:>10}",
        "n", "kernel", "bounded s", "lazy s", "naive s"
    );
    for n in [1_000, 3_000, 10_000, 50_000] {
        if n > largest {
            break;
        }
        let cloud = Room::for_timing(n).make();
        for kernel in [
            Kernel::Rational { scale: 0.5 },
            Kernel::Rational { scale: 3.0 },
            Kernel::Linear { reach: 2.0 },
            Kernel::Linear { reach: 20.0 },
            Kernel::Reciprocal { scale: 1.0 },
        ] {
            let function = FacilityLocation::new(Points::new(&cloud.points, kernel)?);
            let start = cpu_seconds()?;
            let fast = function.greedy(20)?;
            let bounded = cpu_seconds()? - start;
            print!("{n:6} {:>26} {bounded:10.3}", format!("{kernel:?}"));
            if n <= 10_000 {
                let start = cpu_seconds()?;
                assert_eq!(
                    fast.picks,
                    LazyGreedy::cardinality(20).maximize(&function)?.picks
                );
                print!(" {:10.3}", cpu_seconds()? - start);
            }
            if n <= 3_000 {
                let start = cpu_seconds()?;
                assert_eq!(
                    fast.picks,
                    Greedy::cardinality(20).maximize(&function)?.picks
                );
                print!(" {:10.3}", cpu_seconds()? - start);
            }
            println!("   ({} exact gains)", fast.evaluations);
        }
    }
    Ok(())
}
