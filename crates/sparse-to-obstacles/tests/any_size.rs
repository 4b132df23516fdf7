//! Clusters and obstacles of any size, where squares vanish or overflow too: nothing panics, hangs or answers what is no number.
//!
//! A case has one size for most of its numbers, so that whole inputs lie at an end of the scale, and a few of any kind.

use proptest::num::f64::ANY;
use proptest::prelude::*;
use proptest::sample::select;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use sparse_to_obstacles::{
    KMeansConfig, KMeansMethod, KMeansSeeding, ObstacleConfig, ObstacleSet, Ray, kmeans,
    kmeans_from,
};

type Point = [f64; 3];

const SIZES: [f64; 11] = [
    5e-324, 1e-310, 1e-200, 1e-160, 1e-150, 1.0, 1.0, 1e100, 1e139, 1e154, 1e300,
];

/// Mostly of the given size, some huge, tiny, infinite or NaN.
fn number(size: f64) -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        40 => (-5.0..5.0_f64).prop_map(move |value| value * size),
        2 => Just(0.0),
        1 => ANY,
        1 => select(SIZES.to_vec()),
        1 => select(SIZES.to_vec()).prop_map(|value| -value),
    ]
}

/// Points, the ends of rays, a motion, and numbers for radius and settings.
type Case = (Vec<Point>, Vec<(Point, Point)>, [Point; 2], [f64; 3]);

/// All of one size.
fn case() -> impl Strategy<Value = Case> {
    select(SIZES.to_vec()).prop_flat_map(|size| {
        let point = || prop::array::uniform3(number(size));
        (
            prop::collection::vec(point(), 0..40),
            prop::collection::vec((point(), point()), 0..12),
            prop::array::uniform2(point()),
            prop::array::uniform3(number(size)),
        )
    })
}

fn is_finite(point: &Point) -> bool {
    point.iter().all(|c| c.is_finite())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn clusters(
        (points, _, known, [tolerance, oversampling, _]) in case(),
        clusters in 0_usize..12,
        huge in any::<bool>(),
    ) {
        let count = |small: usize| if huge { usize::MAX } else { small };
        let seedings = [
            KMeansSeeding::PlusPlus { trials: None },
            KMeansSeeding::PlusPlus { trials: Some(count(2)) },
            KMeansSeeding::Parallel { rounds: count(3), oversampling },
        ];
        let methods = [
            KMeansMethod::Lloyd,
            KMeansMethod::Accelerated,
            KMeansMethod::MiniBatch { batch: count(7) },
        ];
        for seeding in seedings {
            for method in methods {
                let config = KMeansConfig {
                    clusters,
                    seeding,
                    method,
                    max_iterations: 50,
                    tolerance,
                    swap_rounds: count(2),
                };
                let rng = || Pcg64::seed_from_u64(1);
                let cold = kmeans(&points, &config, &mut rng());
                let warm = kmeans_from(&points, &known, &config, &mut rng());
                prop_assert_eq!(cold.is_ok(), warm.is_ok());
                for clustering in [cold, warm].into_iter().flatten() {
                    prop_assert!(clustering.inertia.is_finite());
                    prop_assert!(clustering.centroids.iter().all(is_finite));
                    prop_assert!(clustering.members().iter().all(|members| !members.is_empty()));
                    prop_assert_eq!(clustering.labels.len(), points.len());
                }
            }
        }
    }

    #[test]
    fn obstacles(
        (points, rays, [a, b], [radius, max_diameter, ray_margin]) in case(),
        clusters in 1_usize..12,
    ) {
        let rays: Vec<Ray> = rays.iter().map(|&(origin, end)| Ray { origin, end }).collect();
        let plain = ObstacleConfig::with_clusters(clusters);
        let other = ObstacleConfig { max_diameter, ray_margin, ..plain.clone() };
        let mut rng = Pcg64::seed_from_u64(1);
        for config in [plain, other] {
            let Ok(mut set) = ObstacleSet::from_observed_points(&points, &rays, &config, &mut rng) else {
                continue;
            };
            for hull in set.obstacles() {
                prop_assert!(hull.vertices.iter().all(is_finite));
                prop_assert!(hull.triangles.iter().flatten().all(|&v| v < hull.vertices.len()));
            }
            prop_assert_eq!(set.obstacles().iter().map(|h| h.point_indices.len()).sum::<usize>(), points.len());
            let usable = is_finite(&a) && is_finite(&b) && radius >= 0.0 && radius.is_finite();
            let free = set.motion_is_free(a, b, radius);
            prop_assert!(usable || !free);
            let clearance = set.clearance(a, b);
            prop_assert_eq!(clearance.is_nan(), !(is_finite(&a) && is_finite(&b)));
            prop_assert!(clearance.is_nan() || clearance >= 0.0);
            match set.first_contact(a, b, radius) {
                Some(contact) => {
                    prop_assert!(!free && (0.0..=1.0).contains(&contact.at));
                    prop_assert!(contact.obstacle < set.len());
                }
                None => prop_assert!(free || !usable),
            }
            set.write_obj(std::io::sink())?;
            set.write_ply(std::io::sink())?;
            if set.clear_ball(a, radius).is_ok() {
                prop_assert!(set.motion_is_free(a, a, radius));
            }
            let _ = set.update(&points, &rays, &config, &mut rng);
        }
    }
}
