//! A planned and refined path to one reachable place.
//!
//! Method: RRT (LaValle 1998, the paper's planner) in the box around the places that the flood reached, then the shortest path in the
//! visibility DAG of its vertices (the paper's sub-path replacement, done optimally). Where the tree finds nothing within its budget, the flood's
//! own path, free by construction, is refined instead.

use nalgebra::Point3;
use rand::Rng;
use rrt_refine::{Bounds, Path, RrtConfig, refine, rrt};

use crate::config::ExplorationConfig;
use crate::reach::Reach;
use crate::scene::Scene;
use crate::stage::{Stage, StageObserver, staged};

/// A path, map units.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// As planned, start first.
    pub raw: Vec<[f64; 3]>,
    /// As refined, start first.
    pub path: Vec<[f64; 3]>,
    /// Whether the tree found it; otherwise it is the flood's.
    pub by_tree: bool,
}

impl Route {
    /// Length of the refined path, map units.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.path
            .windows(2)
            .map(|leg| (Point3::from(leg[1]) - Point3::from(leg[0])).norm())
            .sum()
    }

    /// A path that needs no planning, refined for a ball of `radius`; all in map units, start first.
    #[must_use]
    pub fn along(scene: &Scene, raw: Vec<[f64; 3]>, radius: f64) -> Self {
        let free =
            |a: &[f64; 3], b: &[f64; 3]| scene.motion_is_free(&(*a).into(), &(*b).into(), radius);
        let path = Path::new(&raw).map_or_else(
            |_| raw.clone(),
            |path| refine::dag(&path, &free).path.into_points(),
        );
        Self {
            raw,
            path,
            by_tree: false,
        }
    }

    /// Plans from the flood's start to its place `index` for a ball of the widest of `radii` (map units, descending) that finds
    /// a way; the flood must have been made with the last of them.
    pub fn plan(
        scene: &Scene,
        reach: &Reach,
        index: usize,
        radii: &[f64],
        config: &ExplorationConfig,
        rng: &mut impl Rng,
        stages: &mut dyn StageObserver,
    ) -> Option<Self> {
        let flooded: Vec<[f64; 3]> = reach.path_to(index).into_iter().map(Into::into).collect();
        let least = *radii.last()?;
        let (tree, radius) = staged(stages, Stage::Plan, || {
            let grown = radii.iter().find_map(|&radius| {
                let path = grow(scene, reach, &flooded, radius, config, rng)?;
                Some((Some(path), radius))
            });
            grown.unwrap_or((None, least))
        });
        let by_tree = tree.is_some();
        let raw = match tree {
            Some(path) => path,
            None => Path::new(&flooded).ok()?,
        };
        let free =
            |a: &[f64; 3], b: &[f64; 3]| scene.motion_is_free(&(*a).into(), &(*b).into(), radius);
        let refined = staged(stages, Stage::Refine, || refine::dag(&raw, &free));
        Some(Self {
            raw: raw.into_points(),
            path: refined.path.into_points(),
            by_tree,
        })
    }
}

/// One tree from the first to the last of the flooded places, for one radius.
fn grow(
    scene: &Scene,
    reach: &Reach,
    flooded: &[[f64; 3]],
    radius: f64,
    config: &ExplorationConfig,
    rng: &mut impl Rng,
) -> Option<Path<3>> {
    let free =
        |a: &[f64; 3], b: &[f64; 3]| scene.motion_is_free(&(*a).into(), &(*b).into(), radius);
    let corners: Vec<[f64; 3]> = reach.positions().map(Into::into).collect();
    let bounds = Bounds::around(&corners, scene.units(config.rrt_step_m)).ok()?;
    let settings = RrtConfig {
        step_length: scene.units(config.rrt_step_m),
        max_iterations: config.rrt_iterations,
        ..RrtConfig::default()
    };
    rrt(
        *flooded.first()?,
        *flooded.last()?,
        &bounds,
        &free,
        &settings,
        rng,
    )
    .ok()?
    .path
}
