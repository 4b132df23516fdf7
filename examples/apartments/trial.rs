//! Queries between places that a scan saw, planned in some space and judged by the truth.

use std::error::Error;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rrt_refine::refine::{TautConfig, taut};
use rrt_refine::{Bounds, Path, Query, RrtConfig, rrt_connect};
use sparse_to_obstacles::{
    Berth, FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Ray, Space,
};

use crate::scan::{Place, Scan};

/// Radius of the drone with a margin for its errors, metres.
pub(crate) const RADIUS: f64 = 0.15;
/// Radius of its body.
const BODY: f64 = 0.1;
/// Most samples and nodes of a search: proven space has narrow passages.
const BUDGET: usize = 100_000;
/// Kept points to a cluster.
const POINTS_PER_CLUSTER: usize = 12;

/// What came of some queries in one space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tally {
    /// Queries with a way in truth.
    pub(crate) feasible: usize,
    pub(crate) solved: usize,
    /// Solved ones whose path passes through something solid.
    pub(crate) crossing: usize,
    /// Solved ones on which the body touches something solid.
    pub(crate) bumping: usize,
    /// Solved ones on which the body with its margin touches something solid.
    pub(crate) touching: usize,
    /// Least distance of a path's middle to something solid, metres.
    pub(crate) least: f64,
}

impl Default for Tally {
    fn default() -> Self {
        Tally {
            feasible: 0,
            solved: 0,
            crossing: 0,
            bumping: 0,
            touching: 0,
            least: f64::INFINITY,
        }
    }
}

impl Tally {
    pub(crate) fn add(&mut self, other: Tally) {
        self.feasible += other.feasible;
        self.solved += other.solved;
        self.crossing += other.crossing;
        self.bumping += other.bumping;
        self.touching += other.touching;
        self.least = self.least.min(other.least);
    }

    fn judge(&mut self, scan: &Scan, path: Option<Path<3>>) {
        self.feasible += 1;
        let Some(path) = path else { return };
        let legs = path.points().windows(2);
        let clearance = legs
            .map(|leg| scan.world.segment_clearance(leg[0], leg[1]))
            .fold(f64::INFINITY, f64::min);
        self.solved += 1;
        self.least = self.least.min(clearance);
        self.crossing += usize::from(clearance <= 0.0);
        self.bumping += usize::from(clearance < BODY);
        self.touching += usize::from(clearance < RADIUS);
    }
}

/// What a map says about where one can fly.
pub(crate) struct Belief {
    /// Hulls of all points: the paper.
    paper: ObstacleSet,
    /// Hulls of the points that no rays contradict.
    hulls: ObstacleSet,
    pub(crate) free: FreeSpace,
}

impl Belief {
    pub(crate) fn new(scan: &Scan, contradiction: f64, seed: u64) -> Result<Self, Box<dyn Error>> {
        // The default for motions among hulls: more distance to single points closes the way for a quarter of the queries.
        let config = FreeSpaceConfig {
            clearance: RADIUS,
            contradiction_log_odds: contradiction,
            ..FreeSpaceConfig::default()
        };
        let nothing: [Place; 0] = [];
        let mut free = FreeSpace::from_rays(scan.rays.iter().copied(), &nothing, &config)?;
        let mut solid = scan.points.clone();
        solid.retain(|&point| !free.contradicts(point));
        free.insert([], &solid)?;
        let mut rng = Pcg64::seed_from_u64(seed);
        let mut hulls = |points: &[Place]| {
            let clusters = (points.len() / POINTS_PER_CLUSTER).max(1);
            ObstacleSet::from_points(points, &ObstacleConfig::with_clusters(clusters), &mut rng)
        };
        Ok(Belief {
            paper: hulls(&scan.points)?,
            hulls: hulls(&solid)?,
            free,
        })
    }
}

/// Pairs of places that the scan saw and that are `berth` from everything in truth.
///
/// A place was seen when true lines of sight of two keyframes pass through every cube of 0.1 m that the ball touches.
pub(crate) fn queries(
    scan: &Scan,
    berth: f64,
    count: usize,
    rng: &mut Pcg64,
) -> Result<Vec<[Place; 2]>, Box<dyn Error>> {
    let lines_alone = FreeSpaceConfig {
        resolution: 0.1,
        range_margin: 0.0,
        patch_half_angle: 0.0,
        max_triangle_angle: 0.0,
        hit_log_odds: 0.0,
        // All of these points are where they are said to be.
        max_blocked_share: 1.0,
        clearance: 0.0,
        ..FreeSpaceConfig::default()
    };
    let nothing: [Place; 0] = [];
    let lines: Vec<Ray> = scan.sight_lines.clone();
    let seen = FreeSpace::from_rays(lines, &nothing, &lines_alone)?;
    let (low, high) = scan.world.bounds();
    let mut places = Vec::new();
    for _ in 0..1_000_000 {
        let place = core::array::from_fn(|i| low[i] + (high[i] - low[i]) * rng.random::<f64>());
        if seen.ball_is_free(place, RADIUS) && scan.world.segment_is_free(place, place, berth) {
            places.push(place);
        }
        if places.len() == 2 * count {
            return Ok(places
                .chunks_exact(2)
                .map(|pair| [pair[0], pair[1]])
                .collect());
        }
    }
    Err("the scan saw too little".into())
}

/// Solves the queries among the paper's hulls and, with the widest berth there is, in proven free space.
pub(crate) fn run(
    scan: &Scan,
    belief: &Belief,
    queries: &[[Place; 2]],
) -> Result<[Tally; 2], Box<dyn Error>> {
    let (low, high) = scan.world.bounds();
    let bounds = Bounds::new(low, high)?;
    let (mut among_hulls, mut proven) = (Tally::default(), Tally::default());
    for &query in queries {
        let truth = |a: &Place, b: &Place| scan.world.segment_is_free(*a, *b, RADIUS);
        if plan(query, &bounds, &truth).is_none() {
            continue;
        }
        let paper = Space::Hulls(&belief.paper);
        let free = |a: &Place, b: &Place| paper.motion_is_free(*a, *b, RADIUS);
        among_hulls.judge(scan, plan(query, &bounds, &free));

        let (mut hulls, mut space) = (belief.hulls.clone(), belief.free.clone());
        hulls.clear_ball(query[0], RADIUS)?;
        space.add_ball(query[0], RADIUS)?;
        let space = Space::ProvenFree {
            hulls: &hulls,
            free: &space,
        };
        proven.judge(scan, plan_widest(query, &bounds, &space));
    }
    Ok([among_hulls, proven])
}

/// The path with the widest berth that there is.
fn plan_widest(query: [Place; 2], bounds: &Bounds<3>, space: &Space<'_>) -> Option<Path<3>> {
    Berth::widest_first(RADIUS, query).find_map(|berth| {
        let free = |a: &Place, b: &Place| berth.allows(space, *a, *b);
        plan(query, bounds, &free)
    })
}

fn plan(
    [from, to]: [Place; 2],
    bounds: &Bounds<3>,
    free: &impl Fn(&Place, &Place) -> bool,
) -> Option<Path<3>> {
    let config = RrtConfig {
        max_iterations: BUDGET,
        max_nodes: BUDGET,
        ..RrtConfig::default()
    };
    let mut rng = Pcg64::new(1, 1);
    let query = Query::new(from, to, *bounds);
    let path = rrt_connect(&query, free, &config, &mut rng).ok()?.path?;
    taut(&path, free, &TautConfig::default())
        .ok()
        .map(|refined| refined.path)
}
