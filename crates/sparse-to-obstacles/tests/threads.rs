//! Any number of threads gives the same bits.

#![cfg(feature = "rayon")]

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use sparse_to_obstacles::{KMeansConfig, KMeansMethod, ObstacleConfig, ObstacleSet, kmeans};

#[test]
fn one_and_four_threads_agree() {
    let mut rng = Pcg64::seed_from_u64(1);
    let points: Vec<[f64; 3]> = (0..6000)
        .map(|_| [0, 1, 2].map(|_| 10.0 * rng.random::<f64>()))
        .collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut rng = Pcg64::seed_from_u64(2);
            let config = ObstacleConfig::with_clusters(200);
            let set = ObstacleSet::from_points(&points, &config, &mut rng).unwrap();
            (
                set.obstacles().to_vec(),
                set.centroids().to_vec(),
                set.inertia().to_bits(),
            )
        })
    };
    assert!(run(1) == run(4));
}

#[test]
fn threads_agree_with_the_reference() {
    let mut rng = Pcg64::seed_from_u64(3);
    let points: Vec<[f64; 3]> = (0..3000)
        .map(|_| [0, 1, 2].map(|_| 10.0 * rng.random::<f64>()))
        .collect();
    let run = |method: KMeansMethod| {
        let config = KMeansConfig {
            clusters: 50,
            method,
            ..KMeansConfig::default()
        };
        kmeans(&points, &config, &mut Pcg64::seed_from_u64(4)).unwrap()
    };
    assert!(run(KMeansMethod::Lloyd) == run(KMeansMethod::Accelerated));
}
