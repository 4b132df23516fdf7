//! RRT: one tree grown from the start towards random samples.
//!
//! Method: 1. draw a sample (a goal for the share `goal_bias`); 2. find the nearest node; 3. go from it towards the sample by
//! `step_length` at most; 4. keep the new node when the motion is free; 5. when a goal is within a step, try to end there.
//! Cost: one nearest-neighbour query and one check an iteration, and one more check where a goal is near.
//!
//! Reference: S. M. LaValle, "Rapidly-exploring random trees: a new tool for path planning", TR 98-11, 1998.

use rand::Rng;

use super::query::Query;
use super::tree::Tree;
use super::{Plan, PlanError, Progress, RrtConfig, Stop};
use crate::bounds::Bounds;
use crate::euclid::{PointLike, distance, steer};
use crate::goals::Goals;
use crate::motion::MotionValidator;
use crate::path::Path;

/// Plans with RRT until a goal is reached or the budget of `config` is used up.
///
/// ```
/// use rand_pcg::Pcg64;
/// use rrt_refine::{Bounds, RrtConfig, rrt};
///
/// let bounds = Bounds::new([0.0, 0.0], [10.0, 10.0])?;
/// // A wall along x = 5 with a gap above y = 8.
/// let is_free = |a: &[f64; 2], b: &[f64; 2]| {
///     let crossing = (5.0 - a[0]) / (b[0] - a[0]);
///     !(0.0..=1.0).contains(&crossing) || a[1] + crossing * (b[1] - a[1]) > 8.0
/// };
/// let plan = rrt([1.0, 1.0], [9.0, 1.0], &bounds, &is_free, &RrtConfig::default(), &mut Pcg64::new(1, 1))?;
/// assert!(plan.path.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range; a start or goal that is not finite, outside the bounds or (the start, or all goals) not free.
pub fn rrt<const D: usize>(
    start: impl PointLike<D>,
    goals: impl Into<Goals<D>>,
    bounds: &Bounds<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &RrtConfig,
    rng: &mut impl Rng,
) -> Result<Plan<D>, PlanError> {
    let mut search = Rrt::new(start, goals, bounds, motion_is_free, config)?;
    Ok(search.advance(rng, |_| false))
}

/// An RRT search that can be stopped by a closure and taken up again.
pub struct Rrt<'a, const D: usize, M> {
    query: Query<'a, D, M>,
    tree: Tree<D>,
    /// Node at a goal, that goal, and how it was reached.
    found: Option<(usize, usize, Stop)>,
}

impl<'a, const D: usize, M: MotionValidator<D>> Rrt<'a, D, M> {
    /// A search that has not begun; checks the start and the goals.
    ///
    /// # Errors
    /// As [`rrt`].
    pub fn new(
        start: impl PointLike<D>,
        goals: impl Into<Goals<D>>,
        bounds: &Bounds<D>,
        motion_is_free: &'a M,
        config: &RrtConfig,
    ) -> Result<Self, PlanError> {
        let query = Query::new(start, &goals.into(), bounds, motion_is_free, config)?;
        let tree = Tree::with_roots(&[query.start]);
        let found = query
            .goals
            .iter()
            .position(|goal| *goal == query.start)
            .map(|goal| (0, goal, Stop::Straight));
        Ok(Self { query, tree, found })
    }

    /// Grows the tree until a goal is reached, `stop` returns true, or `max_iterations` more samples are drawn.
    ///
    /// `stop` is asked before each sample; read a clock in it for a budget of time.
    pub fn advance(
        &mut self,
        rng: &mut impl Rng,
        mut stop: impl FnMut(&Progress) -> bool,
    ) -> Plan<D> {
        if self.query.begins_straight() {
            self.try_straight();
        }
        let mut left = self.query.config.max_iterations;
        let reason = loop {
            if let Some((_, _, how)) = self.found {
                break how;
            }
            let nodes = self.tree.len();
            if let Some(reason) = self.query.spend(&mut left, nodes, None, &mut stop) {
                break reason;
            }
            self.grow(rng);
        };
        self.plan(reason)
    }

    fn try_straight(&mut self) {
        if self.found.is_some() {
            return;
        }
        if let Some(goal) = self.query.straight_goal() {
            let node = self.tree.push(self.query.goals[goal], 0);
            self.found = Some((node, goal, Stop::Straight));
        }
    }

    /// One sample.
    fn grow(&mut self, rng: &mut impl Rng) {
        let sample = self.query.sample(&self.query.goals, rng);
        let parent = self.tree.nearest(&sample);
        let from = *self.tree.point(parent);
        let to = steer(&from, &sample, self.query.config.step_length);
        if to == from || !self.query.is_free(&from, &to) {
            return;
        }
        let node = self.tree.push(to, parent);
        for goal in 0..self.query.goals.len() {
            let end = self.query.goals[goal];
            if end == to {
                self.found = Some((node, goal, Stop::Reached));
                return;
            }
            if distance(&to, &end) <= self.query.config.step_length && self.query.is_free(&to, &end)
            {
                let node = self.tree.push(end, node);
                self.found = Some((node, goal, Stop::Reached));
                return;
            }
        }
    }

    fn plan(&self, stop: Stop) -> Plan<D> {
        let path = self.found.map(|(node, _, _)| {
            let chain = self.tree.ancestry(node);
            Path::from_vertices(chain.iter().rev().map(|&n| *self.tree.point(n)).collect())
        });
        Plan {
            path,
            goal: self.found.map(|(_, goal, _)| self.query.goal_index[goal]),
            stop,
            iterations: self.query.iterations,
            nodes: self.tree.len(),
            checks: self.query.checks,
        }
    }
}
