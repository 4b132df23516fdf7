//! What the observations count for: one set of weights for each way that a map comes by its depths.
//!
//! A camera that triangulates errs along its rays, where the point leaves its image neighbours: what they say
//! counts most. A depth camera's points lie where it measured them, edges and all, so that image neighbours
//! rightly disagree; wrong are points beyond its reach, and those that have been triangulated after all.

use super::sight::Sight;

/// Whether points were triangulated or their depth was measured, in [`Reading::Ranged`](super::Reading::Ranged).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum DepthSource {
    /// As the observations tell. A point that a single camera position sees cannot have been triangulated: where
    /// one observed point in fifty is such, depths were measured. Shares found: none on fourteen maps of a single camera,
    /// 4 to 25 % on thirty-one of depth cameras. If all that is known is one position, neither is assumed.
    Observed,
    /// By a single moving camera.
    Triangulated,
    /// By a depth camera, or a stereo pair.
    Measured,
}

/// Weights of the cues in [`Reading::Ranged`](super::Reading::Ranged); an exponent of 0 switches a cue off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cues {
    /// Distances are divided by (r(u) r(v)) to half this power, at least 0. 0 is the Euclidean distance, 1
    /// makes it an angle.
    pub range_exponent: f64,
    /// Exponent of (depth disagreement with the wider image neighbours + 0.02), at least 0.
    pub depth_exponent: f64,
    /// Which those are.
    pub depth_neighbours: ImageNeighbours,
    /// Exponent of (depth disagreement with the nearest image neighbours + 0.02), at least 0.
    pub near_depth_exponent: f64,
    /// Exponent of (1 + violations), at least 0.
    pub violation_exponent: f64,
    /// Exponent of the range over the median range, at least 0.
    pub far_exponent: f64,
    /// Exponent of (the angle in radians between the directions that a point is seen from + 0.005), at least 0.
    pub parallax_exponent: f64,
    /// Exponent of the largest distance from which a feature can be recognised over its point's range
    /// ([`Views::with_max_distances`](crate::Views::with_max_distances)), at least 0; where unknown the median counts.
    pub coarseness_exponent: f64,
    /// Exponent of (1 + hiding rays), at least 0: of cameras that do not see the point, the rays that pass it
    /// and end well before it.
    pub hidden_exponent: f64,
    /// How many times the median badness is kept.
    pub tolerance: Tolerance,
}

/// The wider image neighbours that a point's depth is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageNeighbours {
    /// How many there are, at least 12.
    pub count: usize,
    /// Of their disagreements in ascending order the one that counts, from 1 to `count`.
    pub rank: usize,
    /// What counts of the disagreements in up to three cameras.
    pub cameras: AmongCameras,
}

/// What counts of what several cameras say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AmongCameras {
    /// The median: a point must disagree in most pictures.
    Median,
    /// The largest: a wrong point may happen to lie before what it resembles, but not in all pictures.
    Largest,
}

impl ImageNeighbours {
    /// The tenth of 20, the median of the cameras'.
    #[must_use]
    pub fn half_of_twenty() -> Self {
        Self {
            count: 20,
            rank: 10,
            cameras: AmongCameras::Median,
        }
    }
}

/// How many times the median badness a point may have.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Tolerance {
    /// This many times, above 0.
    Fixed(f64),
    /// As the spread of the badness tells: the exponential of this, above 0, times ln(ninth decile / median)^0.7; between
    /// e and e³ times. Maps whose good points differ more are cut later, if not quite by as much.
    BySpread(f64),
    /// As the map's own dirt tells: exp(0.08 / q), where q is the disagreement in depth with the
    /// nearest image neighbours that one point in ten exceeds; at least this many times, above 0, and at most 9 times.
    ByDirt {
        /// The least.
        least: f64,
    },
}

impl Cues {
    /// The default where all that is known is one position: [`Cues::one_position`], but at least 3.3 times.
    #[must_use]
    pub fn from_position() -> Self {
        Self {
            tolerance: Tolerance::ByDirt { least: 3.3 },
            ..Self::one_position()
        }
    }

    /// Where all that is known is one position and little may be left that is wrong: 0.8, 0.25, 0.15, 0.1, 0, 0, 0, 0, as the
    /// dirt tells and at least 2.46 times.
    #[must_use]
    pub fn one_position() -> Self {
        Self {
            range_exponent: 0.8,
            depth_exponent: 0.25,
            depth_neighbours: ImageNeighbours::half_of_twenty(),
            near_depth_exponent: 0.15,
            violation_exponent: 0.1,
            far_exponent: 0.0,
            parallax_exponent: 0.0,
            coarseness_exponent: 0.0,
            hidden_exponent: 0.0,
            tolerance: Tolerance::ByDirt { least: 2.46 },
        }
    }

    /// For triangulated points: 1, 1 (the 28th of 40 neighbours, the largest of the cameras'), 0.5, 0.6, 0, 0, 0, 0, 10 times.
    #[must_use]
    pub fn triangulated() -> Self {
        Self {
            range_exponent: 1.0,
            depth_exponent: 1.0,
            depth_neighbours: ImageNeighbours {
                count: 40,
                rank: 28,
                cameras: AmongCameras::Largest,
            },
            near_depth_exponent: 0.5,
            violation_exponent: 0.6,
            far_exponent: 0.0,
            parallax_exponent: 0.0,
            coarseness_exponent: 0.0,
            hidden_exponent: 0.0,
            tolerance: Tolerance::Fixed(10.0),
        }
    }

    /// For measured depths: 0.8, 0, 0.2, 0.2, 0.1, 0.3, 0.5, 0.1, as the spread tells with 2.
    #[must_use]
    pub fn measured() -> Self {
        Self {
            range_exponent: 0.8,
            depth_exponent: 0.0,
            depth_neighbours: ImageNeighbours::half_of_twenty(),
            near_depth_exponent: 0.2,
            violation_exponent: 0.2,
            far_exponent: 0.1,
            parallax_exponent: 0.3,
            coarseness_exponent: 0.5,
            hidden_exponent: 0.1,
            tolerance: Tolerance::BySpread(2.0),
        }
    }

    /// Every field that is a number of at least 0, with its name.
    pub(super) fn exponents(&self) -> [(&'static str, f64); 8] {
        [
            ("range_exponent", self.range_exponent),
            ("depth_exponent", self.depth_exponent),
            ("near_depth_exponent", self.near_depth_exponent),
            ("violation_exponent", self.violation_exponent),
            ("far_exponent", self.far_exponent),
            ("parallax_exponent", self.parallax_exponent),
            ("coarseness_exponent", self.coarseness_exponent),
            ("hidden_exponent", self.hidden_exponent),
        ]
    }
}

/// How the points of a map got their depths; `None` if all were seen from one position.
pub(super) fn told(sight: &Sight<'_>) -> Option<DepthSource> {
    let cameras = sight.seen.iter().filter(|seen| !seen.is_empty());
    if cameras.count() < 2 {
        return None;
    }
    let observers = (0..sight.views.points()).map(|v| sight.views.row(v).len());
    let (mut observed, mut once) = (0, 0);
    for count in observers {
        observed += usize::from(count > 0);
        once += usize::from(count == 1);
    }
    Some(if once * LEAST_MEASURED >= observed {
        DepthSource::Measured
    } else {
        DepthSource::Triangulated
    })
}

/// One point in this many, seen once, shows that depths were measured.
const LEAST_MEASURED: usize = 50;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_lie_within_the_image_neighbours() {
        let good = |(count, rank): (usize, usize)| {
            (12..=40).contains(&count) && (1..=count).contains(&rank)
        };
        for (count, rank) in [(40, 40), (12, 1), (40, 41), (40, 0), (11, 3)] {
            let mut cues = Cues::triangulated();
            (cues.depth_neighbours.count, cues.depth_neighbours.rank) = (count, rank);
            assert_eq!(
                cues.validate().is_ok(),
                good((count, rank)),
                "{rank} of {count}"
            );
        }
    }
}
