//! A line of sight: a keyframe and a point that it sees.

use crate::point::{PointLike, is_finite};
use crate::vector::sub;

/// A keyframe and a point that it sees. Rays of equal origin count as of the same keyframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the camera was.
    pub origin: [f64; 3],
    /// The point that it saw.
    pub end: [f64; 3],
}

impl Ray {
    /// Rays from one position to many points: for a map without observations, from the agent itself.
    /// They come from a single place, so use them with
    /// [`min_keyframes`](crate::FreeSpaceConfig::min_keyframes) = 1, and only to points that can be seen
    /// from there.
    pub fn from_position<P: PointLike>(
        position: [f64; 3],
        points: &[P],
    ) -> impl Iterator<Item = Ray> + '_ {
        points.iter().map(move |&point| Ray {
            origin: position,
            end: point.into(),
        })
    }

    /// A coarse direction, by which rays can be sorted.
    pub(super) fn sector(&self) -> (i32, i32) {
        let [x, y, z] = sub(self.end, self.origin);
        let level = x.hypot(y);
        ((24.0 * y.atan2(x)) as i32, (24.0 * z.atan2(level)) as i32)
    }

    pub(crate) fn is_finite(&self) -> bool {
        is_finite(self.origin) && is_finite(self.end)
    }
}
