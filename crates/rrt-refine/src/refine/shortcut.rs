//! Random shortcuts: the baseline that most planning libraries ship.
//!
//! Reference: Geraerts, Overmars, "Creating high-quality paths for motion planning", IJRR 2007 (partial shortcut).

use rand::{Rng, RngExt};

use super::{RefineStop, Refined};
use crate::motion::MotionValidator;
use crate::path::{Path, Place};

/// Parameters of [`shortcut()`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShortcutConfig {
    /// Pairs of places to try. Default 100.
    pub attempts: usize,
    /// Where a shortcut may begin and end. Default anywhere.
    pub between: Places,
}

/// Where a random shortcut may begin and end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Places {
    /// At every place of the path.
    Anywhere,
    /// At its vertices.
    Vertices,
}

impl Default for ShortcutConfig {
    fn default() -> Self {
        Self {
            attempts: 100,
            between: Places::Anywhere,
        }
    }
}

/// Draws pairs of places along the path and replaces what lies between by the straight motion where that is free.
///
/// Every motion of the changed path is checked, the shortened rests of old segments too: at most three checks an attempt.
/// Never longer than the input. Not idempotent: more attempts go on shortening.
pub fn shortcut<const D: usize>(
    path: &Path<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &ShortcutConfig,
    rng: &mut impl Rng,
) -> Refined<D> {
    let mut best = path.clone();
    let mut checks = 0;
    for _ in 0..config.attempts {
        let (from, to) = match config.between {
            Places::Anywhere => two_places(&best, rng),
            Places::Vertices => two_vertices(&best, rng),
        };
        let candidate = join(&best, &from, &to);
        if from.segment == to.segment || candidate.length() >= best.length() {
            continue;
        }
        let old = best.points();
        let free = candidate.segments().all(|(a, b)| {
            let kept = old.windows(2).any(|pair| pair[0] == *a && pair[1] == *b);
            checks += usize::from(!kept);
            kept || motion_is_free.is_free(a, b)
        });
        if free {
            best = candidate;
        }
    }
    Refined {
        path: best,
        checks,
        length_before: path.length(),
        stop: RefineStop::Budget,
    }
}

fn two_places<const D: usize>(path: &Path<D>, rng: &mut impl Rng) -> (Place<D>, Place<D>) {
    let (a, b): (f64, f64) = (rng.random(), rng.random());
    let length = path.length();
    (
        path.place_at(a.min(b) * length),
        path.place_at(a.max(b) * length),
    )
}

fn two_vertices<const D: usize>(path: &Path<D>, rng: &mut impl Rng) -> (Place<D>, Place<D>) {
    let count = path.points().len();
    let (a, b) = (rng.random_range(0..count), rng.random_range(0..count));
    let place = |vertex: usize| Place {
        segment: vertex,
        point: path.points()[vertex],
    };
    (place(a.min(b)), place(a.max(b)))
}

/// The path with a straight motion between the two places.
fn join<const D: usize>(path: &Path<D>, from: &Place<D>, to: &Place<D>) -> Path<D> {
    let vertices = path.points();
    let mut points = vertices[..=from.segment].to_vec();
    points.extend([from.point, to.point]);
    points.extend_from_slice(&vertices[to.segment + 1..]);
    points.dedup();
    Path::from_vertices(points)
}
