//! Obstacles, proven-free space and one path on a map that was read from a file.

use rand::SeedableRng as _;
use rand_pcg::Pcg64;
use rrt_refine::{
    Bounds, MotionValidator, Path, PlanError, Refined, RrtConfig, RrtStarConfig, refine, rrt,
    rrt_connect, rrt_star,
};
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Space};

use crate::args::{Planner, Refiner};
use crate::failure::Failure;
use crate::input::LoadedMap;

/// Kept points to a cluster where K is not given.
const POINTS_PER_CLUSTER: usize = 12;
/// Radius of the body where it is not given, metres.
pub(crate) const RADIUS_M: f64 = 0.15;
/// Longest edge of the tree, metres.
const STEP_M: f64 = 0.75;
/// Space around the map's points in which paths may lead, metres.
const ROOM_M: f64 = 0.5;

/// Share of the points on each side of each axis that paths do not lead around.
const OUTERMOST: f64 = 0.01;

/// Everything that stands in the way, and what was seen through.
#[derive(Debug)]
pub(crate) struct Surroundings {
    pub(crate) obstacles: ObstacleSet,
    pub(crate) free: Option<FreeSpace>,
}

/// Clusters the points at these indices; `clusters` must not exceed their number.
pub(crate) fn surroundings(
    loaded: &LoadedMap,
    kept: &[usize],
    clusters: Option<usize>,
    units_per_meter: f64,
    seed: u64,
) -> Result<Surroundings, Failure> {
    let points: Vec<[f64; 3]> = kept
        .iter()
        .filter_map(|index| loaded.points.get(*index).copied())
        .collect();
    let clusters = check_clusters(clusters, points.len())?;
    let mut rng = Pcg64::seed_from_u64(seed);
    let config = ObstacleConfig::with_clusters(clusters);
    let obstacles = ObstacleSet::from_points(&points, &config, &mut rng)
        .map_err(|error| Failure::new(error, "choose another --clusters"))?;
    let free = match loaded.map.has_observations() {
        true => {
            // Hulls keep the body clear of obstacles; more distance to single points would close doors.
            let config = FreeSpaceConfig {
                clearance: 0.1,
                ..FreeSpaceConfig::default()
            }
            .scaled(units_per_meter);
            let free = FreeSpace::from_rays(loaded.rays(kept.iter().copied()), &points, &config);
            Some(free.map_err(|error| Failure::new(error, "give the map's unit with --scale"))?)
        }
        false => None,
    };
    Ok(Surroundings { obstacles, free })
}

fn check_clusters(clusters: Option<usize>, points: usize) -> Result<usize, Failure> {
    match clusters {
        None => Ok((points / POINTS_PER_CLUSTER).max(1)),
        Some(0) => Err(Failure::new(
            "--clusters 0 makes no obstacle",
            "ask for at least 1",
        )),
        Some(clusters) if clusters > points => Err(Failure::new(
            format!("--clusters {clusters} is more than the map's {points} points"),
            format!("ask for at most {points}"),
        )),
        Some(clusters) => Ok(clusters),
    }
}

impl Surroundings {
    /// The space that paths may use: proven-free where there is any proof and it is asked for.
    pub(crate) fn space(&self, proven: bool) -> Result<Space<'_>, Failure> {
        match (&self.free, proven) {
            (_, false) => Ok(Space::Hulls(&self.obstacles)),
            (Some(free), true) => Ok(Space::ProvenFree {
                hulls: &self.obstacles,
                free,
            }),
            (None, true) => Err(Failure::new(
                "the map has no observations, so nothing is proven free",
                "use --space hulls, or a map folder with keyframes and observations",
            )),
        }
    }
}

/// What is asked of a planner.
#[derive(Debug)]
pub(crate) struct Question<'a> {
    pub(crate) from: [f64; 3],
    pub(crate) to: [f64; 3],
    pub(crate) radius: f64,
    pub(crate) space: Space<'a>,
    pub(crate) planner: Planner,
    pub(crate) refiner: Refiner,
    pub(crate) units_per_meter: f64,
    pub(crate) seed: u64,
}

/// A planner's answer.
#[derive(Debug)]
pub(crate) struct Answer {
    /// Raw and refined, when there is a path.
    pub(crate) paths: Option<(Path<3>, Path<3>)>,
    /// Motions checked, planning and refining together.
    pub(crate) checks: usize,
}

/// Plans and refines. A start or goal that is not free is an error; no path within the budget is not.
pub(crate) fn plan(question: &Question<'_>, points: &[[f64; 3]]) -> Result<Answer, Failure> {
    let &Question {
        from,
        to,
        radius,
        space,
        units_per_meter,
        ..
    } = question;
    let free = |a: &[f64; 3], b: &[f64; 3]| space.motion_is_free(*a, *b, radius);
    let bounds = bounds(question, points)?;
    let config = RrtConfig {
        step_length: STEP_M * units_per_meter,
        ..RrtConfig::default()
    };
    let star = RrtStarConfig {
        rrt: config,
        ..RrtStarConfig::default()
    };
    let informed = RrtStarConfig {
        rrt: config,
        ..RrtStarConfig::informed()
    };
    let mut rng = Pcg64::seed_from_u64(question.seed);
    let found = match question.planner {
        Planner::Rrt => rrt(from, to, &bounds, &free, &config, &mut rng),
        Planner::RrtConnect => rrt_connect(from, to, &bounds, &free, &config, &mut rng),
        Planner::RrtStar => rrt_star(from, to, &bounds, &free, &star, &mut rng),
        Planner::InformedRrtStar => rrt_star(from, to, &bounds, &free, &informed, &mut rng),
    };
    let found = found.map_err(|error| refusal(&error))?;
    let Some(raw) = found.path else {
        return Ok(Answer {
            paths: None,
            checks: found.checks,
        });
    };
    let refined = refine_path(question, &raw, &free)?;
    let checks = found.checks + refined.as_ref().map_or(0, |refined| refined.checks);
    let path = refined.map_or_else(|| raw.clone(), |refined| refined.path);
    Ok(Answer {
        paths: Some((raw, path)),
        checks,
    })
}

fn refine_path(
    question: &Question<'_>,
    raw: &Path<3>,
    free: &impl MotionValidator<3>,
) -> Result<Option<Refined<3>>, Failure> {
    Ok(match question.refiner {
        Refiner::None => None,
        Refiner::Dag => Some(refine::dag(raw, free)),
        Refiner::Greedy => Some(refine::greedy(raw, free)),
        Refiner::Rope => {
            let max_step = 0.1 * question.units_per_meter;
            let config = refine::RopeConfig {
                max_step,
                ..refine::RopeConfig::default()
            };
            Some(refine::rope(raw, free, &config).map_err(Failure::internal)?)
        }
    })
}

/// The box of the points, less the outermost of each axis, and of both ends of the path.
fn bounds(question: &Question<'_>, points: &[[f64; 3]]) -> Result<Bounds<3>, Failure> {
    let mut corners = vec![question.from, question.to];
    for tail in [OUTERMOST, 1.0 - OUTERMOST] {
        corners.extend(quantiles(points, tail));
    }
    Bounds::around(&corners, ROOM_M * question.units_per_meter)
        .map_err(|error| Failure::new(error, "check the map's coordinates"))
}

/// A quantile of each axis; none of no points.
pub(crate) fn quantiles(points: &[[f64; 3]], share: f64) -> Option<[f64; 3]> {
    let last = points.len().checked_sub(1)?;
    let mut corner = [0.0; 3];
    for (axis, value) in corner.iter_mut().enumerate() {
        let mut values: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        values.sort_by(f64::total_cmp);
        *value = *values.get((last as f64 * share).round() as usize)?;
    }
    Some(corner)
}

fn refusal(error: &PlanError) -> Failure {
    Failure::new(
        error,
        "move --from and --to into the open, make --radius smaller, or use --space hulls",
    )
}

/// Least distance between the path and any hull; none without obstacles.
pub(crate) fn min_clearance(obstacles: &ObstacleSet, path: &[[f64; 3]]) -> Option<f64> {
    let legs = path
        .windows(2)
        .map(|leg| obstacles.clearance(leg[0], leg[1]));
    legs.reduce(f64::min)
        .filter(|clearance| clearance.is_finite())
}
