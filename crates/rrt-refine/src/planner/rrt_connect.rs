//! RRT-Connect: one tree from the start, one from the goals, each reaching for the other's newest node.
//!
//! Method: 1. draw a sample and extend one tree towards it by `step_length` at most; 2. let the other tree walk towards the
//! new node in such steps until it arrives or is blocked; 3. when it arrives the two branches are a path; 4. swap roles.
//! Cost: two nearest-neighbour queries an iteration and one check a step.
//!
//! Reference: J. J. Kuffner, S. M. LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA 2000.

use rand::Rng;

use super::query::Query;
use super::tree::Tree;
use super::{Plan, PlanError, Progress, RrtConfig, Stop};
use crate::bounds::Bounds;
use crate::euclid::{PointLike, steer};
use crate::goals::Goals;
use crate::motion::MotionValidator;
use crate::path::Path;

/// Plans with RRT-Connect until a goal is connected or the budget of `config` is used up. The planner to start with.
///
/// ```
/// use rand_pcg::Pcg64;
/// use rrt_refine::{Bounds, RrtConfig, Stop, rrt_connect};
///
/// let bounds = Bounds::new([0.0; 3], [4.0, 4.0, 2.0])?;
/// let open = |_: &[f64; 3], _: &[f64; 3]| true;
/// let plan = rrt_connect([1.0; 3], [3.0, 3.0, 1.0], &bounds, &open, &RrtConfig::default(), &mut Pcg64::new(1, 1))?;
/// assert_eq!(plan.stop, Stop::Straight);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range; a start or goal that is not finite, outside the bounds or (the start, or all goals) not free.
pub fn rrt_connect<const D: usize>(
    start: impl PointLike<D>,
    goals: impl Into<Goals<D>>,
    bounds: &Bounds<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &RrtConfig,
    rng: &mut impl Rng,
) -> Result<Plan<D>, PlanError> {
    let mut search = RrtConnect::new(start, goals, bounds, motion_is_free, config)?;
    Ok(search.advance(rng, |_| false))
}

/// An RRT-Connect search that can be stopped by a closure and taken up again.
pub struct RrtConnect<'a, const D: usize, M> {
    query: Query<'a, D, M>,
    from_start: Tree<D>,
    from_goals: Tree<D>,
    start_grows: bool,
    /// Meeting node in either tree, and how it was reached.
    found: Option<(usize, usize, Stop)>,
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
        start: impl PointLike<D>,
        goals: impl Into<Goals<D>>,
        bounds: &Bounds<D>,
        motion_is_free: &'a M,
        config: &RrtConfig,
    ) -> Result<Self, PlanError> {
        let query = Query::new(start, &goals.into(), bounds, motion_is_free, config)?;
        let from_start = Tree::with_roots(&[query.start]);
        let from_goals = Tree::with_roots(&query.goals);
        let found = query
            .goals
            .iter()
            .position(|goal| *goal == query.start)
            .map(|goal| (0, goal, Stop::Straight));
        Ok(Self {
            query,
            from_start,
            from_goals,
            start_grows: true,
            found,
        })
    }

    /// Grows the trees until they meet, `stop` returns true, or `max_iterations` more samples are drawn.
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
            let nodes = self.nodes();
            if let Some(reason) = self.query.spend(&mut left, nodes, None, &mut stop) {
                break reason;
            }
            self.grow(rng);
            self.start_grows = !self.start_grows;
        };
        self.plan(reason)
    }

    fn nodes(&self) -> usize {
        self.from_start.len() + self.from_goals.len()
    }

    fn try_straight(&mut self) {
        if self.found.is_none()
            && let Some(goal) = self.query.straight_goal()
        {
            let node = self.from_start.push(self.query.goals[goal], 0);
            self.found = Some((node, goal, Stop::Straight));
        }
    }

    /// One sample: extend one tree, let the other connect.
    fn grow(&mut self, rng: &mut impl Rng) {
        let query = &mut self.query;
        let room = query.config.max_nodes;
        if self.start_grows {
            let sample = query.sample(&query.goals, rng);
            let Some(node) = extend(query, &mut self.from_start, &sample, Travel::Away) else {
                return;
            };
            let target = *self.from_start.point(node);
            let room = room.saturating_sub(self.from_start.len());
            if let Some(other) = connect(query, &mut self.from_goals, &target, Travel::Home, room) {
                self.found = Some((node, other, Stop::Reached));
            }
        } else {
            let sample = query.sample(&[query.start], rng);
            let Some(node) = extend(query, &mut self.from_goals, &sample, Travel::Home) else {
                return;
            };
            let target = *self.from_goals.point(node);
            let room = room.saturating_sub(self.from_goals.len());
            if let Some(other) = connect(query, &mut self.from_start, &target, Travel::Away, room) {
                self.found = Some((other, node, Stop::Reached));
            }
        }
    }

    fn plan(&self, stop: Stop) -> Plan<D> {
        let mut goal = None;
        let path = self.found.map(|(near_start, near_goal, _)| {
            let up = self.from_start.ancestry(near_start);
            let down = self.from_goals.ancestry(near_goal);
            goal = down.last().map(|&root| self.query.goal_index[root]);
            let mut points: Vec<[f64; D]> = up
                .iter()
                .rev()
                .map(|&node| *self.from_start.point(node))
                .collect();
            // Both trees hold the meeting point.
            points.extend(down[1..].iter().map(|&node| *self.from_goals.point(node)));
            Path::from_vertices(points)
        });
        Plan {
            path,
            goal,
            stop,
            iterations: self.query.iterations,
            nodes: self.nodes(),
            checks: self.query.checks,
        }
    }
}

/// One step of the tree towards `target`; the new node, or `None` where it is blocked or already there.
fn extend<const D: usize, M: MotionValidator<D>>(
    query: &mut Query<'_, D, M>,
    tree: &mut Tree<D>,
    target: &[f64; D],
    travel: Travel,
) -> Option<usize> {
    let parent = tree.nearest(target);
    step(query, tree, parent, target, travel)
}

/// Steps of the tree towards `target` until it has a node there (given back), is blocked, or `room` nodes are used up.
fn connect<const D: usize, M: MotionValidator<D>>(
    query: &mut Query<'_, D, M>,
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
        node = step(query, tree, node, target, travel)?;
    }
    Some(node)
}

fn step<const D: usize, M: MotionValidator<D>>(
    query: &mut Query<'_, D, M>,
    tree: &mut Tree<D>,
    parent: usize,
    target: &[f64; D],
    travel: Travel,
) -> Option<usize> {
    let from = *tree.point(parent);
    let to = steer(&from, target, query.config.step_length);
    if to == from {
        return None;
    }
    let free = match travel {
        Travel::Away => query.is_free(&from, &to),
        Travel::Home => query.is_free(&to, &from),
    };
    free.then(|| tree.push(to, parent))
}
