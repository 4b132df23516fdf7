//! A summary of images that satisfies whichever few of them a user cares for: algorithms compared.
//!
//! 80 images in 5 themes, each a vector of 12 generated features; s is their cosine, moved to [0, 1]
//! and sharpened. X is the summary, and an image in it costs its size, 0.1 to 0.7; every image left out costs
//! what the most similar of the user's 8 favourites, chosen against the summary, is similar to it.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/tables/mod.rs"]
mod tables;

use rand::RngExt;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use std::error::Error;
use submodular_minimax::functions::{Dense, Representation};

fn main() -> Result<(), Box<dyn Error>> {
    let mut rng = Pcg64::seed_from_u64(30);
    let mut vector = || -> Vec<f64> { (0..12).map(|_| rng.random::<f64>() - 0.5).collect() };
    let themes: Vec<Vec<f64>> = (0..5).map(|_| vector()).collect();
    let images: Vec<Vec<f64>> = (0..80)
        .map(|i| {
            themes[i % 5]
                .iter()
                .zip(vector())
                .map(|(t, noise)| t + 0.6 * noise)
                .collect()
        })
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let similarity = Dense::from_fn(images.len(), images.len(), |u, v| {
        let (a, b) = (&images[u], &images[v]);
        let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
        (0.5 + 0.5 * cosine).clamp(0.0, 1.0).powi(12)
    })?;
    let sizes = images.iter().map(|_| 0.1 + 0.6 * rng.random::<f64>());
    let function = Representation::new(similarity, sizes.collect(), 1.0 / 80.0)?;
    println!("image summary: 80 images, 8 favourites");
    tables::compare(&function, 8)
}
