//! Exact queries of a ball that moves along a segment among the obstacles.

use super::ObstacleSet;
use super::bvh::Motion;
use crate::hull::separation;
use crate::point::is_finite;
use crate::vector::{Vec3, lerp};

/// Where a moving ball first touches an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstContact {
    /// The share of the motion done, from 0 to 1.
    pub at: f64,
    /// The centre of the ball at that moment.
    pub centre: [f64; 3],
    /// Index of the obstacle.
    pub obstacle: usize,
}

impl ObstacleSet {
    /// Can a ball of this radius move in a straight line from `a` to `b` without touching an obstacle?
    ///
    /// Exact for the whole sweep to rounding (a share of 1e-10), where in doubt the answer is no.
    /// Contact counts as not free. A coordinate or radius that is not finite, or a negative radius, is
    /// not free. Cost: microseconds among a thousand obstacles.
    #[must_use]
    pub fn motion_is_free(&self, a: [f64; 3], b: [f64; 3], radius: f64) -> bool {
        if !usable(a, b, radius) {
            return false;
        }
        let motion = Motion::new(a, b);
        !self.bvh.any_near(&motion, radius, |obstacle| {
            separation(&self.hulls[obstacle].vertices, a, b, radius).lower <= radius
        })
    }

    /// The least distance between the segment from `a` to `b` and any hull: the radius of the largest
    /// ball that can make the motion. 0 where it touches one, infinite without obstacles, NaN where a
    /// coordinate is not finite.
    #[must_use]
    pub fn clearance(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        if !is_finite(a) || !is_finite(b) {
            return f64::NAN;
        }
        self.bvh.least(&Motion::new(a, b), |obstacle, best| {
            let found = separation(&self.hulls[obstacle].vertices, a, b, f64::NAN);
            if found.lower >= best {
                best
            } else {
                found.upper
            }
        })
    }

    /// The distance from a point to the nearest hull, as [`clearance`](Self::clearance).
    #[must_use]
    pub fn point_clearance(&self, point: [f64; 3]) -> f64 {
        self.clearance(point, point)
    }

    /// Where a ball that moves from `a` to `b` first touches an obstacle, or `None` where the motion is
    /// free or the input is not finite.
    #[must_use]
    pub fn first_contact(&self, a: [f64; 3], b: [f64; 3], radius: f64) -> Option<FirstContact> {
        if !usable(a, b, radius) {
            return None;
        }
        let mut first: Option<FirstContact> = None;
        self.bvh.any_near(&Motion::new(a, b), radius, |obstacle| {
            if let Some(at) = contact(&self.hulls[obstacle].vertices, a, b, radius) {
                let earlier = first.is_none_or(|first| (at, obstacle) < (first.at, first.obstacle));
                if earlier {
                    first = Some(FirstContact {
                        at,
                        centre: lerp(a, b, at),
                        obstacle,
                    });
                }
            }
            false
        });
        first
    }
}

fn usable(a: Vec3, b: Vec3, radius: f64) -> bool {
    is_finite(a) && is_finite(b) && radius >= 0.0 && radius.is_finite()
}

/// The share of the motion at which the ball touches the hull. The distance to a convex set along a line
/// is convex, so it falls monotonously up to its minimum, where the search for the contact ends.
fn contact(vertices: &[Vec3], a: Vec3, b: Vec3, radius: f64) -> Option<f64> {
    let touches = |at: f64| {
        let centre = lerp(a, b, at);
        separation(vertices, centre, centre, radius).lower <= radius
    };
    let nearest = separation(vertices, a, b, f64::NAN);
    if nearest.lower > radius {
        return None;
    }
    if touches(0.0) {
        return Some(0.0);
    }
    let (mut free, mut held) = (0.0, nearest.at);
    while held - free > 1e-12 {
        let middle = 0.5 * (free + held);
        if touches(middle) {
            held = middle;
        } else {
            free = middle;
        }
    }
    Some(held)
}
