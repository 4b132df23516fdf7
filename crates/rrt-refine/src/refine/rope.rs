//! Tightens a path like a rope: cut it finely, take the shortest path over all cuts, repeat until it no longer gets shorter.
//!
//! Reference: Hsu, Hsu, "RRT-Rope: a deterministic shortening approach for fast near-optimal path planning in large-scale
//! uncluttered 3D environments", 2021; there the replacement is greedy, here it is the optimum of each round.

use super::error::{not_negative, positive};
use super::visibility_graph::{Known, cheapest_way};
use super::{RefineError, RefineStop, Refined, dag};
use crate::euclid::distance;
use crate::motion::MotionValidator;
use crate::path::{Path, PathError};

/// Parameters of [`rope()`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RopeConfig {
    /// Longest part that the path is cut into, in the unit of the space; positive. Default 0.4 for metres indoors, half the
    /// step of the study of this crate's README. Halving it about doubles to quadruples the checks.
    pub max_step: f64,
    /// A round must shorten the path by this share, or it is the last; 0 or more. Default 0.001.
    pub min_gain: f64,
    /// Most motions to check. Default 20,000.
    pub max_checks: usize,
}

impl Default for RopeConfig {
    fn default() -> Self {
        Self {
            max_step: 0.4,
            min_gain: 1e-3,
            max_checks: 20_000,
        }
    }
}

impl RopeConfig {
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), RefineError> {
        positive("max_step", self.max_step)?;
        not_negative("min_gain", self.min_gain)
    }
}

/// Most places that a path is cut into: the time grows with their square.
const MOST_PLACES: usize = 10_000;

/// Tightens `path` to near the shortest path of its kind (around the same obstacles on the same sides).
///
/// Starts from the result of [`dag()`], whose checks, repeated on the few vertices after each round, are not limited by `max_checks`. Every motion of a changed path is
/// checked, parts of old segments too. Never longer than the input; idempotent when it ends with [`RefineStop::Done`].
///
/// # Errors
/// A parameter out of range, or a step so small that more than ten thousand vertices were needed.
pub fn rope<const D: usize>(
    path: &Path<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &RopeConfig,
) -> Result<Refined<D>, RefineError> {
    config.validate()?;
    let first = dag(path, motion_is_free);
    let (mut best, mut checks) = (first.path, first.checks);
    let mut left = config.max_checks;
    let stop = loop {
        let needed = best.length() / config.max_step + best.points().len() as f64;
        if needed > MOST_PLACES as f64 {
            let limit = MOST_PLACES;
            return Err(PathError::TooMany { needed, limit }.into());
        }
        let dense = best.densified(config.max_step)?;
        let points = dense.points();
        let bound = best.length() * (1.0 - config.min_gain);
        let found = cheapest_way(points, motion_is_free, Known::Bound(bound), left, &distance);
        checks += found.checks;
        left -= found.checks;
        let spent = left == 0;
        match found.vertices {
            Some(way) if found.cost < bound => {
                let way = way.into_iter().map(|place| points[place]).collect();
                let round = dag(&Path::from_vertices(way), motion_is_free);
                checks += round.checks;
                best = round.path;
            }
            _ if spent => break RefineStop::Budget,
            _ => break RefineStop::Done,
        }
        if spent {
            break RefineStop::Budget;
        }
    };
    Ok(Refined {
        path: best,
        checks,
        length_before: path.length(),
        stop,
    })
}
