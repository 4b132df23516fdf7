//! A planning question that was found to make sense, and the count of the checks spent on it.

use rand::{Rng, RngExt};

use super::{PlanError, Progress, RrtConfig, Stop};
use crate::bounds::Bounds;
use crate::euclid::{PointLike, distance, first_non_finite};
use crate::goals::Goals;
use crate::motion::MotionValidator;

pub(crate) struct Query<'a, const D: usize, M> {
    pub(crate) start: [f64; D],
    /// The free goals.
    pub(crate) goals: Vec<[f64; D]>,
    /// Where each of them stands in the caller's list.
    pub(crate) goal_index: Vec<usize>,
    pub(crate) bounds: Bounds<D>,
    pub(crate) config: RrtConfig,
    pub(crate) iterations: usize,
    pub(crate) checks: usize,
    motion: &'a M,
}

impl<'a, const D: usize, M: MotionValidator<D>> Query<'a, D, M> {
    pub(crate) fn new(
        start: impl PointLike<D>,
        goals: &Goals<D>,
        bounds: &Bounds<D>,
        motion: &'a M,
        config: &RrtConfig,
    ) -> Result<Self, PlanError> {
        config.validate()?;
        let start = start.into();
        check_start(&start, bounds)?;
        check_goals(goals.points(), bounds)?;
        let mut query = Self {
            start,
            goals: Vec::new(),
            goal_index: Vec::new(),
            bounds: *bounds,
            config: *config,
            iterations: 0,
            checks: 0,
            motion,
        };
        if !query.is_free(&start, &start) {
            return Err(PlanError::StartNotFree);
        }
        for (index, goal) in goals.points().iter().enumerate() {
            if query.is_free(goal, goal) {
                query.goals.push(*goal);
                query.goal_index.push(index);
            }
        }
        if query.goals.is_empty() {
            let goals = goals.points().len();
            return Err(PlanError::NoFreeGoal { goals });
        }
        Ok(query)
    }

    /// Asks the validator and counts it.
    pub(crate) fn is_free(&mut self, from: &[f64; D], to: &[f64; D]) -> bool {
        self.checks += 1;
        self.motion.is_free(from, to)
    }

    /// The nearest goal whose straight motion from the start is free.
    pub(crate) fn straight_goal(&mut self) -> Option<usize> {
        let mut order: Vec<usize> = (0..self.goals.len()).collect();
        order.sort_by(|&a, &b| {
            distance(&self.start, &self.goals[a]).total_cmp(&distance(&self.start, &self.goals[b]))
        });
        let start = self.start;
        order.into_iter().find(|&goal| {
            let goal = self.goals[goal];
            goal == start || self.is_free(&start, &goal)
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

    /// Whether a call that begins now asks for the straight motion first.
    pub(crate) fn begins_straight(&self) -> bool {
        self.iterations == 0 && self.config.max_iterations > 0 && self.config.try_straight
    }

    /// Takes one iteration from those `left`, or says why there is none.
    pub(crate) fn spend(
        &mut self,
        left: &mut usize,
        nodes: usize,
        length: Option<f64>,
        stop: &mut impl FnMut(&Progress) -> bool,
    ) -> Option<Stop> {
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
