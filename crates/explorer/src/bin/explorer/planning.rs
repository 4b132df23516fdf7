//! Obstacles, proven-free space and one path on a map that was read from a file.

use rand::SeedableRng as _;
use rand_pcg::Pcg64;
use rrt_refine::{
    Bounds, FindPathConfig, MotionValidator, Path, PlanError, Query, Refined, RrtConfig,
    RrtStarConfig, find_path, refine, rrt, rrt_connect, rrt_star,
};
use sparse_to_obstacles::{
    Berth, FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Space, kmeans,
};

use crate::args::{Planner, Refiner};
use crate::failure::Failure;
use crate::input::LoadedMap;
use crate::stopwatch::timed;

/// Kept points to a cluster where K is not given.
const POINTS_PER_CLUSTER: usize = 12;
/// Radius of the body where it is not given, metres.
pub(crate) const RADIUS_M: f64 = 0.15;
/// Longest edge of the tree, metres.
const STEP_M: f64 = 1.5;
/// Space around the map's points in which paths may lead, metres.
const ROOM_M: f64 = 0.5;

/// Share of the points on each side of each axis that paths do not lead around.
const OUTERMOST: f64 = 0.01;

/// Edge of a voxel of proven-free space, metres: finer than the library's default, since an exported place stands for its whole voxel.
const VOXEL_M: f64 = 0.08;

/// Everything that stands in the way, and what was seen through.
#[derive(Debug)]
pub(crate) struct Surroundings {
    pub(crate) obstacles: ObstacleSet,
    pub(crate) free: Option<FreeSpace>,
    pub(crate) seconds: Seconds,
}

/// What building took, seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seconds {
    pub(crate) kmeans: f64,
    pub(crate) hulls: f64,
    pub(crate) free_space: f64,
}

/// Obstacles and proven-free space. For planners the obstacles are the points at the indices `kept` without those that rays
/// contradict, for measuring (`None`) all points.
pub(crate) fn surroundings(
    loaded: &LoadedMap,
    kept: Option<&[usize]>,
    clusters: Option<usize>,
    units_per_meter: f64,
    seed: u64,
) -> Result<Surroundings, Failure> {
    let mut points = kept.map_or_else(|| loaded.points.clone(), |kept| at(&loaded.points, kept));
    let clusters = check_clusters(clusters, points.len())?;
    let (free, free_space) = timed(|| prove(loaded, units_per_meter));
    let free = free?;
    if let (Some(_), Some(free)) = (kept, &free) {
        points.retain(|point| !free.contradicts(*point));
    }
    let (obstacles, kmeans, hulls) = hulls(&points, clusters.min(points.len()), seed)?;
    Ok(Surroundings {
        obstacles,
        free,
        seconds: Seconds {
            kmeans,
            hulls,
            free_space,
        },
    })
}

/// The settings of proven-free space, for the export and for paths alike.
fn free_space_config(units_per_meter: f64) -> FreeSpaceConfig {
    FreeSpaceConfig {
        resolution: VOXEL_M,
        ..FreeSpaceConfig::default()
    }
    .scaled(units_per_meter)
}

/// The obstacles, and the seconds that K-means and the hulls took.
fn hulls(
    points: &[[f64; 3]],
    clusters: usize,
    seed: u64,
) -> Result<(ObstacleSet, f64, f64), Failure> {
    if clusters == 0 {
        return Ok((ObstacleSet::default(), 0.0, 0.0));
    }
    let mut rng = Pcg64::seed_from_u64(seed);
    let config = ObstacleConfig::with_clusters(clusters).kmeans;
    let advice = "choose another --clusters";
    let (clustering, seconds) = timed(|| kmeans(points, &config, &mut rng));
    let clustering = clustering.map_err(|error| Failure::new(error, advice))?;
    let (set, hull_seconds) = timed(|| ObstacleSet::from_clustering(points, &clustering));
    let set = set.map_err(|error| Failure::new(error, advice))?;
    Ok((set, seconds, hull_seconds))
}

/// Proven-free space of a map with observations, for the export and for paths alike: from the rays to all points, keeping away
/// from every point that the rays do not contradict.
///
/// Outliers take part. A true point among them would leave triangles that reach past it and a surface that nothing keeps away
/// from; a wrong one proves nothing alone, and opens nothing.
fn prove(loaded: &LoadedMap, units_per_meter: f64) -> Result<Option<FreeSpace>, Failure> {
    if !loaded.map.has_observations() {
        return Ok(None);
    }
    let config = free_space_config(units_per_meter);
    let points = &loaded.points;
    let nothing: [[f64; 3]; 0] = [];
    let mut free = FreeSpace::from_rays(loaded.rays(0..points.len()), &nothing, &config)
        .map_err(|error| Failure::new(error, "give the map's unit with --scale"))?;
    let solid = points.iter().copied();
    let solid: Vec<[f64; 3]> = solid.filter(|&point| !free.contradicts(point)).collect();
    free.insert([], &solid).map_err(Failure::internal)?;
    Ok(Some(free))
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
    /// The agent is there with this radius, so that place is free whatever points and rays say.
    pub(crate) fn open(&mut self, place: [f64; 3], radius: f64) -> Result<(), Failure> {
        let cleared = self.obstacles.clear_ball(place, radius);
        cleared.map_err(Failure::internal)?;
        match &mut self.free {
            Some(free) => free.add_ball(place, radius).map_err(Failure::internal),
            None => Ok(()),
        }
    }

    /// Where a body of this radius fits in proven-free space.
    pub(crate) fn places(&self, radius: f64) -> Vec<[f64; 3]> {
        let free = self.free.as_ref();
        free.map(|free| free.places(radius)).unwrap_or_default()
    }

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

impl Question<'_> {
    /// What every planner is told.
    fn config(&self) -> RrtConfig {
        RrtConfig {
            step_length: STEP_M * self.units_per_meter,
            ..RrtConfig::default()
        }
    }

    /// What to keep free around the path, the widest first. The paper's hulls are asked for the radius alone.
    fn berths(&self) -> impl Iterator<Item = Berth> {
        let berths = Berth::widest_first(self.radius, [self.from, self.to]);
        let proven = matches!(self.space, Space::ProvenFree { .. });
        berths.filter(move |berth| proven || berth.width <= berth.radius)
    }

    /// Where paths may lead: the box of the points, less the outermost of each axis, and of both ends.
    pub(crate) fn bounds(&self, points: &[[f64; 3]]) -> Result<Bounds<3>, Failure> {
        let mut corners = vec![self.from, self.to];
        for tail in [OUTERMOST, 1.0 - OUTERMOST] {
            corners.extend(quantiles(points, tail));
        }
        Bounds::around(&corners, ROOM_M * self.units_per_meter)
            .map_err(|error| Failure::new(error, "check the map's coordinates"))
    }
}

/// A planner's answer.
#[derive(Debug)]
pub(crate) struct Answer {
    /// Raw, refined, and the berth that they keep, when there is a path.
    pub(crate) paths: Option<(Path<3>, Path<3>, f64)>,
    /// Motions checked, planning and refining together.
    pub(crate) checks: usize,
}

/// Plans and refines, in proven space with the widest berth that there is a path with. A start or goal that is not free is an error;
/// no path within the budget is not.
pub(crate) fn plan(question: &Question<'_>, bounds: &Bounds<3>) -> Result<Answer, Failure> {
    let mut checks = 0;
    for berth in question.berths() {
        let free = |a: &[f64; 3], b: &[f64; 3]| berth.allows(&question.space, *a, *b);
        let answer = attempt(question, bounds, &free)?;
        checks += answer.checks;
        if let Some(paths) = answer.paths {
            return Ok(Answer {
                paths: Some((paths.0, paths.1, berth.width)),
                checks,
            });
        }
    }
    Ok(Answer {
        paths: None,
        checks,
    })
}

/// What one berth gives.
struct Attempt {
    paths: Option<(Path<3>, Path<3>)>,
    checks: usize,
}

/// The default planner and refiner go on looking for anything shorter; any other pair is asked once.
fn attempt(
    question: &Question<'_>,
    bounds: &Bounds<3>,
    free: &impl MotionValidator<3>,
) -> Result<Attempt, Failure> {
    let query = Query::new(question.from, question.to, *bounds);
    let mut rng = Pcg64::seed_from_u64(question.seed);
    if question.planner == Planner::RrtConnect && question.refiner == Refiner::Dag {
        let config = FindPathConfig {
            rrt: question.config(),
            ..FindPathConfig::default()
        };
        let found = find_path(&query, free, &config, &mut rng).map_err(|error| refusal(&error))?;
        return Ok(Attempt {
            paths: found.plan.path.zip(found.path),
            checks: found.checks,
        });
    }
    let found = search(question, &query, free, &mut rng).map_err(|error| refusal(&error))?;
    let mut attempt = Attempt {
        paths: None,
        checks: found.checks,
    };
    if let Some(raw) = found.path {
        let refined = refine_path(question, &raw, free)?;
        attempt.checks += refined.as_ref().map_or(0, |refined| refined.checks);
        let path = refined.map_or_else(|| raw.clone(), |refined| refined.path);
        attempt.paths = Some((raw, path));
    }
    Ok(attempt)
}

fn search(
    question: &Question<'_>,
    query: &Query<3>,
    free: &impl MotionValidator<3>,
    rng: &mut Pcg64,
) -> Result<rrt_refine::Plan<3>, PlanError> {
    let config = question.config();
    let star = |base: RrtStarConfig| RrtStarConfig {
        rrt: config,
        ..base
    };
    match question.planner {
        Planner::Rrt => rrt(query, free, &config, rng),
        Planner::RrtConnect => rrt_connect(query, free, &config, rng),
        Planner::RrtStar => {
            let config = star(RrtStarConfig::default());
            rrt_star(query, free, &config, rng)
        }
        Planner::InformedRrtStar => {
            let config = star(RrtStarConfig::informed());
            rrt_star(query, free, &config, rng)
        }
    }
}

fn refine_path(
    question: &Question<'_>,
    raw: &Path<3>,
    free: &impl MotionValidator<3>,
) -> Result<Option<Refined<3>>, Failure> {
    Ok(match question.refiner {
        Refiner::None => None,
        Refiner::Dag => {
            let config = refine::TautConfig::default();
            Some(refine::taut(raw, free, &config).map_err(Failure::internal)?)
        }
        Refiner::Vertices => Some(refine::dag(raw, free)),
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

/// The points at these indices.
pub(crate) fn at(points: &[[f64; 3]], indices: &[usize]) -> Vec<[f64; 3]> {
    let points = indices.iter().map(|index| points.get(*index).copied());
    points.flatten().collect()
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
