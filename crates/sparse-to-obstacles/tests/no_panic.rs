//! Whatever numbers come in, nothing panics, and what is not finite is never free.

use proptest::num::f64::ANY;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use sparse_to_obstacles::{
    Clustering, FreeSpace, FreeSpaceConfig, KMeansStop, ObstacleConfig, ObstacleSet, Ray,
};

/// Ordinary coordinates with a few of any kind: huge, tiny, infinite, NaN.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![20 => -5.0..5.0_f64, 2 => Just(0.0), 1 => ANY, 1 => Just(1e150), 1 => Just(1e200), 1 => Just(1e-200)]
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(coordinate())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn obstacles(
        points in prop::collection::vec(point(), 0..40),
        rays in prop::collection::vec((point(), point()), 0..20),
        clusters in 1_usize..12,
        max_diameter in prop_oneof![Just(f64::INFINITY), 0.01..3.0_f64],
        (a, b, radius) in (point(), point(), coordinate()),
    ) {
        let config =
            ObstacleConfig { max_diameter, ..ObstacleConfig::with_clusters(clusters) };
        let rays: Vec<Ray> = rays.iter().map(|&(origin, end)| Ray { origin, end }).collect();
        let mut rng = Pcg64::seed_from_u64(1);
        let labels = (0..points.len()).map(|i| i % clusters).collect();
        let clustering = Clustering {
            labels,
            centroids: vec![[0.0; 3]; clusters],
            inertia: 0.0,
            iterations: 1,
            stop: KMeansStop::Converged,
        };
        let sets = [
            ObstacleSet::from_observed_points(&points, &rays, &config, &mut rng),
            ObstacleSet::from_clustering(&points, &clustering),
        ];
        for set in sets.into_iter().flatten() {
            let free = set.motion_is_free(a, b, radius);
            let finite = a.iter().chain(&b).all(|c| c.is_finite()) && radius.is_finite();
            prop_assert!(finite || !free);
            let _ = (set.clearance(a, b), set.first_contact(a, b, radius));
            set.write_ply(std::io::sink())?;
        }
    }

    #[test]
    fn free_space(
        rays in prop::collection::vec((point(), point()), 0..30),
        surface in prop::collection::vec(point(), 0..20),
        resolution in prop_oneof![Just(0.1), 0.05..2.0_f64, coordinate()],
        (a, b, radius) in (point(), point(), coordinate()),
    ) {
        let finite = |p: &[f64; 3]| p.iter().all(|c| c.is_finite());
        let config = FreeSpaceConfig { resolution, max_voxels: 300_000, ..FreeSpaceConfig::default() };
        let as_rays = rays.iter().map(|&(origin, end)| Ray { origin, end });
        let ordinary = as_rays.clone().filter(|ray| {
            ray.origin.iter().chain(&ray.end).all(|c| c.abs() < 10.0)
        });
        let _ = FreeSpace::from_rays(as_rays, &surface, &config);
        let points: Vec<[f64; 3]> = surface.iter().copied().filter(finite).collect();
        if let Ok(mut space) = FreeSpace::from_rays(ordinary, &points, &config) {
            let free = space.motion_is_free(a, b, radius);
            prop_assert!((finite(&a) && finite(&b) && radius.is_finite()) || !free);
            let _ = (space.state(a), space.frontier(), space.add_ball(a, radius));
            let _ = space.motion_is_free(a, b, radius);
            prop_assert_eq!(space.voxel_count(), space.voxel_centers().len());
        }
    }
}
