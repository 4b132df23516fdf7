//! RRT-Connect: one tree from the start, one from the goals, each reaching for the other's newest node.
//!
//! Method: 1. draw a sample and extend one tree towards it by `step_length` at most; 2. let the other tree walk towards the
//! new node in such steps until it arrives or is blocked; 3. when it arrives the two branches are a path; 4. swap roles.
//! Cost: two nearest-neighbour queries an iteration and one check a step.
//!
//! Reference: J. J. Kuffner, S. M. LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA 2000.

use rand::Rng;

use super::problem::{Problem, Search};
use super::tree::Tree;
use super::{Plan, PlanError, Progress, Query, RrtConfig, Stop};
use crate::euclid::steer;
use crate::motion::MotionValidator;
use crate::path::Path;

/// Plans with RRT-Connect until a goal is connected or the budget of `config` is used up. The planner to start with.
///
/// ```
/// use rand_pcg::Pcg64;
/// use rrt_refine::{Bounds, Query, RrtConfig, Stop, rrt_connect};
///
/// let query = Query::new([1.0; 3], [3.0, 3.0, 1.0], Bounds::new([0.0; 3], [4.0, 4.0, 2.0])?);
/// let open = |_: &[f64; 3], _: &[f64; 3]| true;
/// let plan = rrt_connect(&query, &open, &RrtConfig::default(), &mut Pcg64::new(1, 1))?;
/// assert_eq!(plan.stop, Stop::Straight);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range; a start or goal that is not finite, outside the bounds or (the start, or all goals) not free.
pub fn rrt_connect<const D: usize>(
    query: &Query<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &RrtConfig,
    rng: &mut impl Rng,
) -> Result<Plan<D>, PlanError> {
    Ok(RrtConnect::new(query, motion_is_free, config)?.advance(rng, |_| false))
}

/// An RRT-Connect search that can be stopped by a closure and taken up again.
pub struct RrtConnect<'a, const D: usize, M> {
    problem: Problem<'a, D, M>,
    from_start: Tree<D>,
    from_goals: Tree<D>,
    start_grows: bool,
    /// Meeting node in either tree.
    found: Option<(usize, usize)>,
}

/// Which way a tree is travelled: from its root, or towards it.
#[derive(Clone, Copy)]
enum Travel {
    Away,
    Home,
}

impl<'a, const D: usize, M: MotionValidator<D>> RrtConnect<'a, D, M> {
    /// A search that has not begun; checks the start and the goals.
    ///
    /// # Errors
    /// As [`rrt_connect`].
    pub fn new(
        query: &Query<D>,
        motion_is_free: &'a M,
        config: &RrtConfig,
    ) -> Result<Self, PlanError> {
        let problem = Problem::new(query, motion_is_free, config)?;
        Ok(Self {
            from_start: Tree::with_roots(&[problem.start]),
            from_goals: Tree::with_roots(&problem.goals),
            start_grows: true,
            found: problem.goal_at_start().map(|goal| (0, goal)),
            problem,
        })
    }

    /// Grows the trees until they meet, `stop` returns true, or `max_iterations` more samples are drawn.
    ///
    /// `stop` is asked before each sample; read a clock in it for a budget of time.
    pub fn advance(&mut self, rng: &mut impl Rng, stop: impl FnMut(&Progress) -> bool) -> Plan<D> {
        self.run(rng, stop)
    }
}

impl<'a, const D: usize, M: MotionValidator<D>> Search<'a, D, M> for RrtConnect<'a, D, M> {
    fn problem(&mut self) -> &mut Problem<'a, D, M> {
        &mut self.problem
    }

    fn nodes(&self) -> usize {
        self.from_start.len() + self.from_goals.len()
    }

    fn go_straight(&mut self, goal: usize) {
        let node = self.from_start.push(self.problem.goals[goal], 0);
        // The goals are the roots, in their order.
        self.found = Some((node, goal));
        self.problem.settled = Some(Stop::Straight);
    }

    /// One tree steps towards a sample, the other walks to where it came; the next time the other way round.
    fn grow(&mut self, rng: &mut impl Rng) {
        let problem = &mut self.problem;
        let (start_grows, other_way) = (self.start_grows, !self.start_grows);
        self.start_grows = other_way;
        let (stepping, walking, travel) = if start_grows {
            (&mut self.from_start, &mut self.from_goals, Travel::Away)
        } else {
            (&mut self.from_goals, &mut self.from_start, Travel::Home)
        };
        let sample = if start_grows {
            problem.sample(&problem.goals, rng)
        } else {
            problem.sample(&[problem.start], rng)
        };
        let nearest = stepping.nearest(&sample);
        let Some(node) = step(problem, stepping, nearest, &sample, travel) else {
            return;
        };
        let target = *stepping.point(node);
        let room = problem.config.max_nodes.saturating_sub(stepping.len());
        if let Some(other) = walk(problem, walking, &target, travel.back(), room) {
            self.found = Some(if start_grows {
                (node, other)
            } else {
                (other, node)
            });
            problem.settled = Some(Stop::Reached);
        }
    }

    fn found(&self) -> Option<(Path<D>, usize)> {
        let (start_side, goal_side) = self.found?;
        let up = self.from_start.ancestry(start_side);
        let down = self.from_goals.ancestry(goal_side);
        let before = up.iter().rev().map(|&node| *self.from_start.point(node));
        // Both trees hold the meeting point.
        let after = down[1..].iter().map(|&node| *self.from_goals.point(node));
        let path = Path::from_vertices(before.chain(after).collect());
        Some((path, down[down.len() - 1]))
    }
}

impl Travel {
    fn back(self) -> Self {
        match self {
            Travel::Away => Travel::Home,
            Travel::Home => Travel::Away,
        }
    }
}

/// Steps of the tree towards `target` until it has a node there (given back), is blocked, or `room` nodes are used up.
fn walk<const D: usize, M: MotionValidator<D>>(
    problem: &mut Problem<'_, D, M>,
    tree: &mut Tree<D>,
    target: &[f64; D],
    travel: Travel,
    room: usize,
) -> Option<usize> {
    let mut node = tree.nearest(target);
    while tree.point(node) != target {
        if tree.len() >= room {
            return None;
        }
        node = step(problem, tree, node, target, travel)?;
    }
    Some(node)
}

/// One step of the tree from the node `parent` towards `target`; the new node, or `None` where it is blocked or already there.
fn step<const D: usize, M: MotionValidator<D>>(
    problem: &mut Problem<'_, D, M>,
    tree: &mut Tree<D>,
    parent: usize,
    target: &[f64; D],
    travel: Travel,
) -> Option<usize> {
    let from = *tree.point(parent);
    let to = steer(&from, target, problem.config.step_length);
    if to == from {
        return None;
    }
    let free = match travel {
        Travel::Away => problem.is_free(&from, &to),
        Travel::Home => problem.is_free(&to, &from),
    };
    free.then(|| tree.push(to, parent))
}
