//! A planned and refined path to one reachable place.
//!
//! Method: where the flood's way is roomy all along, RRT (LaValle 1998, the paper's planner) in the box around the places that the flood
//!         reached; where it leads through something narrow, or the tree finds nothing within its budget, the flood's own way, which
//!         keeps to the middle. Then the shortest path in the visibility DAG of its vertices (the paper's sub-path replacement, done
//!         optimally), where a shortcut needs as much room as its tighter end has.

use nalgebra::Point3;
use rand::Rng;
use rrt_refine::{Bounds, Path, Query, RrtConfig, refine, rrt};

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
        let narrowest = way
            .iter()
            .fold(f64::INFINITY, |least, place| least.min(place.clearance));
        let flooded: Vec<[f64; 3]> = way.iter().map(|place| place.position.into()).collect();
        let tree = staged(stages, Stage::Plan, || {
            (narrowest >= radii.comfortable)
                .then(|| grow(scene, reach, &flooded, radii.comfortable, config, rng))
                .flatten()
        });
        let by_tree = tree.is_some();
        let raw = match tree {
            Some(path) => path,
            None => Path::new(&flooded).ok()?,
        };
        let refined = staged(stages, Stage::Refine, || {
            let free =
                |a: &[f64; 3], b: &[f64; 3]| is_roomy(scene, &(*a).into(), &(*b).into(), radii);
            refine::dag(&raw, &free)
        });
        Some(Self {
            raw: raw.into_points(),
            path: refined.path.into_points(),
            by_tree,
        })
    }
}

/// Whether the straight way has the room all along that its tighter end has.
fn is_roomy(scene: &Scene, a: &Point3<f64>, b: &Point3<f64>, radii: RouteRadii) -> bool {
    if !scene.motion_is_free(a, b, radii.least) {
        return false;
    }
    let room = |place| scene.clearance(place, radii.comfortable);
    let radius = SHORTCUT_ROOM * room(a).min(room(b));
    radius <= radii.least || scene.motion_is_free(a, b, radius)
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
    let free =
        |a: &[f64; 3], b: &[f64; 3]| scene.motion_is_free(&(*a).into(), &(*b).into(), radius);
    let corners: Vec<[f64; 3]> = reach.positions().map(Into::into).collect();
    let bounds = Bounds::around(&corners, scene.units(config.rrt_step_m)).ok()?;
    let settings = RrtConfig {
        step_length: scene.units(config.rrt_step_m),
        max_iterations: config.rrt_iterations,
        ..RrtConfig::default()
    };
    let query = Query::new(*flooded.first()?, *flooded.last()?, bounds);
    rrt(&query, &free, &settings, rng).ok()?.path
}
