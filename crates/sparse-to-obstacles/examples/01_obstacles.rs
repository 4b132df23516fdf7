//! Clusters the points of two walls with a doorway, and asks which motions are free.
//!
//! Expected output: 8 obstacles, a free way through the doorway, and the place where a drone that flies
//! into the wall first touches it.
#![allow(clippy::print_stdout)]

use rand::SeedableRng;
use sparse_to_obstacles::{ObstacleConfig, ObstacleError, ObstacleSet};

fn main() -> Result<(), ObstacleError> {
    // Walls in the plane x = 2, from y = 0.5 to 2.4 and from -0.5 to -2.4, two metres high.
    let column = |y: f64| (0..21).map(move |z| [2.0, y, 0.1 * f64::from(z)]);
    let walls: Vec<[f64; 3]> = (0..20)
        .flat_map(|i| [0.5 + 0.1 * f64::from(i), -0.5 - 0.1 * f64::from(i)])
        .flat_map(column)
        .collect();

    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    let config = ObstacleConfig::with_clusters(8);
    let obstacles = ObstacleSet::from_points(&walls, &config, &mut rng)?;
    println!(
        "{} obstacles, {} of them flat",
        obstacles.len(),
        obstacles.degenerate_count()
    );

    let radius = 0.3;
    let (a, b) = ([0.0, 0.0, 1.0], [4.0, 0.0, 1.0]);
    println!(
        "through the doorway: free = {}, clearance = {:.2} m",
        obstacles.motion_is_free(a, b, radius),
        obstacles.clearance(a, b)
    );
    let (a, b) = ([0.0, 1.5, 1.0], [4.0, 1.5, 1.0]);
    if let Some(contact) = obstacles.first_contact(a, b, radius) {
        println!(
            "into the wall: obstacle {} at {:.2?}",
            contact.obstacle, contact.centre
        );
    }
    Ok(())
}
