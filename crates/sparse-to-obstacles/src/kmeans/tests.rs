//! Tests of K-means: laws, equality of the methods, degenerate and wrong input.

mod exactness;

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

/// Twelve heaps of forty points, far apart.
fn heaps(seed: u64) -> Vec<Vec3> {
    let mut rng = rng(seed);
    let heap = |i: usize| [10.0 * (i % 4) as f64, 10.0 * (i / 4) as f64, 0.0];
    (0..480)
        .map(|i| crate::vector::add(heap(i % 12), [0, 1, 2].map(|_| rng.random::<f64>())))
        .collect()
}

const PARALLEL: KMeansSeeding = KMeansSeeding::Parallel {
    rounds: 5,
    oversampling: 2.0,
};

/// Mean inertia over ten runs of one pass, which the seeds decide.
fn seeded_inertia(points: &[Vec3], clusters: usize, seeding: KMeansSeeding) -> f64 {
    let config = KMeansConfig {
        seeding,
        max_iterations: 1,
        ..config(clusters)
    };
    let runs = (0..10).map(|seed| kmeans(points, &config, &mut rng(seed)).unwrap().inertia);
    runs.sum::<f64>() / 10.0
}

#[test]
fn both_seedings_spread_over_what_there_is() {
    for seed in 0..20 {
        let points = heaps(seed);
        for seeding in [KMeansSeeding::PlusPlus { trials: None }, PARALLEL] {
            let config = KMeansConfig {
                seeding,
                ..config(12)
            };
            let clustering = kmeans(&points, &config, &mut rng(seed)).unwrap();
            // Each heap is one cluster: one seed fell into each, or the inertia would be a hundred times this.
            assert!(clustering.members().iter().all(|heap| heap.len() == 40));
            assert!(clustering.inertia < 480.0 * 0.3, "{seeding:?} {seed}");
        }
    }
}

#[test]
fn seeds_of_both_kinds_are_about_as_good_and_better_than_chance() {
    let points = spread(2000, 3);
    let greedy = seeded_inertia(&points, 60, KMeansSeeding::PlusPlus { trials: None });
    let parallel = seeded_inertia(&points, 60, PARALLEL);
    let plain = seeded_inertia(&points, 60, KMeansSeeding::PlusPlus { trials: Some(1) });
    let chance = {
        let once = KMeansConfig {
            max_iterations: 1,
            ..config(60)
        };
        kmeans_from(&points, &points[..60], &once, &mut rng(1))
            .unwrap()
            .inertia
    };
    assert!(parallel < 1.05 * greedy, "{parallel} {greedy}");
    assert!(greedy < 0.95 * plain, "{greedy} {plain}");
    assert!(plain < chance, "{plain} {chance}");
}

#[test]
fn mini_batches_approach_what_all_points_give() {
    let points = spread(3000, 4);
    let exact = kmeans(&points, &config(40), &mut rng(1)).unwrap();
    let run = |batch, max_iterations| {
        let config = KMeansConfig {
            method: KMeansMethod::MiniBatch { batch },
            max_iterations,
            ..config(40)
        };
        kmeans(&points, &config, &mut rng(1)).unwrap()
    };
    let (few, many) = (run(50, 2), run(300, 200));
    assert_eq!((few.iterations, few.stop), (2, KMeansStop::MaxIterations));
    assert!(exact.inertia <= many.inertia && many.inertia < few.inertia);
    assert!(many.inertia < 1.06 * exact.inertia);
    // More than there are points is as many as there are.
    assert_eq!(run(usize::MAX, 3), run(3000, 3));
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
fn warm_start_on_a_grown_map_computes_few_distances() {
    let points = spread(4000, 9);
    let distances_of = |run: &mut dyn FnMut() -> Clustering| {
        let before = crate::vector::DISTANCES.get();
        let clustering = run();
        (crate::vector::DISTANCES.get() - before, clustering)
    };
    let cold = kmeans(&points[..3800], &KMeansConfig::plain(200), &mut rng(1)).unwrap();
    let plain = KMeansConfig::plain(200);
    let (anew, fresh) = distances_of(&mut || kmeans(&points, &plain, &mut rng(1)).unwrap());
    let (kept, warm) =
        distances_of(&mut || kmeans_from(&points, &cold.centroids, &plain, &mut rng(1)).unwrap());
    assert!(warm.inertia < 1.03 * fresh.inertia);
    // With several threads most are computed on others.
    if cfg!(not(feature = "rayon")) {
        assert!(2 * kept < anew, "{kept} distances instead of {anew}");
    }
}

#[test]
fn an_empty_cluster_takes_the_point_that_fits_worst() {
    /// Notes which labels were changed from outside.
    struct Noted(Vec<usize>);
    impl iterate::Assignment for Noted {
        fn assign(&mut self, _: &[Vec3], _: &[Vec3], _: &mut [usize]) {}
        fn moved(&mut self, _: &[Vec3], _: &[Vec3]) {}
        fn relabelled(&mut self, point: usize) {
            self.0.push(point);
        }
    }
    let points = [0.0, 0.1, 5.0, 9.0, 20.0].map(|x| [x, 0.0, 0.0]);
    let centroids = [0.0, 50.0, 20.5, 60.0].map(|x| [x, 0.0, 0.0]);
    let mut labels = [0, 0, 0, 0, 2];
    let mut noted = Noted(Vec::new());
    repair::fill_empty(&points, &centroids, &mut labels, &mut noted);
    // The two farthest from their centroid; the only point of cluster 2 stays.
    assert_eq!(labels, [0, 0, 3, 1, 2]);
    assert_eq!(noted.0, [3, 2]);
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
            seeding: KMeansSeeding::PlusPlus {
                trials: Some(usize::MAX),
            },
            ..config(1)
        },
        KMeansConfig {
            seeding: KMeansSeeding::Parallel {
                rounds: usize::MAX,
                oversampling: 1e-300,
            },
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
