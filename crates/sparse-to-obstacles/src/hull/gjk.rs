//! Distance between a convex hull and a segment, with bounds that hold even if the iteration stalls.
//!
//! Method: Gilbert-Johnson-Keerthi on the Minkowski difference hull - segment. Each round gives an upper
//! bound (a point of the difference) and a lower bound (a support plane), both valid in themselves;
//! the iteration ends when they meet, when the caller's threshold lies outside them, or when rounding
//! stops progress. Cost: a few rounds of one dot product per hull corner.
//!
//! References: Gilbert, Johnson and Keerthi, "A fast procedure for computing the distance between
//! complex objects in three-dimensional space", 1988; Ericson, "Real-time collision detection", 2005, 5.1.

use crate::vector::{Vec3, add, cross, dot, norm_squared, scale, sub};

/// What is known about the distance between a hull and a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Separation {
    /// The distance is at least this.
    pub(crate) lower: f64,
    /// The distance is at most this.
    pub(crate) upper: f64,
    /// Where on the segment, 0 at its start and 1 at its end, the upper bound is attained.
    pub(crate) at: f64,
}

/// Enough for hulls of hundreds of corners; typical are 3 to 6.
const MAX_ROUNDS: usize = 64;
/// Upper and lower bound count as equal within this share of the upper one.
const RELATIVE: f64 = 1e-10;

/// Bounds on the distance between the hull of `vertices` (not empty) and the segment from `a` to `b`.
///
/// Stops early once it is known on which side of `threshold` the distance lies; pass NaN to get it
/// to rounding.
pub(crate) fn separation(vertices: &[Vec3], a: Vec3, b: Vec3, threshold: f64) -> Separation {
    let mut simplex = Simplex::new(support(vertices, (a, b), sub(a, vertices[0])));
    let mut lower = 0.0_f64;
    let mut nearest = simplex.corners[0].offset;
    let mut squared = norm_squared(nearest);
    for _ in 0..MAX_ROUNDS {
        let upper = squared.sqrt();
        if upper <= f64::MIN_POSITIVE.sqrt() || upper <= threshold {
            break;
        }
        let corner = support(vertices, (a, b), scale(nearest, -1.0));
        lower = lower.max(dot(nearest, corner.offset) / upper);
        if lower > threshold || upper - lower <= RELATIVE * upper || simplex.contains(&corner) {
            break;
        }
        let former = simplex;
        nearest = simplex.extend(corner);
        let improved = norm_squared(nearest);
        if improved >= squared {
            simplex = former;
            break;
        }
        squared = improved;
    }
    Separation {
        lower,
        upper: squared.sqrt(),
        at: simplex.along_segment(),
    }
}

/// A corner of the Minkowski difference and whether it comes from the segment's end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Corner {
    offset: Vec3,
    of_end: bool,
}

/// The corner of (hull - segment) farthest along a direction.
#[inline]
fn support(vertices: &[Vec3], (a, b): (Vec3, Vec3), direction: Vec3) -> Corner {
    let mut most = f64::NEG_INFINITY;
    let mut farthest = 0;
    for (index, &vertex) in vertices.iter().enumerate() {
        let along = dot(vertex, direction);
        // An index is chosen in fewer operations than a vertex.
        if along > most {
            most = along;
            farthest = index;
        }
    }
    let farthest = vertices[farthest];
    let of_end = dot(sub(b, a), direction) < 0.0;
    Corner {
        offset: sub(farthest, if of_end { b } else { a }),
        of_end,
    }
}

/// Up to four corners and the convex weights of their point nearest to the origin.
#[derive(Clone, Copy, Debug)]
struct Simplex {
    corners: [Corner; 4],
    weights: [f64; 4],
    count: usize,
}

impl Simplex {
    fn new(corner: Corner) -> Self {
        Simplex {
            corners: [corner; 4],
            weights: [1.0, 0.0, 0.0, 0.0],
            count: 1,
        }
    }

    fn contains(&self, corner: &Corner) -> bool {
        self.corners[..self.count].contains(corner)
    }

    fn along_segment(&self) -> f64 {
        let of_end = |i: &usize| self.corners[*i].of_end;
        (0..self.count)
            .filter(of_end)
            .map(|i| self.weights[i])
            .sum::<f64>()
            .clamp(0.0, 1.0)
    }

    /// Adds a corner, keeps those that carry the point nearest to the origin, and returns that point.
    fn extend(&mut self, corner: Corner) -> Vec3 {
        self.corners[self.count] = corner;
        self.count += 1;
        let offset = |i: usize| self.corners[i].offset;
        let weights = match self.count {
            2 => {
                let [p, q] = edge(offset(0), offset(1));
                [p, q, 0.0, 0.0]
            }
            3 => {
                let [p, q, r] = triangle(offset(0), offset(1), offset(2));
                [p, q, r, 0.0]
            }
            _ => tetrahedron([offset(0), offset(1), offset(2), offset(3)]),
        };
        self.keep(weights)
    }

    fn keep(&mut self, weights: [f64; 4]) -> Vec3 {
        let mut kept = 0;
        let mut nearest = [0.0; 3];
        for (i, &weight) in weights.iter().enumerate().take(self.count) {
            if weight > 0.0 {
                nearest = add(nearest, scale(self.corners[i].offset, weight));
                self.corners[kept] = self.corners[i];
                self.weights[kept] = weight;
                kept += 1;
            }
        }
        self.count = kept;
        // Four weights: the origin lies inside.
        if kept == 4 { [0.0; 3] } else { nearest }
    }
}

/// Convex weights of the point of an edge nearest to the origin.
fn edge(p: Vec3, q: Vec3) -> [f64; 2] {
    let along = sub(q, p);
    let length = norm_squared(along);
    if length == 0.0 {
        return [1.0, 0.0];
    }
    let t = (-dot(p, along) / length).clamp(0.0, 1.0);
    [1.0 - t, t]
}

/// Convex weights of the point of a triangle nearest to the origin.
fn triangle(p: Vec3, q: Vec3, r: Vec3) -> [f64; 3] {
    let normal = cross(sub(q, p), sub(r, p));
    let area = norm_squared(normal);
    let inside = [cross(q, r), cross(r, p), cross(p, q)].map(|part| dot(part, normal));
    if area > 0.0 && inside.iter().all(|&part| part > 0.0) {
        let sum = inside[0] + inside[1] + inside[2];
        return inside.map(|part| part / sum);
    }
    let [a, b] = edge(p, q);
    let [c, d] = edge(q, r);
    let [e, f] = edge(r, p);
    let squared = |weights: [f64; 3]| {
        norm_squared(add(
            scale(p, weights[0]),
            add(scale(q, weights[1]), scale(r, weights[2])),
        ))
    };
    [[0.0, c, d], [f, 0.0, e]]
        .into_iter()
        .fold([a, b, 0.0], |best, candidate| {
            if squared(candidate) < squared(best) {
                candidate
            } else {
                best
            }
        })
}

/// Convex weights of the point of a tetrahedron nearest to the origin.
fn tetrahedron(corners: [Vec3; 4]) -> [f64; 4] {
    const FACES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    if let Some(weights) = inside_tetrahedron(corners) {
        return weights;
    }
    let mut best = [0.0; 4];
    let mut least = f64::INFINITY;
    for [i, j, k] in FACES {
        let [a, b, c] = triangle(corners[i], corners[j], corners[k]);
        let nearest = add(
            scale(corners[i], a),
            add(scale(corners[j], b), scale(corners[k], c)),
        );
        if norm_squared(nearest) < least {
            least = norm_squared(nearest);
            best = [0.0; 4];
            (best[i], best[j], best[k]) = (a, b, c);
        }
    }
    best
}

/// Barycentric weights of the origin, where it lies strictly inside.
fn inside_tetrahedron([p, q, r, s]: [Vec3; 4]) -> Option<[f64; 4]> {
    let volume = |a: Vec3, b: Vec3, c: Vec3| dot(a, cross(b, c));
    let parts = [
        volume(q, s, r),
        volume(p, r, s),
        volume(p, s, q),
        volume(p, q, r),
    ];
    let all = parts.iter().all(|&part| part > 0.0) || parts.iter().all(|&part| part < 0.0);
    let sum: f64 = parts.iter().sum();
    all.then(|| parts.map(|part| part / sum))
}
