//! A planned and refined path to one reachable place.
//!
//! Method: where the flood's way is roomy all along, RRT (LaValle 1998, the paper's planner) in the box around the places that the flood
//!         reached; where it leads through something narrow, or the tree finds nothing within its budget, the flood's own way, which
//!         keeps to the middle. Then the shortest path in the visibility DAG of its vertices (the paper's sub-path replacement, done
//!         optimally), where a shortcut needs as much room as its tighter end has.

use nalgebra::Point3;
use rand::Rng;
use rrt_refine::{Bounds, MotionValidator, Path, Query, RrtConfig, refine, rrt};

use crate::config::ExplorationConfig;
use crate::reach::Reach;
use crate::scene::Scene;
use crate::stage::{Stage, StageObserver, staged};

/// Share of the room at its tighter end that a shortcut keeps all along: with all of it hardly any shortcut past a corner is left.
const SHORTCUT_ROOM: f64 = 0.75;

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

/// Radii of a route, map units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RouteRadii {
    /// Kept free everywhere.
    pub least: f64,
    /// Kept free where there is room.
    pub comfortable: f64,
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
        match Path::new(&raw) {
            Ok(path) => Self::refined(path, false, &free_for(scene, radius)),
            Err(_) => Self {
                path: raw.clone(),
                raw,
                by_tree: false,
            },
        }
    }

    /// Plans from the flood's start to its place `index`.
    pub fn plan(
        scene: &Scene,
        reach: &Reach,
        index: usize,
        radii: RouteRadii,
        config: &ExplorationConfig,
        rng: &mut impl Rng,
        stages: &mut dyn StageObserver,
    ) -> Option<Self> {
        let way = reach.path_to(index);
        let roomy = way.iter().all(|at| at.clearance >= radii.comfortable);
        let flooded: Vec<[f64; 3]> = way.iter().map(|at| at.position.into()).collect();
        let tree = staged(stages, Stage::Plan, || {
            let tree = || grow(scene, reach, &flooded, radii.comfortable, config, rng);
            roomy.then(tree).flatten()
        });
        let by_tree = tree.is_some();
        let raw = tree.or_else(|| Path::new(&flooded).ok())?;
        let free = |a: &[f64; 3], b: &[f64; 3]| is_roomy(scene, a, b, radii);
        Some(staged(stages, Stage::Refine, || {
            Self::refined(raw, by_tree, &free)
        }))
    }

    fn refined(raw: Path<3>, by_tree: bool, free: &impl MotionValidator<3>) -> Self {
        Self {
            path: refine::dag(&raw, free).path.into_points(),
            raw: raw.into_points(),
            by_tree,
        }
    }
}

/// Whether a ball of `radius` may go straight from one place to another.
fn free_for(scene: &Scene, radius: f64) -> impl Fn(&[f64; 3], &[f64; 3]) -> bool {
    move |&a, &b| scene.motion_is_free(&a.into(), &b.into(), radius)
}

/// Whether the straight way has the room all along that its tighter end has.
fn is_roomy(scene: &Scene, a: &[f64; 3], b: &[f64; 3], radii: RouteRadii) -> bool {
    if !free_for(scene, radii.least)(a, b) {
        return false;
    }
    let room = |&place: &[f64; 3]| scene.clearance(&place.into(), radii.comfortable);
    let radius = SHORTCUT_ROOM * room(a).min(room(b));
    radius <= radii.least || free_for(scene, radius)(a, b)
}

/// One tree from the first to the last of the flooded places.
fn grow(
    scene: &Scene,
    reach: &Reach,
    flooded: &[[f64; 3]],
    radius: f64,
    config: &ExplorationConfig,
    rng: &mut impl Rng,
) -> Option<Path<3>> {
    let corners: Vec<[f64; 3]> = reach.positions().map(Into::into).collect();
    let bounds = Bounds::around(&corners, scene.units(config.rrt_step_m)).ok()?;
    let settings = RrtConfig {
        step_length: scene.units(config.rrt_step_m),
        max_iterations: config.rrt_iterations,
        ..RrtConfig::default()
    };
    let query = Query::new(*flooded.first()?, *flooded.last()?, bounds);
    let free = free_for(scene, radius);
    rrt(&query, &free, &settings, rng).ok()?.path
}
