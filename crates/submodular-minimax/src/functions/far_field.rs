//! Upper bounds on Σ weight(v) (s(u, v) − served(v))₊ from the moments of boxes of clients.
//!
//! Over a kd-tree node with squared distances q in [a, b] from u, mean m and variance V (both exact,
//! from centroid, covariance, third and fourth moments), a kernel s with s'' falling in q obeys
//!
//! ```text
//! s(m) + V r(b) ≤ mean s(q) ≤ s(m) + V r(a),   r(q) = (s(q) − s(m) − s'(m) (q − m)) / (q − m)²
//! ```
//!
//! an error of third order in node size over distance. All kernels here are of that kind. Where one
//! has a kink (the linear one at its reach) the chord bounds it instead. Service is subtracted; what
//! clients that are served better than u could serve them would take back is bounded by the node's
//! extremes. Nodes are opened until the error is what the caller allows.

use super::similarity::Points;
use crate::neighbours::RangeTree;
use crate::points::squared_distance;

/// Clients in leaf order, the boxes above them and how well they are served.
pub(super) struct Clients {
    order: Vec<u32>,
    places: Vec<[f64; 3]>,
    weights: Vec<f64>,
    served: Vec<f64>,
    nodes: Vec<Node>,
}

/// A box of clients, what they weigh, where they are, how well they are served.
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    start: usize,
    end: usize,
    right: usize,
    moments: Moments,
    least_served: f64,
    most_served: f64,
    total_served: f64,
}

/// Weighted moments of the places in a node, all but the centroid central and divided by the weight.
#[derive(Default)]
struct Moments {
    weight: f64,
    centroid: [f64; 3],
    /// E‖δ‖².
    variance: f64,
    /// E δδᵀ: xx, yy, zz, xy, xz, yz.
    covariance: [f64; 6],
    /// E δ‖δ‖².
    third: [f64; 3],
    /// Var ‖δ‖².
    fourth: f64,
}

impl Clients {
    /// All points as clients, none served.
    pub(super) fn new(points: &[[f64; 3]], weight: impl Fn(usize) -> f64) -> Self {
        let tree = RangeTree::new(points, &[]);
        let order = tree.order().to_vec();
        let places: Vec<[f64; 3]> = order.iter().map(|&v| points[v as usize]).collect();
        let weights: Vec<f64> = order.iter().map(|&v| weight(v as usize)).collect();
        let nodes = tree.boxes().map(|(low, high, span, right)| Node {
            low,
            high,
            start: span.start,
            end: span.end,
            right,
            moments: Moments::new(&places[span.clone()], &weights[span]),
            least_served: 0.0,
            most_served: 0.0,
            total_served: 0.0,
        });
        Self {
            nodes: nodes.collect(),
            served: vec![0.0; points.len()],
            order,
            places,
            weights,
        }
    }

    /// What all clients weigh together.
    pub(super) fn weight(&self) -> f64 {
        self.nodes.first().map_or(0.0, |root| root.moments.weight)
    }

    /// Renews the service, `served[v]` of client v.
    pub(super) fn serve(&mut self, served: &[f64]) {
        for (own, &v) in self.served.iter_mut().zip(&self.order) {
            *own = served[v as usize];
        }
        for at in (0..self.nodes.len()).rev() {
            self.renew(at);
        }
    }

    /// Renews what a node knows of its clients' service; its children know theirs already.
    fn renew(&mut self, at: usize) {
        let (span, right) = (
            self.nodes[at].start..self.nodes[at].end,
            self.nodes[at].right,
        );
        let (mut least, mut most, mut total) = (f64::INFINITY, 0.0_f64, 0.0);
        if right == 0 {
            for i in span {
                least = least.min(self.served[i]);
                most = most.max(self.served[i]);
                total += self.weights[i] * self.served[i];
            }
        } else {
            for child in [at + 1, right] {
                least = least.min(self.nodes[child].least_served);
                most = most.max(self.nodes[child].most_served);
                total += self.nodes[child].total_served;
            }
        }
        let node = &mut self.nodes[at];
        (node.least_served, node.most_served, node.total_served) = (least, most, total);
    }

    /// No facility at `center` gains more, and it gains at most `allowed` x [`Self::weight`] less.
    pub(super) fn gain_bound(&self, kernel: &Points, center: [f64; 3], allowed: f64) -> f64 {
        let mut stack = [0_usize; DEEPEST];
        let mut waiting = usize::from(!self.nodes.is_empty());
        let mut sum = 0.0;
        while waiting > 0 {
            waiting -= 1;
            let at = stack[waiting];
            let node = &self.nodes[at];
            if let Some(bound) = node.gain_bound(kernel, center, allowed) {
                sum += bound;
            } else if node.right == 0 || waiting + 2 > DEEPEST {
                sum += self.exactly(node, kernel, center);
            } else {
                (stack[waiting], stack[waiting + 1]) = (node.right, at + 1);
                waiting += 2;
            }
        }
        sum * (1.0 + ROUNDING) + ROUNDING * allowed * self.weight()
    }

    fn exactly(&self, node: &Node, kernel: &Points, center: [f64; 3]) -> f64 {
        let more = |i: usize| {
            let s = kernel.evaluate(squared_distance(center, self.places[i]));
            self.weights[i] * (s - self.served[i]).max(0.0)
        };
        (node.start..node.end).map(more).sum()
    }
}

impl Node {
    /// The bound if it errs by at most `allowed` per unit of weight, else nothing.
    fn gain_bound(&self, kernel: &Points, center: [f64; 3], allowed: f64) -> Option<f64> {
        let (near, far) = self.squared_distances(center);
        let most = kernel.evaluate(near);
        let weight = self.moments.weight;
        if most <= self.least_served {
            return Some(0.0);
        }
        let coarse = weight * (most - self.least_served);
        if coarse <= allowed * weight {
            return Some(coarse);
        }
        let least = kernel.evaluate(far);
        let regret = (self.most_served - least).max(0.0);
        if regret > allowed {
            return None;
        }
        let mean = self.moments.mean_square(center).clamp(near, far);
        let value = kernel.evaluate(mean);
        let (lower, upper) = if far <= kernel.smooth_within() {
            let spread = self.moments.spread(center);
            let bent = |at: f64| match spread > 0.0 {
                true => value + spread * kernel.bend(mean, at),
                false => value,
            };
            (bent(far), bent(near).min(most))
        } else {
            let share = if far > near {
                (mean - near) / (far - near)
            } else {
                0.0
            };
            (value, most + share * (least - most))
        };
        if upper - lower + regret > allowed {
            return None;
        }
        let total = weight * (upper + regret) - self.total_served;
        Some(total.min(coarse) + ROUNDING * weight)
    }

    /// The least and the largest squared distance to the box.
    fn squared_distances(&self, center: [f64; 3]) -> (f64, f64) {
        let (mut near, mut far) = (0.0, 0.0);
        for (axis, &x) in center.iter().enumerate() {
            let (below, above) = (self.low[axis] - x, x - self.high[axis]);
            let outside = below.max(above).max(0.0);
            let across = below.abs().max(above.abs());
            near += outside * outside;
            far += across * across;
        }
        (near, far)
    }
}

impl Moments {
    fn new(places: &[[f64; 3]], weights: &[f64]) -> Self {
        let weight: f64 = weights.iter().sum();
        if weight <= 0.0 {
            return Self::default();
        }
        let mut centroid = [0.0; 3];
        for (place, w) in places.iter().zip(weights) {
            (0..3).for_each(|axis| centroid[axis] += w / weight * place[axis]);
        }
        let mut moments = Self {
            weight,
            centroid,
            ..Self::default()
        };
        for (place, w) in places.iter().zip(weights) {
            moments.add(
                [0, 1, 2].map(|axis| place[axis] - centroid[axis]),
                w / weight,
            );
        }
        moments.fourth = (moments.fourth - moments.variance * moments.variance).max(0.0);
        moments
    }

    fn add(&mut self, [x, y, z]: [f64; 3], share: f64) {
        let square = x * x + y * y + z * z;
        self.variance += share * square;
        self.fourth += share * square * square;
        let products = [x * x, y * y, z * z, x * y, x * z, y * z];
        for (sum, product) in self.covariance.iter_mut().zip(products) {
            *sum += share * product;
        }
        for (sum, side) in self.third.iter_mut().zip([x, y, z]) {
            *sum += share * square * side;
        }
    }

    fn mean_square(&self, center: [f64; 3]) -> f64 {
        squared_distance(center, self.centroid) + self.variance
    }

    /// The variance of the squared distances from `center`.
    fn spread(&self, center: [f64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.centroid[axis] - center[axis]);
        let c = &self.covariance;
        let along = c[0] * x * x
            + c[1] * y * y
            + c[2] * z * z
            + 2.0 * (c[3] * x * y + c[4] * x * z + c[5] * y * z);
        let skew = self.third[0] * x + self.third[1] * y + self.third[2] * z;
        (4.0 * (along + skew) + self.fourth).max(0.0)
    }
}

/// Relative slack for rounding; sums of a million terms err by less.
const ROUNDING: f64 = 1e-9;
/// Nodes that wait at most: the tree halves, so its depth is that of 2^60 points.
const DEEPEST: usize = 64;
