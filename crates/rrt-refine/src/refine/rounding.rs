//! Arcs in place of sharp corners, wherever they keep a clearance.
//!
//! Method: a corner of angle θ is cut at the same distance t before and after its vertex, t at most half of either segment, and
//! an arc of radius t / tan(θ/2) joins the two places, drawn as ⌈θ / max_turn⌉ chords between points of the arc: each turn is
//! then at most `max_turn`. Where a motion is not free or the clearance not proven, t is halved, a few times.
//! Corners are taken in order; one whose neighbour changed is tried again.

use super::error::{not_negative, positive};
use super::{RefineError, RefineStop, Refined};
use crate::euclid::{between, distance};
use crate::motion::MotionValidator;
use crate::path::{Path, angle_between, between_samples, direction};

/// Parameters of [`round_corners`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundingConfig {
    /// Corners that turn by more than this many radians are rounded, and no corner of an arc turns by more; 0.01 to π.
    /// Default π/6.
    pub max_turn: f64,
    /// Largest radius of an arc, in the unit of the space; positive. Default 1 (metre).
    pub max_radius: f64,
    /// Clearance that every point of a new motion must have; 0 or more. Default 0: being free is enough.
    pub min_clearance: f64,
    /// How often the cut is halved before a corner is left as it is. Default 5.
    pub halvings: usize,
}

impl Default for RoundingConfig {
    fn default() -> Self {
        Self {
            max_turn: std::f64::consts::FRAC_PI_6,
            max_radius: 1.0,
            min_clearance: 0.0,
            halvings: 5,
        }
    }
}

/// Sharper corners are reversals: an arc through them has no radius to speak of.
const SHARPEST: f64 = 3.0;
/// Smallest `max_turn`, so that an arc has at most some hundred chords.
const SMALLEST_TURN: f64 = 0.01;
/// Bisections of one motion when its clearance is bounded.
const BISECTIONS: usize = 8;

impl RoundingConfig {
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), RefineError> {
        positive("max_turn", self.max_turn)?;
        // Below, the number of chords explodes.
        positive("max_turn - 0.01", self.max_turn - SMALLEST_TURN + 1e-12)?;
        positive("max_radius", self.max_radius)?;
        not_negative("min_clearance", self.min_clearance)
    }
}

/// Rounds the corners of `path` that turn by more than `max_turn`, where the arcs are free and keep `min_clearance`.
///
/// `clearance` gives the distance from a point to the nearest obstacle; it must be a distance (change by at most the
/// distance moved), so that samples bound it over a whole motion. Pass `|_| f64::INFINITY` where only freedom counts.
/// Corners that cannot be rounded stay, and so do near reversals (above 3 radians). Never longer than the input,
/// idempotent; every changed motion is checked.
///
/// # Errors
/// A parameter out of range.
pub fn round_corners<const D: usize>(
    path: &Path<D>,
    motion_is_free: &impl MotionValidator<D>,
    clearance: &impl Fn(&[f64; D]) -> f64,
    config: &RoundingConfig,
) -> Result<Refined<D>, RefineError> {
    config.validate()?;
    let mut rounding = Rounding {
        motion: motion_is_free,
        clearance,
        config,
        checks: 0,
    };
    let mut points = path.points().to_vec();
    points.dedup();
    // Each arc removes one sharp corner and makes none, but for rounding errors in coordinates that leave no digits.
    let mut left = points.len();
    let mut corner = 1;
    while corner + 1 < points.len() && left > 0 {
        match rounding.arc(&points[corner - 1..=corner + 1]) {
            Some(arc) => {
                points.splice(corner..=corner, arc);
                left -= 1;
                // The corner before has another neighbour now.
                corner = (corner - 1).max(1);
            }
            None => corner += 1,
        }
    }
    let rounded = Path::from_vertices(points);
    let gained = rounded.length() <= path.length();
    Ok(Refined {
        path: if gained { rounded } else { path.clone() },
        checks: rounding.checks,
        length_before: path.length(),
        stop: RefineStop::Done,
    })
}

struct Rounding<'a, M, C> {
    motion: &'a M,
    clearance: &'a C,
    config: &'a RoundingConfig,
    checks: usize,
}

impl<M, C> Rounding<'_, M, C> {
    /// The points that replace the middle of three, or `None` where the corner is fine or cannot be rounded.
    fn arc<const D: usize>(&mut self, corner: &[[f64; D]]) -> Option<Vec<[f64; D]>>
    where
        M: MotionValidator<D>,
        C: Fn(&[f64; D]) -> f64,
    {
        let [before, at, after] = corner else {
            return None;
        };
        let angle = angle_between(&direction(before, at)?, &direction(at, after)?);
        if angle <= self.config.max_turn * (1.0 + 1e-9) || angle > SHARPEST {
            return None;
        }
        let room = distance(before, at).min(distance(at, after)) / 2.0;
        let mut cut = room.min(self.config.max_radius * (angle / 2.0).tan());
        for _ in 0..=self.config.halvings {
            let chords = (angle / self.config.max_turn).ceil() as usize;
            let arc = arc_points(before, at, after, cut, angle, chords);
            if self.is_safe(before, &arc, after) {
                return Some(arc);
            }
            cut /= 2.0;
            // Nothing is left to halve, in the digits of the corner.
            if arc.first() == arc.last() {
                break;
            }
        }
        None
    }

    fn is_safe<const D: usize>(
        &mut self,
        before: &[f64; D],
        arc: &[[f64; D]],
        after: &[f64; D],
    ) -> bool
    where
        M: MotionValidator<D>,
        C: Fn(&[f64; D]) -> f64,
    {
        let least = self.config.min_clearance;
        let keeps_off = |pair: &[[f64; D]]| {
            let ends = [(self.clearance)(&pair[0]), (self.clearance)(&pair[1])];
            keeps_clearance(self.clearance, least, &pair[0], &pair[1], ends, BISECTIONS)
        };
        if least > 0.0 && !arc.windows(2).all(keeps_off) {
            return false;
        }
        let first = std::iter::once((before, &arc[0]));
        let last = std::iter::once((&arc[arc.len() - 1], after));
        let chords = arc.windows(2).map(|pair| (&pair[0], &pair[1]));
        chords.chain(first).chain(last).all(|(a, b)| {
            self.checks += 1;
            self.motion.is_free(a, b)
        })
    }
}

/// Points of the arc that touches both segments `cut` away from the corner `at`, both ends included.
fn arc_points<const D: usize>(
    before: &[f64; D],
    at: &[f64; D],
    after: &[f64; D],
    cut: f64,
    angle: f64,
    chords: usize,
) -> Vec<[f64; D]> {
    let enter = between(at, before, cut / distance(at, before));
    let leave = between(at, after, cut / distance(at, after));
    // In the frame (along the first segment, across it towards the second) the arc is (r sin φ, r (1 − cos φ)).
    let radius = cut / (angle / 2.0).tan();
    let (sin, cos) = angle.sin_cos();
    let mut points = vec![enter];
    for chord in 1..chords {
        let (s, c) = (angle * chord as f64 / chords as f64).sin_cos();
        let (along, across) = (radius * s, radius * (1.0 - c));
        points.push(std::array::from_fn(|axis| {
            let ahead = (at[axis] - enter[axis]) / cut;
            let next = (leave[axis] - at[axis]) / cut;
            let side = (next - cos * ahead) / sin;
            enter[axis] + along * ahead + across * side
        }));
    }
    points.push(leave);
    points
}

/// Whether the clearance is at least `least` all along the motion, as far as bisection can prove it.
fn keeps_clearance<const D: usize>(
    clearance: &impl Fn(&[f64; D]) -> f64,
    least: f64,
    a: &[f64; D],
    b: &[f64; D],
    ends: [f64; 2],
    depth: usize,
) -> bool {
    // Written so that a NaN fails.
    if !(ends[0] >= least && ends[1] >= least) {
        return false;
    }
    if between_samples(ends[0], ends[1], distance(a, b)) >= least {
        return true;
    }
    if depth == 0 {
        return false;
    }
    let middle = between(a, b, 0.5);
    let here = clearance(&middle);
    keeps_clearance(clearance, least, a, &middle, [ends[0], here], depth - 1)
        && keeps_clearance(clearance, least, &middle, b, [here, ends[1]], depth - 1)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

    use super::*;

    fn open(_: &[f64; 2], _: &[f64; 2]) -> bool {
        true
    }

    fn corner() -> Path<2> {
        Path::from_vertices(vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]])
    }

    #[test]
    fn an_open_corner_becomes_an_arc_of_the_largest_radius() -> Result<(), RefineError> {
        let rounded = round_corners(
            &corner(),
            &open,
            &|_| f64::INFINITY,
            &RoundingConfig::default(),
        )?;
        let path = &rounded.path;
        assert_eq!(path.points().len(), 6);
        assert!(path.turns().iter().all(|turn| *turn <= FRAC_PI_6 + 1e-9));
        for point in &path.points()[1..5] {
            assert!((distance(point, &[3.0, 1.0]) - 1.0).abs() < 1e-12);
        }
        assert!(path.length() < 8.0 - 2.0 + FRAC_PI_2);
        let again = round_corners(path, &open, &|_| f64::INFINITY, &RoundingConfig::default())?;
        assert_eq!(again.path, *path);
        Ok(())
    }

    #[test]
    fn clearance_limits_the_cut() -> Result<(), RefineError> {
        // An obstacle point inside the corner.
        let off = |p: &[f64; 2]| distance(p, &[3.2, 0.8]);
        let config = RoundingConfig {
            min_clearance: 0.7,
            ..Default::default()
        };
        let rounded = round_corners(&corner(), &open, &off, &config)?;
        let profile = rounded
            .path
            .clearance_profile(0.01, off)
            .map_err(RefineError::Path)?;
        assert!(profile.min >= 0.7, "{}", profile.min);
        assert!(rounded.path.points().len() > 3);
        let tight = RoundingConfig {
            min_clearance: 1.2,
            ..config
        };
        assert_eq!(
            round_corners(&corner(), &open, &off, &tight)?.path,
            corner()
        );
        Ok(())
    }

    #[test]
    fn every_changed_motion_is_checked() -> Result<(), RefineError> {
        let round = |free: &dyn Fn(&[f64; 2], &[f64; 2]) -> bool| {
            let config = RoundingConfig::default();
            round_corners(&corner(), &free, &|_| f64::INFINITY, &config)
        };
        // Refused are the way to the arc, the way from it, and its chords, one at a time.
        let before_arc = round(&|a, _| *a != [0.0, 0.0])?;
        let after_arc = round(&|_, b| *b != [4.0, 4.0])?;
        let chords = round(&|a, b| *a == [0.0, 0.0] || *b == [4.0, 4.0])?;
        for refused in [before_arc, after_arc, chords] {
            assert_eq!(refused.path, corner());
        }
        Ok(())
    }

    #[test]
    fn a_corner_is_tried_again_when_its_neighbour_is_rounded() -> Result<(), RefineError> {
        // An arc of radius 2 around the first corner meets the block, one of radius 1 does not: there is room for no more once the
        // second corner is an arc.
        let path = Path::from_vertices(vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [8.0, 4.0]]);
        let free = |a: &[f64; 2], b: &[f64; 2]| {
            (0..=100).all(|k| {
                let [x, y] = between(a, b, f64::from(k) / 100.0);
                !(x < 3.55 && (0.45..2.0).contains(&y))
            })
        };
        let config = RoundingConfig {
            max_radius: 9.0,
            halvings: 0,
            ..RoundingConfig::default()
        };
        let path = round_corners(&path, &free, &|_| f64::INFINITY, &config)?.path;
        assert!(path.turns().iter().all(|turn| *turn <= FRAC_PI_6 + 1e-9));
        Ok(())
    }

    #[test]
    fn reversals_and_bad_parameters() -> Result<(), RefineError> {
        let back = Path::from_vertices(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
        let config = RoundingConfig::default();
        assert_eq!(round_corners(&back, &open, &|_| 1.0, &config)?.path, back);
        for max_turn in [0.0, -1.0, 1e-9, f64::NAN] {
            let config = RoundingConfig { max_turn, ..config };
            assert!(round_corners(&back, &open, &|_| 1.0, &config).is_err());
        }
        Ok(())
    }
}
