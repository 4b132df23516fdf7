//! A line of sight: a keyframe and a point that it sees.

use crate::point::{PointLike, is_finite};

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

    pub(crate) fn is_finite(&self) -> bool {
        is_finite(self.origin) && is_finite(self.end)
    }
}
