//! Tests of K-means: laws, equality of the methods, degenerate and wrong input.

use super::*;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn rng(seed: u64) -> Pcg64 {
    Pcg64::seed_from_u64(seed)
}

/// Blobs on an integer grid: many exact ties and duplicates.
fn gridded(count: usize, seed: u64) -> Vec<Vec3> {
    let mut rng = rng(seed);
    (0..count)
        .map(|_| [0, 1, 2].map(|_| f64::from(rng.random_range(0..6_i32))))
        .collect()
}

fn spread(count: usize, seed: u64) -> Vec<Vec3> {
    let mut rng = rng(seed);
    (0..count)
        .map(|_| [10.0, 7.0, 2.5].map(|size| size * rng.random::<f64>()))
        .collect()
}

fn config(clusters: usize) -> KMeansConfig {
    KMeansConfig {
        clusters,
        tolerance: 0.0,
        swap_rounds: 0,
        ..KMeansConfig::default()
    }
}

#[test]
fn accelerated_equals_lloyd_bit_for_bit() {
    for seed in 0..6 {
        for (points, clusters) in [(spread(900, seed), 40), (gridded(300, seed), 25)] {
            let lloyd = KMeansConfig {
                method: KMeansMethod::Lloyd,
                ..config(clusters)
            };
            let reference = kmeans(&points, &lloyd, &mut rng(seed)).unwrap();
            let fast = kmeans(&points, &config(clusters), &mut rng(seed)).unwrap();
            assert_eq!(reference, fast);
            assert_eq!(fast.stop, KMeansStop::Converged);
        }
    }
}

#[test]
fn inertia_never_increases() {
    let points = spread(500, 3);
    let mut last = f64::INFINITY;
    for max_iterations in 1..25 {
        let config = KMeansConfig {
            max_iterations,
            ..config(30)
        };
        let clustering = kmeans(&points, &config, &mut rng(5)).unwrap();
        assert!(clustering.inertia <= last * (1.0 + 1e-12));
        last = clustering.inertia;
    }
}

#[test]
fn greedy_seeding_skips_nothing_that_matters() {
    // One candidate per seed without skipping, by brute force on the same draws.
    let points = spread(300, 8);
    let seeds = plus_plus::seed(&points, &[], 20, Some(4), &mut rng(2));
    assert_eq!(seeds.len(), 20);
    let clustering = kmeans(&points, &config(20), &mut rng(2)).unwrap();
    let random: f64 = {
        let first: Vec<Vec3> = points[..20].to_vec();
        let start = kmeans_from(&points, &first, &config(20), &mut rng(2)).unwrap();
        start.inertia
    };
    assert!(clustering.inertia <= random * 1.1);
}

#[test]
fn every_seeding_and_method_gives_clusters_without_empty_ones() {
    let points = gridded(400, 1);
    for seeding in [
        KMeansSeeding::PlusPlus { trials: Some(1) },
        KMeansSeeding::Parallel {
            rounds: 5,
            oversampling: 2.0,
        },
        KMeansSeeding::Parallel {
            rounds: 1,
            oversampling: 0.01,
        },
    ] {
        for method in [
            KMeansMethod::Lloyd,
            KMeansMethod::Accelerated,
            KMeansMethod::MiniBatch { batch: 64 },
        ] {
            let config = KMeansConfig {
                seeding,
                method,
                ..config(50)
            };
            let clustering = kmeans(&points, &config, &mut rng(4)).unwrap();
            assert_eq!(clustering.centroids.len(), 50);
            assert!(
                clustering
                    .members()
                    .iter()
                    .all(|members| !members.is_empty())
            );
            assert_eq!(clustering, kmeans(&points, &config, &mut rng(4)).unwrap());
        }
    }
}

#[test]
fn warm_start_on_a_grown_map_needs_few_iterations() {
    let points = spread(2000, 9);
    let cold = kmeans(&points[..1900], &config(60), &mut rng(1)).unwrap();
    let warm = kmeans_from(&points, &cold.centroids, &config(60), &mut rng(1)).unwrap();
    let again = kmeans(&points, &config(60), &mut rng(1)).unwrap();
    assert!(warm.iterations < again.iterations);
    assert!(warm.inertia < 1.05 * again.inertia);
}

#[test]
fn warm_start_takes_what_it_can_use() {
    let points = spread(50, 9);
    let known = [[f64::NAN; 3], [0.0; 3], [0.0; 3], [9.0, 1.0, 1.0]];
    for clusters in [1, 2, 3, 8] {
        let clustering = kmeans_from(&points, &known, &config(clusters), &mut rng(1)).unwrap();
        assert_eq!(clustering.centroids.len(), clusters);
        assert!(
            clustering
                .members()
                .iter()
                .all(|members| !members.is_empty())
        );
    }
}

#[test]
fn fewer_distinct_points_than_clusters_give_one_cluster_each() {
    let points = [
        [1.0, 2.0, 3.0],
        [1.0, 2.0, 3.0],
        [4.0, 2.0, 3.0],
        [1.0, 2.0, 3.0],
    ];
    let clustering = kmeans(&points, &config(3), &mut rng(1)).unwrap();
    assert_eq!(clustering.centroids.len(), 2);
    assert_eq!(clustering.inertia, 0.0);
    assert_eq!(clustering.stop, KMeansStop::Converged);
}

#[test]
fn as_many_clusters_as_points_have_no_inertia() {
    let points = spread(40, 2);
    let clustering = kmeans(&points, &config(40), &mut rng(1)).unwrap();
    assert_eq!(clustering.inertia, 0.0);
}

#[test]
fn wrong_input_is_refused_with_numbers() {
    let points = spread(5, 1);
    let none: [Vec3; 0] = [];
    let run = |points: &[Vec3], config: KMeansConfig| kmeans(points, &config, &mut rng(1));
    assert_eq!(run(&none, config(1)), Err(KMeansError::NoPoints));
    assert_eq!(run(&points, config(0)), Err(KMeansError::NoClusters));
    let many = KMeansError::TooManyClusters {
        clusters: 6,
        points: 5,
    };
    assert_eq!(run(&points, config(6)), Err(many));
    let mut broken = points.clone();
    broken[3][1] = f64::NAN;
    assert_eq!(
        run(&broken, config(1)),
        Err(KMeansError::NotFinite { index: 3 })
    );
    broken[3][1] = 1e200;
    assert!(matches!(
        run(&broken, config(1)),
        Err(KMeansError::TooLarge { index: 3, .. })
    ));
    for wrong in [
        KMeansConfig {
            max_iterations: 0,
            ..config(1)
        },
        KMeansConfig {
            tolerance: f64::NAN,
            ..config(1)
        },
        KMeansConfig {
            seeding: KMeansSeeding::PlusPlus { trials: Some(0) },
            ..config(1)
        },
        KMeansConfig {
            method: KMeansMethod::MiniBatch { batch: 0 },
            ..config(1)
        },
    ] {
        assert!(run(&points, wrong).is_err());
    }
}

#[test]
fn swaps_only_lower_the_inertia_and_keep_the_methods_equal() {
    let points = spread(900, 11);
    let mut last = f64::INFINITY;
    for swap_rounds in 0..5 {
        let config = KMeansConfig {
            swap_rounds,
            ..config(40)
        };
        let lloyd = KMeansConfig {
            method: KMeansMethod::Lloyd,
            ..config.clone()
        };
        let fast = kmeans(&points, &config, &mut rng(1)).unwrap();
        assert_eq!(fast, kmeans(&points, &lloyd, &mut rng(1)).unwrap());
        assert!(fast.inertia <= last);
        last = fast.inertia;
    }
}

proptest! {
    #[test]
    fn the_tree_finds_what_brute_force_finds(
        centroids in prop::collection::vec(prop::array::uniform3(-4_i32..4), 1..60),
        query in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        let centroids: Vec<Vec3> = centroids.iter().map(|c| c.map(f64::from)).collect();
        let tree = tree::CentroidTree::new(&centroids);
        for query in [query, query.map(f64::round)] {
            let mut brute = tree::NearestTwo::NONE;
            for (index, &centroid) in centroids.iter().enumerate() {
                brute.offer(index, distance_squared(query, centroid));
            }
            let found = tree.nearest_two(query);
            prop_assert_eq!(found.index, brute.index);
            prop_assert_eq!(found.squared, brute.squared);
            prop_assert_eq!(found.second_squared, brute.second_squared);
        }
    }
}
