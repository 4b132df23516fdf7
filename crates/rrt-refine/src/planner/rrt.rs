//! RRT: one tree grown from the start towards random samples.
//!
//! Method: 1. draw a sample (a goal for the share `goal_bias`); 2. find the nearest node; 3. go from it towards the sample by
//! `step_length` at most; 4. keep the new node when the motion is free; 5. when a goal is within a step, try to end there.
//! Cost: one nearest-neighbour query and one check an iteration, and one more check where a goal is near.
//!
//! Reference: S. M. LaValle, "Rapidly-exploring random trees: a new tool for path planning", TR 98-11, 1998.

use rand::Rng;

use super::problem::{Problem, Search};
use super::tree::Tree;
use super::{Plan, PlanError, Progress, Query, RrtConfig, Stop};
use crate::euclid::{distance, steer};
use crate::motion::MotionValidator;
use crate::path::Path;

/// Plans with RRT until a goal is reached or the budget of `config` is used up.
///
/// ```
/// use rand_pcg::Pcg64;
/// use rrt_refine::{Bounds, Query, RrtConfig, rrt};
///
/// let query = Query::new([1.0, 1.0], [9.0, 1.0], Bounds::new([0.0, 0.0], [10.0, 10.0])?);
/// // A wall along x = 5 with a gap above y = 8.
/// let is_free = |a: &[f64; 2], b: &[f64; 2]| {
///     let crossing = (5.0 - a[0]) / (b[0] - a[0]);
///     !(0.0..=1.0).contains(&crossing) || a[1] + crossing * (b[1] - a[1]) > 8.0
/// };
/// let plan = rrt(&query, &is_free, &RrtConfig::default(), &mut Pcg64::new(1, 1))?;
/// assert!(plan.path.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range; a start or goal that is not finite, outside the bounds or (the start, or all goals) not free.
pub fn rrt<const D: usize>(
    query: &Query<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &RrtConfig,
    rng: &mut impl Rng,
) -> Result<Plan<D>, PlanError> {
    Ok(Rrt::new(query, motion_is_free, config)?.advance(rng, |_| false))
}

/// An RRT search that can be stopped by a closure and taken up again.
pub struct Rrt<'a, const D: usize, M> {
    problem: Problem<'a, D, M>,
    tree: Tree<D>,
    /// Node at a goal, and that goal.
    found: Option<(usize, usize)>,
}

impl<'a, const D: usize, M: MotionValidator<D>> Rrt<'a, D, M> {
    /// A search that has not begun; checks the start and the goals.
    ///
    /// # Errors
    /// As [`rrt`].
    pub fn new(
        query: &Query<D>,
        motion_is_free: &'a M,
        config: &RrtConfig,
    ) -> Result<Self, PlanError> {
        let problem = Problem::new(query, motion_is_free, config)?;
        Ok(Self {
            tree: Tree::with_roots(&[problem.start]),
            found: problem.goal_at_start().map(|goal| (0, goal)),
            problem,
        })
    }

    /// Grows the tree until a goal is reached, `stop` returns true, or `max_iterations` more samples are drawn.
    ///
    /// `stop` is asked before each sample; read a clock in it for a budget of time.
    pub fn advance(&mut self, rng: &mut impl Rng, stop: impl FnMut(&Progress) -> bool) -> Plan<D> {
        self.run(rng, stop)
    }

    /// The branch that ends at `node` goes on to the goal, unless it is there already.
    fn end_at(&mut self, goal: usize, mut node: usize, how: Stop) {
        let end = self.problem.goals[goal];
        if *self.tree.point(node) != end {
            node = self.tree.push(end, node);
        }
        self.found = Some((node, goal));
        self.problem.settled = Some(how);
    }
}

impl<'a, const D: usize, M: MotionValidator<D>> Search<'a, D, M> for Rrt<'a, D, M> {
    fn problem(&mut self) -> &mut Problem<'a, D, M> {
        &mut self.problem
    }

    fn nodes(&self) -> usize {
        self.tree.len()
    }

    fn go_straight(&mut self, goal: usize) {
        self.end_at(goal, 0, Stop::Straight);
    }

    fn grow(&mut self, rng: &mut impl Rng) {
        let step = self.problem.config.step_length;
        let sample = self.problem.sample(&self.problem.goals, rng);
        let parent = self.tree.nearest(&sample);
        let from = *self.tree.point(parent);
        let to = steer(&from, &sample, step);
        if to == from || !self.problem.is_free(&from, &to) {
            return;
        }
        let node = self.tree.push(to, parent);
        for goal in 0..self.problem.goals.len() {
            let end = self.problem.goals[goal];
            let near = distance(&to, &end) <= step;
            if end == to || near && self.problem.is_free(&to, &end) {
                return self.end_at(goal, node, Stop::Reached);
            }
        }
    }

    fn found(&self) -> Option<(Path<D>, usize)> {
        let (node, goal) = self.found?;
        let chain = self.tree.ancestry(node);
        let points = chain.iter().rev().map(|&n| *self.tree.point(n)).collect();
        Some((Path::from_vertices(points), goal))
    }
}
