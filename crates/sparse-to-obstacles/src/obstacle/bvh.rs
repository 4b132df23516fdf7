//! A bounding-volume hierarchy of boxes: which obstacles can a moving ball touch, which is nearest?

use crate::vector::{Vec3, max, min, norm, sub};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

impl Aabb {
    const EMPTY: Aabb = Aabb {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    pub(crate) fn of(points: &[Vec3]) -> Self {
        points.iter().fold(Aabb::EMPTY, |aabb, &point| Aabb {
            low: min(aabb.low, point),
            high: max(aabb.high, point),
        })
    }

    fn union(self, other: Aabb) -> Self {
        Aabb {
            low: min(self.low, other.low),
            high: max(self.high, other.high),
        }
    }

    /// The gap between two boxes, 0 where they overlap.
    fn distance(&self, other: &Aabb) -> f64 {
        let gap = max(sub(self.low, other.high), sub(other.low, self.high));
        norm(max(gap, [0.0; 3]))
    }
}

/// A segment prepared for box tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    start: Vec3,
    inverse: Vec3,
    aabb: Aabb,
    /// What rounding of the coordinates may amount to.
    slack: f64,
}

impl Motion {
    pub(crate) fn new(start: Vec3, end: Vec3) -> Self {
        let along = sub(end, start);
        let largest = start
            .iter()
            .chain(&end)
            .fold(0.0_f64, |most, c| most.max(c.abs()));
        let aabb = Aabb::of(&[start, end]);
        Motion {
            start,
            inverse: along.map(|c| 1.0 / c),
            aabb,
            slack: 1e-12 * largest,
        }
    }

    /// Can the segment come within `radius` of the box? Exact for the box widened by the radius along
    /// the axes, so never wrongly no.
    #[inline]
    pub(crate) fn may_touch(&self, aabb: &Aabb, radius: f64) -> bool {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let radius = radius * (1.0 + 1e-12) + self.slack;
        for axis in 0..3 {
            let (low, high) = (aabb.low[axis] - radius, aabb.high[axis] + radius);
            if self.aabb.high[axis] < low || self.aabb.low[axis] > high {
                return false;
            }
            let inverse = self.inverse[axis];
            if inverse.is_finite() {
                let t0 = (low - self.start[axis]) * inverse;
                let t1 = (high - self.start[axis]) * inverse;
                enter = enter.max(t0.min(t1));
                leave = leave.min(t0.max(t1));
            }
        }
        enter <= leave * (1.0 + 1e-12)
    }

    pub(crate) fn distance_bound(&self, aabb: &Aabb) -> f64 {
        self.aabb.distance(aabb)
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    aabb: Aabb,
    /// Leaves: range of `order`. Inner nodes: `count` is 0, the left child follows, `first` is the right.
    first: u32,
    count: u32,
}

/// Built in O(n log n) by splitting at the median of the widest axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Aabb>,
}

const LEAF: usize = 4;

impl Bvh {
    pub(crate) fn new(boxes: Vec<Aabb>) -> Self {
        let order = (0..boxes.len() as u32).collect();
        let mut bvh = Bvh {
            nodes: Vec::new(),
            order,
            boxes,
        };
        if !bvh.boxes.is_empty() {
            bvh.build(0, bvh.boxes.len());
        }
        bvh
    }

    fn build(&mut self, start: usize, end: usize) {
        let (boxes, order) = (&self.boxes, &mut self.order[start..end]);
        let aabb = order
            .iter()
            .fold(Aabb::EMPTY, |all, &i| all.union(boxes[i as usize]));
        let node = self.nodes.len();
        if order.len() <= LEAF {
            self.nodes.push(Node {
                aabb,
                first: start as u32,
                count: order.len() as u32,
            });
            return;
        }
        let centre =
            |i: u32, axis: usize| boxes[i as usize].low[axis] + boxes[i as usize].high[axis];
        let axis = widest_axis(order.iter().map(|&i| [0, 1, 2].map(|axis| centre(i, axis))));
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |&a, &b| {
            centre(a, axis).total_cmp(&centre(b, axis)).then(a.cmp(&b))
        });
        self.nodes.push(Node {
            aabb,
            first: 0,
            count: 0,
        });
        self.build(start, start + middle);
        self.nodes[node].first = self.nodes.len() as u32;
        self.build(start + middle, end);
    }

    /// Calls `accept` for the boxes that the motion may come within `radius` of, until one is accepted.
    pub(crate) fn any_near(
        &self,
        motion: &Motion,
        radius: f64,
        mut accept: impl FnMut(usize) -> bool,
    ) -> bool {
        let mut node = 0;
        // Depth-first without a stack of both children: the left child is the next node.
        let mut pending = Stack::default();
        while let Some(current) = self.nodes.get(node) {
            if motion.may_touch(&current.aabb, radius) {
                if current.count == 0 {
                    pending.push(current.first as usize);
                    node += 1;
                    continue;
                }
                for &i in &self.order[current.first as usize..][..current.count as usize] {
                    let i = i as usize;
                    if motion.may_touch(&self.boxes[i], radius) && accept(i) {
                        return true;
                    }
                }
            }
            match pending.pop() {
                Some(next) => node = next,
                None => break,
            }
        }
        false
    }

    /// The smallest value of `measure` over all boxes, where `measure(i, best)` is at least the distance
    /// between motion and box i, or anything above `best` where that is known to be larger.
    pub(crate) fn least(&self, motion: &Motion, mut measure: impl FnMut(usize, f64) -> f64) -> f64 {
        let mut best = f64::INFINITY;
        let mut pending = Stack::default();
        if !self.nodes.is_empty() {
            pending.push(0);
        }
        while let Some(node) = pending.pop() {
            let current = &self.nodes[node];
            if motion.distance_bound(&current.aabb) >= best
                || !motion.may_touch(&current.aabb, best)
            {
                continue;
            }
            if current.count > 0 {
                for &i in &self.order[current.first as usize..][..current.count as usize] {
                    if motion.distance_bound(&self.boxes[i as usize]) < best {
                        best = best.min(measure(i as usize, best));
                    }
                }
                continue;
            }
            let (left, right) = (node + 1, current.first as usize);
            let bound = |child: usize| motion.distance_bound(&self.nodes[child].aabb);
            let (near, far) = if bound(left) <= bound(right) {
                (left, right)
            } else {
                (right, left)
            };
            pending.push(far);
            pending.push(near);
        }
        best
    }
}

/// A fixed stack: splitting at the median bounds the depth of any slice by 64.
struct Stack {
    items: [u32; 130],
    count: usize,
}

impl Default for Stack {
    fn default() -> Self {
        Stack {
            items: [0; 130],
            count: 0,
        }
    }
}

impl Stack {
    #[inline]
    fn push(&mut self, node: usize) {
        self.items[self.count] = node as u32;
        self.count += 1;
    }

    #[inline]
    fn pop(&mut self) -> Option<usize> {
        self.count = self.count.checked_sub(1)?;
        Some(self.items[self.count] as usize)
    }
}

fn widest_axis(centres: impl Iterator<Item = Vec3>) -> usize {
    let (low, high) = centres.fold(
        ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]),
        |(low, high), c| (min(low, c), max(high, c)),
    );
    let extent = sub(high, low);
    (1..3).fold(0, |best, axis| {
        if extent[axis] > extent[best] {
            axis
        } else {
            best
        }
    })
}
