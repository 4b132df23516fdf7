//! Pulls a path taut: cut every corner as far as bisection finds it free, take the shortest path over the cuts, repeat.
//!
//! Method: 1. [`dag()`]; 2. at each corner v between a and b find by bisection a large share s for which the chord between
//! v + s (a − v) and v + s (b − v) is free (half of an inner segment at most, all of an outer one), and put its ends in
//! place of v; 3. shortest path over all vertices; 4. again from 2 until a round gains too little.
//! Cost: about `bisections` checks a corner and round, and a few for the shortest path.
//!
//! The paper stops after step 1. In the apartment of the README two rounds reach for 75 checks what [`rope()`](super::rope())
//! reaches for 700.

use super::error::not_negative;
use super::{RefineError, RefineStop, Refined, dag};
use crate::euclid::between;
use crate::motion::MotionValidator;
use crate::path::Path;

/// Parameters of [`taut()`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TautConfig {
    /// Most rounds. Default 4.
    pub max_rounds: usize,
    /// Bisections of the cut at a corner; 0 tries the whole cut only. Default 4: the cut is found to a sixteenth.
    pub bisections: usize,
    /// A round must shorten the path by this share, or it is the last; 0 or more. Default 0.001.
    pub min_gain: f64,
}

impl Default for TautConfig {
    fn default() -> Self {
        Self {
            max_rounds: 4,
            bisections: 4,
            min_gain: 1e-3,
        }
    }
}

impl TautConfig {
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), RefineError> {
        not_negative("min_gain", self.min_gain)
    }
}

/// Tightens `path` to near the shortest path of its kind (around the same obstacles on the same sides).
///
/// Never longer than the input, and never longer than [`dag()`]; idempotent when it ends with [`RefineStop::Done`]. Every
/// motion of a changed path is checked, parts of old segments too.
///
/// ```
/// use rrt_refine::{Path, refine};
/// // Around a disc of radius 1 at the origin.
/// let free = |a: &[f64; 2], b: &[f64; 2]| {
///     let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
///     let t = (-(a[0] * dx + a[1] * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
///     (a[0] + t * dx).powi(2) + (a[1] + t * dy).powi(2) >= 1.0
/// };
/// let path = Path::new(&[[-2.0, 0.0], [0.0, 2.0], [2.0, 0.0]])?;
/// let refined = refine::taut(&path, &free, &refine::TautConfig::default())?;
/// // Two tangents of √3 and an arc of π/3.
/// assert!(refined.path.length() < 1.01 * (2.0 * 3.0_f64.sqrt() + std::f64::consts::FRAC_PI_3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A parameter out of range.
pub fn taut<const D: usize>(
    path: &Path<D>,
    motion_is_free: &impl MotionValidator<D>,
    config: &TautConfig,
) -> Result<Refined<D>, RefineError> {
    config.validate()?;
    let mut refined = dag(path, motion_is_free);
    let mut best = refined.path.clone();
    refined.stop = RefineStop::Budget;
    for _ in 0..config.max_rounds {
        let (cut, checks) = cut_corners(best.points(), motion_is_free, config.bisections);
        let round = dag(&Path::from_vertices(cut), motion_is_free);
        refined.checks += checks + round.checks;
        if round.path.length() >= best.length() * (1.0 - config.min_gain) {
            refined.stop = RefineStop::Done;
            break;
        }
        best = round.path;
    }
    // Parts of free segments are free, but for rounding; then the shortest path over the vertices stands.
    if best != refined.path {
        refined.checks += best.points().len() - 1;
        if best.first_blocked(motion_is_free).is_none() {
            refined.path = best;
        }
    }
    Ok(refined)
}

/// The vertices with each corner replaced by the ends of its chord, and the checks spent.
fn cut_corners<const D: usize>(
    points: &[[f64; D]],
    motion_is_free: &impl MotionValidator<D>,
    bisections: usize,
) -> (Vec<[f64; D]>, usize) {
    let last = points.len() - 1;
    let mut cut = vec![points[0]];
    let mut checks = 0;
    for corner in 1..last {
        let room_before = if corner == 1 { 1.0 } else { 0.5 };
        let room_after = if corner + 1 == last { 1.0 } else { 0.5 };
        let chord = |share: f64| {
            (
                between(&points[corner], &points[corner - 1], share * room_before),
                between(&points[corner], &points[corner + 1], share * room_after),
            )
        };
        let share = largest_free(bisections, |share| {
            let (from, to) = chord(share);
            checks += 1;
            motion_is_free.is_free(&from, &to)
        });
        if share > 0.0 {
            let (from, to) = chord(share);
            cut.extend([from, to]);
        } else {
            cut.push(points[corner]);
        }
    }
    cut.push(points[last]);
    cut.dedup();
    (cut, checks)
}

/// 1 if that is free, else the largest share that bisection from 0 finds free.
fn largest_free(bisections: usize, mut is_free: impl FnMut(f64) -> bool) -> f64 {
    if is_free(1.0) {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..bisections {
        let middle = (low + high) / 2.0;
        if middle <= low || middle >= high {
            break;
        }
        if is_free(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
