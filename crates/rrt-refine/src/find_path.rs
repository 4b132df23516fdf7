//! The whole way from a question to a short path: RRT-Connect pulled taut, then searches for anything shorter.
//!
//! Input: a query and a motion check. Output: the refined path, the plan it came from and what was spent.
//! Method: 1. RRT-Connect; 2. one round of [`taut`](crate::refine::taut()): the shortest path over its vertices (the paper's refinement) and
//! corners cut; 3. a planner that stops at its first path may take the longer way round an obstacle, and no refiner changes sides. So plan
//! again for a path of length c at most: all its points lie in the ellipsoid { x : |x − start| + |x − goal| ≤ c }, so no motion may leave
//! it and samples come from the box around it. c lies far below the length at first, near the straight line's: in little space a
//! much shorter way is found by few samples, if there is one; 4. when that finds nothing, ask for `min_gain` alone, with half the samples, until a search finds nothing, or
//! `attempts` are made. A search takes as many samples as there is to gain: a number in proportion to the square of what the path is
//! longer than the straight line; 5. all are pulled taut, and the shortest is
//! the answer.
//! Cost: a search and a round of refinement an attempt, the later ones in less and less space; one check where the straight motion is free.
//!
//! References: Kuffner, LaValle 2000 (RRT-Connect); the ellipsoid is that of Gammell, Srinivasa, Barfoot, "Informed RRT*", IROS 2014.

use rand::Rng;

use crate::bounds::Bounds;
use crate::euclid::distance;
use crate::motion::MotionValidator;
use crate::path::Path;
use crate::planner::{ConfigError, Plan, PlanError, Query, RrtConfig, rrt_connect};
use crate::refine::{TautConfig, taut};

/// Parameters of [`find_path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FindPathConfig {
    /// Parameters of the planner.
    pub rrt: RrtConfig,
    /// Parameters of the refiner.
    pub taut: TautConfig,
    /// How often to plan; at least 1. Default 12. With 1 the first path found is refined and returned.
    pub attempts: usize,
    /// Most samples of each search for something shorter where the path is twice as long as the straight line, 0 or more; in proportion
    /// to the square of the excess over that line where it is more or less, and [`RrtConfig::max_iterations`] at most. Default 9,000, which is 90
    /// for a path 10 % longer than the straight line.
    pub further_iterations: usize,
    /// A further path is first to be shorter by this share of the excess over the straight line, then by `min_gain` alone; 0 to below 1. Default 0.7.
    pub first_gain: f64,
    /// A further path must be shorter by this share; 0 to below 1. Default 0.03.
    pub min_gain: f64,
}

impl Default for FindPathConfig {
    fn default() -> Self {
        Self {
            rrt: RrtConfig::default(),
            taut: TautConfig::default(),
            attempts: 12,
            further_iterations: 9_000,
            first_gain: 0.7,
            min_gain: 0.03,
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
        if !(0.0..1.0).contains(&self.min_gain) {
            let value = self.min_gain;
            return Err(ConfigError::MinGain { value }.into());
        }
        if !(0.0..1.0).contains(&self.first_gain) {
            let value = self.first_gain;
            return Err(ConfigError::FirstGain { value }.into());
        }
        Ok(self.taut.validate()?)
    }

    /// Samples of a search for something shorter than a path that is longer than the straight line by this share of it.
    fn samples_for(&self, excess: f64) -> usize {
        // Saturates where the excess is not a number, or too large to count.
        let samples = (self.further_iterations as f64 * excess * excess).ceil() as usize;
        samples.min(self.rrt.max_iterations)
    }
}

/// What [`find_path`] answers.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPath<const D: usize> {
    /// The shortest refined path, or `None` where the first search found none.
    pub path: Option<Path<D>>,
    /// The plan that it was refined from, with the path as planned; without a path the first plan, which says why.
    pub plan: Plan<D>,
    /// Plans made.
    pub attempts: usize,
    /// Motions checked, planning and refining of all attempts together; those that leave the ellipsoid count, though they cost nothing.
    pub checks: usize,
}

/// Finds a short free path with RRT-Connect and [`taut`](crate::refine::taut()). What to call unless you know better.
///
/// With several goals, to whichever the shortest path found leads.
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
    let plan = rrt_connect(query, motion_is_free, &config.rrt, rng)?;
    // Which of the paths is the shortest shows after one round.
    let once = TautConfig {
        max_rounds: config.taut.max_rounds.min(1),
        ..config.taut
    };
    let mut best = refined(plan, motion_is_free, &once)?;
    let mut earlier = Vec::new();
    let mut first_gain = config.first_gain;
    while let Some(path) = &best.path
        && best.attempts < config.attempts
    {
        let gain = first_gain * (1.0 - straight(query) / path.length());
        let asks_for_much = gain > config.min_gain;
        let longest = path.length() * (1.0 - gain.max(config.min_gain));
        let Some(within) = Shorter::new(query, longest) else {
            break;
        };
        let samples = config.samples_for(path.length() / straight(query) - 1.0);
        let free = |from: &[f64; D], to: &[f64; D]| {
            within.holds(from) && within.holds(to) && motion_is_free.is_free(from, to)
        };
        let further = RrtConfig {
            max_iterations: if asks_for_much {
                samples
            } else {
                samples.div_ceil(2)
            },
            try_straight: false,
            ..config.rrt
        };
        let plan = rrt_connect(&within.query, &free, &further, rng)?;
        let next = refined(plan, motion_is_free, &once)?;
        best.attempts += 1;
        best.checks += next.checks;
        match next.path {
            Some(shorter) if shorter.length() < path.length() * (1.0 - config.min_gain) => {
                let plan = Plan {
                    goal: next.plan.goal.map(|goal| within.goal_index[goal]),
                    ..next.plan
                };
                let last = best.path.replace(shorter);
                earlier.extend(last.zip(Some(std::mem::replace(&mut best.plan, plan))));
            }
            Some(_) => {}
            None if asks_for_much => first_gain = 0.0,
            None => break,
        }
    }
    pulled_taut(best, earlier, motion_is_free, &config.taut)
}

/// The shortest once all are pulled taut. An earlier one may gain more by it than a later one, and more attempts shall never end longer.
fn pulled_taut<const D: usize>(
    mut best: FoundPath<D>,
    earlier: Vec<(Path<D>, Plan<D>)>,
    motion_is_free: &impl MotionValidator<D>,
    config: &TautConfig,
) -> Result<FoundPath<D>, PlanError> {
    let last = best.path.take().map(|path| (path, best.plan.clone()));
    for (path, plan) in last.into_iter().chain(earlier.into_iter().rev()) {
        let pulled = taut(&path, motion_is_free, config)?;
        best.checks += pulled.checks;
        let shorter = |known: &Path<D>| pulled.path.length() < known.length();
        if best.path.as_ref().is_none_or(shorter) {
            best.path = Some(pulled.path);
            best.plan = plan;
        }
    }
    Ok(best)
}

/// The straight line to the nearest goal.
fn straight<const D: usize>(query: &Query<D>) -> f64 {
    let lengths = query.goals.iter().map(|goal| distance(&query.start, goal));
    lengths.fold(f64::INFINITY, f64::min)
}

/// A plan and its path pulled taut.
fn refined<const D: usize>(
    plan: Plan<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &TautConfig,
) -> Result<FoundPath<D>, PlanError> {
    let mut checks = plan.checks;
    let mut path = None;
    if let Some(raw) = &plan.path {
        let refined = taut(raw, motion_is_free, config)?;
        checks += refined.checks;
        path = Some(refined.path);
    }
    Ok(FoundPath {
        path,
        plan,
        attempts: 1,
        checks,
    })
}

/// Where every path of at most a given length lies.
struct Shorter<const D: usize> {
    /// The question with the goals that are near enough and a box around all such paths.
    query: Query<D>,
    /// Where these goals stand in the caller's list.
    goal_index: Vec<usize>,
    length: f64,
}

impl<const D: usize> Shorter<D> {
    /// `None` where no path can be that short.
    fn new(query: &Query<D>, length: f64) -> Option<Self> {
        let start = &query.start;
        let near = |goal: &[f64; D]| distance(start, goal) < length;
        let goal_index: Vec<usize> = (0..query.goals.len())
            .filter(|&goal| near(&query.goals[goal]))
            .collect();
        let goals: Vec<[f64; D]> = goal_index.iter().map(|&goal| query.goals[goal]).collect();
        // Both ends are in the box, whatever rounding does.
        let (mut low, mut high) = (*start, *start);
        for goal in &goals {
            for axis in 0..D {
                let (middle, half) = extent(start, goal, length, axis);
                let (min, max) = (query.bounds.min()[axis], query.bounds.max()[axis]);
                low[axis] = low[axis].min(goal[axis]).min((middle - half).max(min));
                high[axis] = high[axis].max(goal[axis]).max((middle + half).min(max));
            }
        }
        let bounds = Bounds::new(low, high).ok()?;
        (!goals.is_empty()).then_some(Self {
            query: Query {
                start: *start,
                goals,
                bounds,
            },
            goal_index,
            length,
        })
    }

    /// Whether a path through the point can be that short.
    fn holds(&self, point: &[f64; D]) -> bool {
        let to_start = distance(&self.query.start, point);
        let mut goals = self.query.goals.iter();
        goals.any(|goal| to_start + distance(point, goal) <= self.length)
    }
}

/// Middle and half width, along an axis, of the ellipsoid with these foci and this path length.
fn extent<const D: usize>(
    start: &[f64; D],
    goal: &[f64; D],
    length: f64,
    axis: usize,
) -> (f64, f64) {
    let gap = distance(start, goal);
    let along = length / 2.0;
    let across_squared = (along * along - gap * gap / 4.0).max(0.0);
    let direction = if gap > 0.0 {
        (goal[axis] - start[axis]) / gap
    } else {
        0.0
    };
    let half = (across_squared + gap * gap / 4.0 * direction * direction).sqrt();
    (start[axis] / 2.0 + goal[axis] / 2.0, half)
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn a_search_takes_as_many_samples_as_there_is_to_gain() {
        let config = FindPathConfig::default();
        let samples = [0.05, 0.1, 1.0].map(|excess| config.samples_for(excess));
        assert_eq!(samples, [23, 90, 9_000]);
        // A start next to its goal, or on it.
        assert_eq!(config.samples_for(f64::INFINITY), 10_000);
        assert_eq!(config.samples_for(f64::NAN), 0);
    }

    #[test]
    fn the_box_holds_every_point_of_a_short_path_and_little_more() -> Result<(), crate::BoundsError>
    {
        let bounds = Bounds::new([-20.0; 3], [20.0; 3])?;
        let goals = [[1.0, 2.0, 0.5], [9.0, 0.0, 0.0], [-2.0, 0.5, 1.5]];
        let query = Query::to_any_of([-1.0, 0.5, 2.0], &goals, bounds);
        let shorter = Shorter::new(&query, 4.0).ok_or(crate::BoundsError::Empty)?;
        assert_eq!(shorter.goal_index, [0, 2]);
        let inner = shorter.query.bounds;
        let mut rng = Pcg64::new(1, 1);
        let (mut low, mut high) = (query.start, query.start);
        for _ in 0..400_000 {
            let point = Bounds::new([-6.0; 3], [6.0; 3])?.sample(&mut rng);
            if shorter.holds(&point) {
                assert!(inner.contains(&point), "{point:?}");
                for axis in 0..3 {
                    low[axis] = low[axis].min(point[axis]);
                    high[axis] = high[axis].max(point[axis]);
                }
            }
        }
        for axis in 0..3 {
            assert!(low[axis] - inner.min()[axis] < 0.2 && inner.max()[axis] - high[axis] < 0.2);
        }
        assert!(Shorter::new(&query, 1.0).is_none());
        Ok(())
    }
}
