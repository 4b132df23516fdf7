//! The whole way from a question to a short path: RRT-Connect a few times, each path pulled taut, the shortest kept.
//!
//! Input: a query and a motion check. Output: the refined path, the raw one and what was spent.
//! Method: 1. RRT-Connect; 2. [`taut`](crate::refine::taut()): the shortest path over its vertices (the paper's refinement), corners cut,
//! again; 3. another attempt with other samples, since a planner that stops at its first path may take the longer way
//! round an obstacle and no refiner changes sides; 4. the shortest.
//! Cost: `attempts` times a search and a refinement; one check where the straight motion is free.

use rand::Rng;

use crate::motion::MotionValidator;
use crate::path::Path;
use crate::planner::{ConfigError, Plan, PlanError, Query, RrtConfig, Stop, rrt_connect};
use crate::refine::{TautConfig, taut};

/// Parameters of [`find_path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FindPathConfig {
    /// Parameters of each RRT-Connect.
    pub rrt: RrtConfig,
    /// How often to plan; at least 1. Default 6: among the hulls of furnished apartments the shortest of six is 1 % longer than what
    /// RRT* finds in 50 ms on average, that of one 6 %.
    pub attempts: usize,
    /// Parameters of the refiner.
    pub taut: TautConfig,
}

impl Default for FindPathConfig {
    fn default() -> Self {
        Self {
            rrt: RrtConfig::default(),
            attempts: 6,
            taut: TautConfig::default(),
        }
    }
}

impl FindPathConfig {
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), PlanError> {
        self.rrt.validate()?;
        if self.attempts == 0 {
            return Err(ConfigError::Attempts { value: 0 }.into());
        }
        Ok(self.taut.validate()?)
    }
}

/// What [`find_path`] answers.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPath<const D: usize> {
    /// The shortest refined path, or `None` where no attempt found one.
    pub path: Option<Path<D>>,
    /// The plan that it was refined from, with the path as planned; without a path the last plan, which says why.
    pub plan: Plan<D>,
    /// Plans made.
    pub attempts: usize,
    /// Motions checked, planning and refining of all attempts together.
    pub checks: usize,
}

/// Finds a short free path with RRT-Connect and [`taut`](crate::refine::taut()). What to call unless you know better.
///
/// Ends early where the straight motion is free, and where an attempt spends its budget without a path.
///
/// ```
/// use rand_pcg::Pcg64;
/// use rrt_refine::{Bounds, FindPathConfig, Query, find_path};
///
/// let query = Query::new([1.0, 1.0], [9.0, 1.0], Bounds::new([0.0, 0.0], [10.0, 10.0])?);
/// // A wall along x = 5 with a gap above y = 8.
/// let is_free = |a: &[f64; 2], b: &[f64; 2]| {
///     let crossing = (5.0 - a[0]) / (b[0] - a[0]);
///     !(0.0..=1.0).contains(&crossing) || a[1] + crossing * (b[1] - a[1]) > 8.0
/// };
/// let found = find_path(&query, &is_free, &FindPathConfig::default(), &mut Pcg64::new(1, 1))?;
/// let shortest = 2.0 * (4.0_f64 * 4.0 + 7.0 * 7.0).sqrt();
/// assert!(found.path.ok_or("no path")?.length() < 1.01 * shortest);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range; a start or goal that is not finite, outside the bounds or (the start, or all goals) not free.
pub fn find_path<const D: usize>(
    query: &Query<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &FindPathConfig,
    rng: &mut impl Rng,
) -> Result<FoundPath<D>, PlanError> {
    config.validate()?;
    let mut best = attempt(query, motion_is_free, config, rng)?;
    let mut last_stop = best.plan.stop;
    let mut attempts = 1;
    let mut checks = best.checks;
    while attempts < config.attempts && last_stop == Stop::Reached {
        let next = attempt(query, motion_is_free, config, rng)?;
        last_stop = next.plan.stop;
        attempts += 1;
        checks += next.checks;
        if length(&next) < length(&best) {
            best = next;
        }
    }
    Ok(FoundPath {
        attempts,
        checks,
        ..best
    })
}

/// One plan, refined.
fn attempt<const D: usize>(
    query: &Query<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &FindPathConfig,
    rng: &mut impl Rng,
) -> Result<FoundPath<D>, PlanError> {
    let plan = rrt_connect(query, motion_is_free, &config.rrt, rng)?;
    let mut checks = plan.checks;
    let path = match &plan.path {
        Some(raw) => {
            let refined = taut(raw, motion_is_free, &config.taut)?;
            checks += refined.checks;
            Some(refined.path)
        }
        None => None,
    };
    Ok(FoundPath {
        path,
        plan,
        attempts: 1,
        checks,
    })
}

fn length<const D: usize>(found: &FoundPath<D>) -> f64 {
    found.path.as_ref().map_or(f64::INFINITY, Path::length)
}
