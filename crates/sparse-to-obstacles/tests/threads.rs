//! Any number of threads gives the same bits.

#![cfg(feature = "rayon")]

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use sparse_to_obstacles::{
    KMeansConfig, KMeansMethod, KMeansSeeding, ObstacleConfig, ObstacleSet, Ray, kmeans,
};

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

#[test]
fn every_seeding_method_and_split_gives_the_same_bits_on_any_number_of_threads() {
    let mut rng = Pcg64::seed_from_u64(5);
    let points: Vec<[f64; 3]> = (0..6000)
        .map(|_| [0, 1, 2].map(|_| 10.0 * rng.random::<f64>()))
        .collect();
    let rays: Vec<Ray> = points
        .iter()
        .map(|&end| Ray {
            origin: [5.0, 5.0, 1.0],
            end,
        })
        .collect();
    let seedings = [
        KMeansSeeding::PlusPlus { trials: Some(1) },
        KMeansSeeding::Parallel {
            rounds: 5,
            oversampling: 2.0,
        },
    ];
    let methods = [
        KMeansMethod::Lloyd,
        KMeansMethod::Accelerated,
        KMeansMethod::MiniBatch { batch: 500 },
    ];
    let all = || {
        let mut rng = Pcg64::seed_from_u64(6);
        let mut clusterings = Vec::new();
        for seeding in seedings {
            for method in methods {
                let config = KMeansConfig {
                    clusters: 60,
                    seeding,
                    method,
                    ..KMeansConfig::default()
                };
                clusterings.push(kmeans(&points, &config, &mut rng).unwrap());
            }
        }
        let config = ObstacleConfig {
            max_diameter: 2.0,
            ..ObstacleConfig::with_clusters(60)
        };
        let split = ObstacleSet::from_observed_points(&points, &rays, &config, &mut rng).unwrap();
        assert!(split.len() > 60, "nothing was split");
        (clusterings, split.obstacles().to_vec())
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(all)
    };
    assert!(on(1) == on(4));
}
