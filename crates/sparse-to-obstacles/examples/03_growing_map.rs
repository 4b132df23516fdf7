//! A map that grows: the obstacles are updated from the former ones, and written as a mesh.
//!
//! Expected output: the update takes a few passes and reuses hulls; the mesh is an OBJ file.
#![allow(clippy::print_stdout)]

use rand::{RngExt, SeedableRng};
use sparse_to_obstacles::{ObstacleConfig, ObstacleSet};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    // Posters on a wall; the map first ends at 5 m, then the next poster comes into view.
    let points: Vec<[f64; 3]> = (0..3000)
        .map(|i| {
            let poster = if i < 2500 { f64::from(i % 5) } else { 5.0 };
            [
                poster + 0.6 * rng.random::<f64>(),
                3.0,
                1.0 + 0.8 * rng.random::<f64>(),
            ]
        })
        .collect();
    let config = ObstacleConfig::with_clusters(100);
    let mut obstacles = ObstacleSet::from_points(&points[..2500], &config, &mut rng)?;
    println!("first map: {} obstacles", obstacles.len());
    let update = obstacles.update(&points, &[], &config, &mut rng)?;
    println!("grown map: {} obstacles, {update:?}", obstacles.len());
    let mut mesh = Vec::new();
    obstacles.write_obj(&mut mesh)?;
    println!("OBJ of {} bytes", mesh.len());
    Ok(())
}
