//! RRT*: RRT whose nodes take the best parent nearby and become the parent of neighbours that they serve better.
//!
//! Method: as RRT up to the new point; then 1. its k = ⌈factor · e (1 + 1/D) ln n⌉ nearest nodes are tried as parents in the order
//! of the resulting length, the first free one is taken; 2. those neighbours for whom the way through the new node is shorter
//! are hung under it where that motion is free. Informed: once a path is known, samples come from the ellipsoid of points
//! that can shorten it, and nodes that cannot are not kept.
//! Cost: one nearest-k query and O(log n) checks an iteration.
//!
//! References: S. Karaman, E. Frazzoli, "Sampling-based algorithms for optimal motion planning", IJRR 2011 (k-nearest RRT*);
//! J. Gammell, S. Srinivasa, T. Barfoot, "Informed RRT*", IROS 2014.

use rand::{Rng, RngExt};

use super::cost_tree::CostTree;
use super::informed::sample_ellipsoid;
use super::problem::{Problem, Search};
use super::{Plan, PlanError, Progress, Query, RrtStarConfig, Stop};
use crate::euclid::{distance, steer};
use crate::motion::MotionValidator;
use crate::path::Path;

/// Plans with RRT*, or Informed RRT* when `config.informed`, until the budget of `config` is used up.
///
/// Unlike [`rrt`](crate::rrt) it does not stop at the first path but uses its whole budget to shorten it.
///
/// ```
/// use rand_pcg::Pcg64;
/// use rrt_refine::{Bounds, Query, RrtStarConfig, rrt_star};
///
/// let query = Query::new([1.0, 1.0], [9.0, 1.0], Bounds::new([0.0, 0.0], [10.0, 10.0])?);
/// // A wall along x = 5 with a gap above y = 8.
/// let is_free = |a: &[f64; 2], b: &[f64; 2]| {
///     let crossing = (5.0 - a[0]) / (b[0] - a[0]);
///     !(0.0..=1.0).contains(&crossing) || a[1] + crossing * (b[1] - a[1]) > 8.0
/// };
/// let mut config = RrtStarConfig::informed();
/// config.rrt.max_iterations = 2000;
/// let plan = rrt_star(&query, &is_free, &config, &mut Pcg64::new(1, 1))?;
/// let shortest = 2.0 * (4.0_f64 * 4.0 + 7.0 * 7.0).sqrt();
/// assert!(plan.length().is_some_and(|length| length < 1.02 * shortest));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range; a start or goal that is not finite, outside the bounds or (the start, or all goals) not free.
pub fn rrt_star<const D: usize>(
    query: &Query<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &RrtStarConfig,
    rng: &mut impl Rng,
) -> Result<Plan<D>, PlanError> {
    Ok(RrtStar::new(query, motion_is_free, config)?.advance(rng, |_| false))
}

/// An anytime RRT* search: each call of [`advance`](RrtStar::advance) improves the path further.
pub struct RrtStar<'a, const D: usize, M> {
    problem: Problem<'a, D, M>,
    config: RrtStarConfig,
    tree: CostTree<D>,
    /// Node at each goal, once there is one.
    goal_nodes: Vec<Option<usize>>,
}

impl<'a, const D: usize, M: MotionValidator<D>> RrtStar<'a, D, M> {
    /// A search that has not begun; checks the start and the goals.
    ///
    /// # Errors
    /// As [`rrt_star`].
    pub fn new(
        query: &Query<D>,
        motion_is_free: &'a M,
        config: &RrtStarConfig,
    ) -> Result<Self, PlanError> {
        config.validate()?;
        let problem = Problem::new(query, motion_is_free, &config.rrt)?;
        let mut goal_nodes = vec![None; problem.goals.len()];
        if let Some(goal) = problem.goal_at_start() {
            goal_nodes[goal] = Some(0);
        }
        Ok(Self {
            tree: CostTree::with_root(problem.start),
            config: *config,
            goal_nodes,
            problem,
        })
    }

    /// Grows and improves the tree until `stop` returns true, `max_iterations` more samples are drawn, or no path can be shorter.
    ///
    /// `stop` is asked before each sample; read a clock in it for a budget of time, or compare `Progress::length`.
    pub fn advance(&mut self, rng: &mut impl Rng, stop: impl FnMut(&Progress) -> bool) -> Plan<D> {
        self.run(rng, stop)
    }

    /// The goal whose path is shortest, and its length.
    fn best(&self) -> Option<(usize, f64)> {
        self.goal_nodes
            .iter()
            .enumerate()
            .filter_map(|(goal, node)| node.map(|node| (goal, self.tree.cost(node))))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// A goal without a path for the share `goal_bias`; else a point that can shorten the best path, or any.
    fn draw(&self, rng: &mut impl Rng) -> [f64; D] {
        let problem = &self.problem;
        let best = self.best().map_or(f64::INFINITY, |(_, length)| length);
        let improvable = |goal: &&[f64; D]| distance(&problem.start, goal) < best;
        let missing: Vec<[f64; D]> = (0..problem.goals.len())
            .filter(|&goal| self.goal_nodes[goal].is_none())
            .map(|goal| problem.goals[goal])
            .filter(|goal| improvable(&goal))
            .collect();
        if !self.config.informed || best == f64::INFINITY {
            return problem.sample(&missing, rng);
        }
        if rng.random::<f64>() < problem.config.goal_bias && !missing.is_empty() {
            return missing[rng.random_range(0..missing.len())];
        }
        let targets: Vec<&[f64; D]> = problem.goals.iter().filter(improvable).collect();
        match targets.len() {
            0 => problem.bounds.sample(rng),
            1 => sample_ellipsoid(&problem.start, targets[0], best, &problem.bounds, rng),
            many => {
                let target = targets[rng.random_range(0..many)];
                sample_ellipsoid(&problem.start, target, best, &problem.bounds, rng)
            }
        }
    }

    /// Whether a path through the point could be shorter than the best one; always true for plain RRT*.
    fn can_improve(&self, point: &[f64; D]) -> bool {
        !self.config.informed
            || self.best().is_none_or(|(_, best)| {
                let start = &self.problem.start;
                distance(start, point) + self.to_nearest_goal(point) < best
            })
    }

    fn to_nearest_goal(&self, point: &[f64; D]) -> f64 {
        self.problem
            .goals
            .iter()
            .map(|goal| distance(point, goal))
            .fold(f64::INFINITY, f64::min)
    }

    /// Adds a point under its best free parent and rewires its neighbours; `None` where no parent is free.
    fn insert(&mut self, point: [f64; D]) -> Option<usize> {
        let near = self.tree.nearest_k(&point, self.neighbour_count());
        let parent = self.best_parent(&point, &near)?;
        let node = self.tree.push(point, parent);
        for &(other, gap) in &near {
            let cost = self.tree.cost(node) + gap;
            if other != parent && cost < self.tree.cost(other) {
                let end = *self.tree.point(other);
                if self.problem.is_free(&point, &end) {
                    self.tree.set_parent(other, node);
                }
            }
        }
        Some(node)
    }

    fn best_parent(&mut self, point: &[f64; D], near: &[(usize, f64)]) -> Option<usize> {
        let mut order: Vec<(usize, f64)> = near
            .iter()
            .map(|&(node, gap)| (node, self.tree.cost(node) + gap))
            .collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let limit = match self.best() {
            Some((_, best)) if self.config.informed => best - self.to_nearest_goal(point),
            _ => f64::INFINITY,
        };
        order
            .into_iter()
            .take_while(|&(_, cost)| cost < limit)
            .find(|&(node, _)| {
                let from = *self.tree.point(node);
                self.problem.is_free(&from, point)
            })
            .map(|(node, _)| node)
    }

    fn neighbour_count(&self) -> usize {
        let dimension = D.max(1) as f64;
        let factor = self.config.rewire_factor * std::f64::consts::E * (1.0 + 1.0 / dimension);
        // At least 1; ln of a node count is small, so the conversion is exact.
        (factor * (self.tree.len() as f64 + 1.0).ln())
            .ceil()
            .max(1.0) as usize
    }
}

impl<'a, const D: usize, M: MotionValidator<D>> Search<'a, D, M> for RrtStar<'a, D, M> {
    fn problem(&mut self) -> &mut Problem<'a, D, M> {
        &mut self.problem
    }

    fn best_length(&self) -> Option<f64> {
        self.best().map(|(_, length)| length)
    }

    fn nodes(&self) -> usize {
        self.tree.len()
    }

    /// Only when the nearest goal is seen straight away is no path shorter.
    fn go_straight(&mut self, goal: usize) {
        let node = self.tree.push(self.problem.goals[goal], 0);
        self.goal_nodes[goal] = Some(node);
        let length = self.tree.cost(node);
        let goals = self.problem.goals.iter();
        let mut gaps = goals.map(|other| distance(&self.problem.start, other));
        if gaps.all(|gap| length <= gap) {
            self.problem.settled = Some(Stop::Straight);
        }
    }

    fn grow(&mut self, rng: &mut impl Rng) {
        let sample = self.draw(rng);
        let nearest = self.tree.nearest(&sample);
        let from = *self.tree.point(nearest);
        let to = steer(&from, &sample, self.config.rrt.step_length);
        if to == from || !self.can_improve(&to) {
            return;
        }
        let Some(node) = self.insert(to) else { return };
        for goal in 0..self.goal_nodes.len() {
            let end = self.problem.goals[goal];
            if self.goal_nodes[goal].is_some() {
                continue;
            }
            if end == to {
                self.goal_nodes[goal] = Some(node);
            } else if distance(&to, &end) <= self.config.rrt.step_length {
                self.goal_nodes[goal] = self.insert(end);
            }
        }
    }

    fn found(&self) -> Option<(Path<D>, usize)> {
        let (goal, _) = self.best()?;
        let way = self.tree.way_to(self.goal_nodes[goal]?);
        Some((Path::from_vertices(way), goal))
    }
}
