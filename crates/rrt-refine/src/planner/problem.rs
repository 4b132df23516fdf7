//! A question that was found to make sense with the count of what is spent on it, and the loop that all searches share.

use rand::{Rng, RngExt};

use super::{Plan, PlanError, Progress, Query, RrtConfig, Stop};
use crate::bounds::Bounds;
use crate::euclid::{distance, first_non_finite};
use crate::motion::MotionValidator;
use crate::path::Path;

pub(crate) struct Problem<'a, const D: usize, M> {
    pub(crate) start: [f64; D],
    /// The free goals.
    pub(crate) goals: Vec<[f64; D]>,
    /// Where each of them stands in the caller's list.
    goal_index: Vec<usize>,
    pub(crate) bounds: Bounds<D>,
    pub(crate) config: RrtConfig,
    iterations: usize,
    checks: usize,
    /// Whether the straight motion was asked for, or is not to be.
    began: bool,
    /// Why there is nothing more to search for.
    pub(crate) settled: Option<Stop>,
    motion: &'a M,
}

impl<'a, const D: usize, M: MotionValidator<D>> Problem<'a, D, M> {
    pub(crate) fn new(
        query: &Query<D>,
        motion: &'a M,
        config: &RrtConfig,
    ) -> Result<Self, PlanError> {
        config.validate()?;
        check_start(&query.start, &query.bounds)?;
        check_goals(&query.goals, &query.bounds)?;
        let mut problem = Self {
            start: query.start,
            goals: Vec::new(),
            goal_index: Vec::new(),
            bounds: query.bounds,
            config: *config,
            iterations: 0,
            checks: 0,
            began: !config.try_straight,
            settled: None,
            motion,
        };
        if !problem.is_free(&query.start, &query.start) {
            return Err(PlanError::StartNotFree);
        }
        for (index, goal) in query.goals.iter().enumerate() {
            if problem.is_free(goal, goal) {
                problem.goals.push(*goal);
                problem.goal_index.push(index);
            }
        }
        if problem.goals.is_empty() {
            let goals = query.goals.len();
            return Err(PlanError::NoFreeGoal { goals });
        }
        problem.settled = problem.goal_at_start().map(|_| Stop::Straight);
        Ok(problem)
    }

    /// Asks the validator and counts it.
    pub(crate) fn is_free(&mut self, from: &[f64; D], to: &[f64; D]) -> bool {
        self.checks += 1;
        self.motion.is_free(from, to)
    }

    /// The first goal that is the start itself.
    pub(crate) fn goal_at_start(&self) -> Option<usize> {
        self.goals.iter().position(|goal| *goal == self.start)
    }

    /// The nearest goal whose straight motion from the start is free; asked once a search, and not without a budget.
    fn straight_goal(&mut self) -> Option<usize> {
        let idle = self.settled.is_some() || self.config.max_iterations == 0;
        if idle || std::mem::replace(&mut self.began, true) {
            return None;
        }
        let mut order: Vec<usize> = (0..self.goals.len()).collect();
        order.sort_by(|&a, &b| {
            distance(&self.start, &self.goals[a]).total_cmp(&distance(&self.start, &self.goals[b]))
        });
        let start = self.start;
        order.into_iter().find(|&goal| {
            let goal = self.goals[goal];
            self.is_free(&start, &goal)
        })
    }

    /// One of `targets` for the share `goal_bias` of the draws, else a point of the bounds.
    pub(crate) fn sample(&self, targets: &[[f64; D]], rng: &mut impl Rng) -> [f64; D] {
        if rng.random::<f64>() < self.config.goal_bias && !targets.is_empty() {
            targets[rng.random_range(0..targets.len())]
        } else {
            self.bounds.sample(rng)
        }
    }

    /// The answer: the path with the index of its goal among the free ones, if there is one.
    fn plan(&self, found: Option<(Path<D>, usize)>, stop: Stop, nodes: usize) -> Plan<D> {
        let (path, goal) = found.unzip();
        Plan {
            path,
            goal: goal.map(|goal| self.goal_index[goal]),
            stop,
            iterations: self.iterations,
            nodes,
            checks: self.checks,
        }
    }

    /// Takes one iteration from those `left`, or says why there is none.
    fn spend(
        &mut self,
        left: &mut usize,
        nodes: usize,
        length: Option<f64>,
        stop: &mut impl FnMut(&Progress) -> bool,
    ) -> Option<Stop> {
        if self.settled.is_some() {
            return self.settled;
        }
        if *left == 0 {
            return Some(Stop::Iterations);
        }
        if nodes >= self.config.max_nodes {
            return Some(Stop::Nodes);
        }
        let progress = Progress {
            iterations: self.iterations,
            nodes,
            checks: self.checks,
            length,
        };
        if stop(&progress) {
            return Some(Stop::Asked);
        }
        *left -= 1;
        self.iterations += 1;
        None
    }
}

/// What the planners do differently, and the loop around it.
pub(crate) trait Search<'a, const D: usize, M: MotionValidator<D> + 'a> {
    fn problem(&mut self) -> &mut Problem<'a, D, M>;
    fn nodes(&self) -> usize;
    /// Length of the best path so far, for planners that go on from there.
    fn best_length(&self) -> Option<f64> {
        None
    }
    /// Takes the straight motion to the goal, which is free, and settles the search if nothing can be better.
    fn go_straight(&mut self, goal: usize);
    /// One sample.
    fn grow(&mut self, rng: &mut impl Rng);
    /// The path so far, and which of the free goals it ends at.
    fn found(&self) -> Option<(Path<D>, usize)>;

    /// Grows until there is nothing more to search for, `stop` returns true, or a budget is used up.
    fn run(&mut self, rng: &mut impl Rng, mut stop: impl FnMut(&Progress) -> bool) -> Plan<D> {
        if let Some(goal) = self.problem().straight_goal() {
            self.go_straight(goal);
        }
        let mut left = self.problem().config.max_iterations;
        let reason = loop {
            let (nodes, length) = (self.nodes(), self.best_length());
            let spent = self.problem().spend(&mut left, nodes, length, &mut stop);
            if let Some(reason) = spent {
                break reason;
            }
            self.grow(rng);
        };
        let (found, nodes) = (self.found(), self.nodes());
        self.problem().plan(found, reason, nodes)
    }
}

fn check_start<const D: usize>(start: &[f64; D], bounds: &Bounds<D>) -> Result<(), PlanError> {
    if let Some(axis) = first_non_finite(start) {
        let value = start[axis];
        return Err(PlanError::StartNotFinite { axis, value });
    }
    match outside(start, bounds) {
        Some((axis, value, min, max)) => Err(PlanError::StartOutside {
            axis,
            value,
            min,
            max,
        }),
        None => Ok(()),
    }
}

fn check_goals<const D: usize>(goals: &[[f64; D]], bounds: &Bounds<D>) -> Result<(), PlanError> {
    if goals.is_empty() {
        return Err(PlanError::NoGoal);
    }
    for (index, goal) in goals.iter().enumerate() {
        if let Some(axis) = first_non_finite(goal) {
            let value = goal[axis];
            return Err(PlanError::GoalNotFinite { index, axis, value });
        }
        if let Some((axis, value, min, max)) = outside(goal, bounds) {
            return Err(PlanError::GoalOutside {
                index,
                axis,
                value,
                min,
                max,
            });
        }
    }
    Ok(())
}

/// The first axis on which the point leaves the bounds, its value there, and the two ends.
fn outside<const D: usize>(point: &[f64; D], bounds: &Bounds<D>) -> Option<(usize, f64, f64, f64)> {
    let (min, max) = (bounds.min(), bounds.max());
    (0..D)
        .find(|&axis| point[axis] < min[axis] || point[axis] > max[axis])
        .map(|axis| (axis, point[axis], min[axis], max[axis]))
}
