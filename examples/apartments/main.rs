//! Problem: do planned paths cross real walls? Apartments are scanned in the simulator, paths are planned on what its SLAM made
//! of them, among the paper's hulls and in proven free space, and judged by the true walls.
//!
//! Run: `cargo run --release -p examples --example proven_free_apartments [FIRST_SEED] [COUNT] [CONTRADICTION_LOG_ODDS]`
//! Prints what became of 50 queries in each apartment: between places that are twice the drone's radius from everything, and
//! between any places at which it fits. The scan's camera saw through all of them. Then, of random motions that proven space lets
//! through, how much nearer than the radius they come to something solid, and the volume in which they start.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

mod accuracy;
mod scan;
mod trial;

use std::error::Error;

use accuracy::Accuracy;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use sparse_to_obstacles::FreeSpaceConfig;
use trial::{Belief, RADIUS, Tally};

const QUERIES: usize = 50;
/// Random motions that each apartment's proven space is asked for.
const MOTIONS: usize = 400_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let first: u64 = arguments.next().map_or(Ok(1), |word| word.parse())?;
    let count: u64 = arguments.next().map_or(Ok(3), |word| word.parse())?;
    let default = FreeSpaceConfig::default().contradiction_log_odds;
    let contradiction: f64 = arguments.next().map_or(Ok(default), |word| word.parse())?;
    let mut accuracy = Accuracy::default();
    let mut totals = [[Tally::default(); 2]; 2];
    for seed in first..first + count {
        let scan = scan::scan(seed)?;
        println!(
            "apartment {seed}: {} rooms, looked around at {} of {} places, {} points, {} keyframes",
            scan.world.rooms().len(),
            scan.visited,
            scan.sites,
            scan.points.len(),
            scan.keyframes
        );
        let belief = Belief::new(&scan, contradiction, seed)?;
        for (berth, totals) in [2.0 * RADIUS, RADIUS].into_iter().zip(&mut totals) {
            let mut rng = Pcg64::seed_from_u64(seed);
            let queries = trial::queries(&scan, berth, QUERIES, &mut rng)?;
            let tallies = trial::run(&scan, &belief, &queries)?;
            print(berth, &tallies);
            for (total, tally) in totals.iter_mut().zip(tallies) {
                total.add(tally);
            }
        }
        let mut rng = Pcg64::seed_from_u64(seed);
        let free = |a, b| belief.free.motion_is_free(a, b, RADIUS);
        let measured = Accuracy::measure(&scan.world, &free, RADIUS, MOTIONS, &mut rng);
        println!("  {measured}");
        accuracy.add(measured);
    }
    println!("all {count} apartments");
    for (berth, tallies) in [2.0 * RADIUS, RADIUS].into_iter().zip(totals) {
        print(berth, &tallies);
    }
    println!("  {accuracy}");
    Ok(())
}

fn print(berth: f64, tallies: &[Tally]) {
    for (space, tally) in ["hulls", "proven free"].iter().zip(tallies) {
        println!(
            "  ends {berth:.2} m off, {space:11}: {:4} feasible, {:4} solved, {:3} cross, body touches {:3}, body and margin {:3}, nearest {:.3} m",
            tally.feasible,
            tally.solved,
            tally.crossing,
            tally.bumping,
            tally.touching,
            tally.least
        );
    }
}
