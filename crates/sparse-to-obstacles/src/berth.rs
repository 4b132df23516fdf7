//! How much room a path keeps beyond the body's own: the widest berth first, and less only where there is no other way.
//!
//! Input:  a [`Space`], the body's radius and the two ends of the path.
//! Output: whether a motion keeps the berth; the berths to try, widest first.
//! Method: a shortest path hugs every corner, and what is proven free is proven to a voxel. So a path is asked for with a ball
//!         of twice the radius, then with less down to the radius, and the first that there is wins. Near its ends, which
//!         are given, the radius is always enough.
//! Cost: a failed search for every berth that is too wide.

use crate::space::Space;
use crate::vector::distance;

/// The room that every motion of one path keeps.
///
/// ```
/// use rand::SeedableRng;
/// use sparse_to_obstacles::{Berth, ObstacleConfig, ObstacleSet, Space};
///
/// // Two posts with 0.5 m between them.
/// let posts = [[3.0, -0.25, 0.0], [3.0, 0.25, 0.0]];
/// let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
/// let hulls = ObstacleSet::from_points(&posts, &ObstacleConfig::with_clusters(2), &mut rng)?;
/// let ends = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0]];
/// // Ask a planner for a path with each of them in turn; here the straight way is the only one.
/// let mut berths = Berth::widest_first(0.15, ends);
/// let space = Space::Hulls(&hulls);
/// let widest = berths.find(|berth| berth.allows(&space, ends[0], ends[1]));
/// assert!((widest.ok_or("no way")?.width - 0.2).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Berth {
    /// Radius of the ball that moves between the ends, map units. At least [`radius`](Self::radius).
    pub width: f64,
    /// Radius of the body with its margin, map units: enough near the ends.
    pub radius: f64,
    /// Start and goal.
    pub ends: [[f64; 3]; 2],
    /// As near as this to an end the radius is enough, map units.
    pub near: f64,
}

impl Berth {
    /// The berths to try for a path between these ends, the widest first and the radius itself last: 2, 5/3, 4/3 and 1 times the
    /// radius, between 10/3 of it from the ends (0.30, 0.25, 0.20, 0.15 and 0.5 m for a radius of 0.15 m). Chosen on simulated
    /// apartments.
    pub fn widest_first(radius: f64, ends: [[f64; 3]; 2]) -> impl Iterator<Item = Berth> {
        WIDTHS.into_iter().map(move |width| Berth {
            width: width * radius,
            radius,
            ends,
            near: NEAR * radius,
        })
    }

    /// May a path with this berth have this motion? Exact for the whole sweep, as [`Space::motion_is_free`].
    #[must_use]
    pub fn allows(&self, space: &Space<'_>, a: [f64; 3], b: [f64; 3]) -> bool {
        space.motion_is_free(a, b, self.width)
            || self.is_at_an_end(a, b) && space.motion_is_free(a, b, self.radius)
    }

    /// Does the motion lie near one of the ends? A ball is convex, so its ends tell.
    fn is_at_an_end(&self, a: [f64; 3], b: [f64; 3]) -> bool {
        let near = |place, end| distance(place, end) <= self.near;
        self.ends.iter().any(|&end| near(a, end) && near(b, end))
    }
}

/// In radii.
const WIDTHS: [f64; 4] = [2.0, 5.0 / 3.0, 4.0 / 3.0, 1.0];
/// In radii.
const NEAR: f64 = 10.0 / 3.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ObstacleConfig, ObstacleSet};
    use rand::SeedableRng;

    /// Two posts that leave a gap of this width at x = 3.
    fn gap(width: f64) -> ObstacleSet {
        let posts = [[3.0, -0.5 * width, 0.0], [3.0, 0.5 * width, 0.0]];
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        ObstacleSet::from_points(&posts, &ObstacleConfig::with_clusters(2), &mut rng).unwrap()
    }

    #[test]
    fn the_widest_berth_that_fits_is_found_first() {
        let ends = [[0.0; 3], [6.0, 0.0, 0.0]];
        for (gap_width, expected) in [
            (0.62, Some(0.3)),
            (0.52, Some(0.25)),
            (0.42, Some(0.2)),
            (0.32, Some(0.15)),
            (0.28, None),
        ] {
            let hulls = gap(gap_width);
            let space = Space::Hulls(&hulls);
            let fits = |berth: &Berth| berth.allows(&space, ends[0], ends[1]);
            let found = Berth::widest_first(0.15, ends).find(fits);
            match (found.map(|berth| berth.width), expected) {
                (Some(width), Some(expected)) => assert!((width - expected).abs() < 1e-12),
                (found, expected) => assert_eq!(found, expected),
            }
        }
    }

    #[test]
    fn near_the_ends_the_radius_is_enough() {
        let hulls = gap(0.4);
        let space = Space::Hulls(&hulls);
        // The gap lies 0.4 m, then 0.6 m from the end of the path.
        for (end, allowed) in [(3.4, true), (3.6, false)] {
            let ends = [[0.0; 3], [end, 0.0, 0.0]];
            let berth = Berth::widest_first(0.15, ends).next().unwrap();
            let passes = berth.allows(&space, [2.95, 0.0, 0.0], [3.05, 0.0, 0.0]);
            assert_eq!(passes, allowed);
            // A motion that leads there from farther away is none near the end.
            assert!(!berth.allows(&space, [1.0, 0.0, 0.0], ends[1]));
        }
        // One end near the start and one near the goal is not near an end.
        let ends = [[2.8, 0.0, 0.0], [3.9, 0.0, 0.0]];
        let berth = Berth::widest_first(0.15, ends).next().unwrap();
        assert!(!berth.allows(&space, ends[0], ends[1]));
    }

    #[test]
    fn what_is_not_finite_is_not_allowed() {
        let hulls = gap(1.0);
        let space = Space::Hulls(&hulls);
        for berth in Berth::widest_first(f64::NAN, [[0.0; 3]; 2]) {
            assert!(!berth.allows(&space, [0.0; 3], [1.0, 0.0, 0.0]));
        }
        for berth in Berth::widest_first(0.1, [[f64::NAN; 3]; 2]) {
            assert!(!berth.allows(&space, [f64::INFINITY, 0.0, 0.0], [0.0; 3]));
        }
    }
}
