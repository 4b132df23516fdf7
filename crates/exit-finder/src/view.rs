//! What is known beside the points: heading, where the camera looked, and closed doors.

use crate::angle::turn;
use crate::plane::AffinePlane;
use crate::vector::{add, is_finite, scale, sub};

/// Optional knowledge of the caller. `Default` is: none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ExitView<'a> {
    /// Where the agent's nose points, a world direction. Breaks ties: the smallest turn wins.
    pub heading: Option<[f64; 3]>,
    /// Where the camera looked from near the agent. Empty: unknown, then wide empty sectors are
    /// taken as unseen.
    pub gazes: &'a [Gaze],
    /// Points that close openings already used ([`crate::sites::SiteGraph::virtual_points`]): they
    /// count at any height and hide what was seen behind them. They take part in the
    /// search and nowhere else; they count neither for `min_points` nor for the mean range.
    pub virtual_points: &'a [[f64; 3]],
    /// What a cleaning took out of the map. These points are looked at too, so that no far point behind a door is lost,
    /// but what is seen mostly by them is believed less; see [`crate::RangeProfile::of_cleaned`]. Where `rays` are given too, the search
    /// looks once more among the kept points alone and judges what it finds by both looks.
    pub doubtful: &'a [[f64; 3]],
    /// Which keyframe saw which point, kept or doubtful. Rays to one point follow one another. Where there are
    /// no gazes, they tell what was looked at. Empty: not known.
    pub rays: &'a [Ray],
}

/// A line of sight: a keyframe observed a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Camera centre of the keyframe, world.
    pub origin: [f64; 3],
    /// The point, world.
    pub end: [f64; 3],
}

/// One look of the camera, for example of a keyframe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaze {
    /// Camera centre, world.
    pub position: [f64; 3],
    /// Viewing direction, world, any length.
    pub forward: [f64; 3],
    /// Half the horizontal field of view, radians.
    pub half_fov_rad: f64,
}

impl Gaze {
    /// Whether the camera looked at the place `range` away from the agent in a bearing, in plan.
    pub(crate) fn covers(
        &self,
        plane: &AffinePlane,
        agent: [f64; 3],
        bearing: f64,
        range: f64,
    ) -> bool {
        if !is_finite(self.position) || !self.half_fov_rad.is_finite() {
            return false;
        }
        let target = add(
            agent,
            scale(plane.direction([bearing.cos(), bearing.sin()]), range),
        );
        let (Some(looks), Some(lies)) = (
            plane.bearing(self.forward),
            plane.bearing(sub(target, self.position)),
        ) else {
            return false;
        };
        turn(looks, lies).abs() <= self.half_fov_rad
    }
}
