//! Waiting places for drivers that hold up wherever demand appears: all minimax algorithms compared.
//!
//! A town has 60 possible waiting places and 40 places where demand may appear; the worst 6 of them
//! will. X is where drivers wait, at a cost; a place without a driver loses what the nearest demand
//! is worth there. s falls with the Manhattan distance, as 2 − 2 / (1 + exp(−20 d)).
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/tables/mod.rs"]
mod tables;

use rand::RngExt;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use std::error::Error;
use submodular_minimax::functions::{Dense, Representation};

fn main() -> Result<(), Box<dyn Error>> {
    let mut rng = Pcg64::seed_from_u64(20);
    let mut town = |count: usize| -> Vec<[f64; 2]> {
        (0..count)
            .map(|_| [rng.random::<f64>(), rng.random::<f64>()])
            .collect()
    };
    let (places, demand) = (town(60), town(40));
    let similarity = Dense::from_fn(demand.len(), places.len(), |u, v| {
        let d = (demand[u][0] - places[v][0]).abs() + (demand[u][1] - places[v][1]).abs();
        2.0 - 2.0 / (1.0 + (-20.0 * d).exp())
    })?;
    let wages = places.iter().map(|p| 0.05 + 0.1 * p[0]).collect();
    let function = Representation::new(similarity, wages, 0.0)?;
    println!("ride share: 60 waiting places, the worst 6 of 40 demands");
    tables::compare(&function, 6)
}
