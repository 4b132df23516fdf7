//! An opening in a stack of height bands: a door, an opening above a counter, a staircase.
//!
//! Input: the points and an exit of a report. Output: per band whether the sector is open there, and the
//! shape that follows:
//!
//! ```text
//! door      every band below the flying height that was seen is open
//! raised    some band below it is closed at the line between the jambs: a window, a counter
//! stairs    the range grows from band to band, upwards, over three bands or more
//! ```

use crate::angle::turn;
use crate::exit::{Exit, ExitReport};
use crate::points::PointLike;
use crate::profile::{Edges, PointCounts, median};
use crate::vector::{is_finite, sub};

/// Points a band needs in the middle of the sector to be called open or closed.
const MIN_POINTS: usize = 3;
/// Ratio of a point's range to the line between the jambs from which it lies beyond.
const BEYOND: f64 = 1.15;
/// Growth of the median range from one band to the next that makes a step.
const STEP: f64 = 1.1;

/// What one band shows in the sector of an exit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandReading {
    /// The heights above the agent, map units along the plane's normal.
    pub heights: [f64; 2],
    /// Points seen.
    pub points: usize,
    /// Their median range, if any.
    pub range: Option<f64>,
    /// Whether one sees through.
    pub state: BandState,
}

/// Whether one sees through a band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BandState {
    /// Seven tenths of the points lie behind the line between the jambs.
    Open,
    /// At most three tenths do.
    Closed,
    /// Neither, or fewer than three points.
    Unknown,
}

/// What kind of opening it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Open down to the lowest band seen.
    Door,
    /// Closed below: a window, a hatch, the space above a counter.
    Raised,
    /// Rises away from the agent.
    Stairs,
    /// Nothing below the flying height was seen.
    Unknown,
}

/// An exit in a stack of bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Readings, in the order of the bands given.
    pub bands: Vec<BandReading>,
    /// What follows.
    pub shape: Shape,
}

impl Exit {
    /// Reads the middle of this exit's sector in bands of heights above the agent, given from low to high. The
    /// tilt of the report's strip is taken off the heights. O(points · bands).
    ///
    /// Broken points are skipped; an empty stack has [`Shape::Unknown`].
    pub fn passage<P: PointLike>(
        &self,
        points: &[P],
        report: &ExitReport,
        bands: &[[f64; 2]],
    ) -> Passage {
        let seen = self.points_in_sector(points, report);
        let bands: Vec<BandReading> = bands
            .iter()
            .map(|&heights| self.read(heights, &seen))
            .collect();
        let shape = shape_of(&bands);
        Passage { bands, shape }
    }

    /// (height, range / chord, range) of the points in the sector.
    fn points_in_sector<P: PointLike>(
        &self,
        points: &[P],
        report: &ExitReport,
    ) -> Vec<(f64, f64, f64)> {
        let (plane, strip) = (&report.profile.plane, &report.profile.strip);
        let Ok(eye) = crate::profile::Eye::new(report.profile.agent, plane) else {
            return Vec::new();
        };
        let [p, q] = self
            .jambs
            .map(|jamb| plane.project(sub(jamb, report.profile.agent)));
        let origin = plane.project([0.0; 3]);
        let chord = crate::rule::Line::through(
            [p[0] - origin[0], p[1] - origin[1]],
            [q[0] - origin[0], q[1] - origin[1]],
        );
        let mut ignored = PointCounts::default();
        let edges = Edges::new(report.profile.bins.len());
        let mut seen = Vec::new();
        for &point in points {
            let point: [f64; 3] = point.into();
            let Some(polar) = eye
                .look(point, &edges, &mut ignored)
                .filter(|_| is_finite(point))
            else {
                continue;
            };
            let [cos, sin] = polar.offset.map(|x| x / polar.range);
            // The outer tenths may still show the jambs.
            if turn(self.bearing_rad, sin.atan2(cos)).abs() < 0.4 * self.width_rad {
                let wall = chord.map_or(1.0 / self.range, |line| line.inverse_range([cos, sin]));
                let lean = strip.tilt[0] * cos + strip.tilt[1] * sin;
                seen.push((
                    polar.height - polar.range * lean,
                    polar.range * wall,
                    polar.range,
                ));
            }
        }
        seen
    }

    fn read(&self, heights: [f64; 2], seen: &[(f64, f64, f64)]) -> BandReading {
        let inside = || {
            seen.iter()
                .filter(|p| p.0 >= heights[0] && p.0 < heights[1])
        };
        let points = inside().count();
        let share = inside().filter(|p| p.1 > BEYOND).count() as f64 / points.max(1) as f64;
        let state = match share {
            _ if points < MIN_POINTS => BandState::Unknown,
            share if share >= 0.7 => BandState::Open,
            share if share <= 0.3 => BandState::Closed,
            _ => BandState::Unknown,
        };
        let range = median(&mut inside().map(|p| p.2).collect::<Vec<_>>());
        BandReading {
            heights,
            points,
            range,
            state,
        }
    }
}

fn shape_of(bands: &[BandReading]) -> Shape {
    let steps: Vec<f64> = bands
        .iter()
        .filter(|b| b.points >= MIN_POINTS)
        .filter_map(|b| b.range)
        .collect();
    if steps.len() >= 3 && steps.windows(2).all(|pair| pair[1] > STEP * pair[0]) {
        return Shape::Stairs;
    }
    let below = || bands.iter().filter(|b| b.heights[1] <= 0.0);
    if below().any(|b| b.state == BandState::Closed) {
        Shape::Raised
    } else if below().any(|b| b.state == BandState::Open) {
        Shape::Door
    } else {
        Shape::Unknown
    }
}
