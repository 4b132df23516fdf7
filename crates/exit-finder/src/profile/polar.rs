//! Points as the agent sees them: bin, range and height.

use super::PointCounts;
use super::edges::Edges;
use crate::error::ExitError;
use crate::plane::AffinePlane;
use crate::points::PointLike;
use crate::vector::is_finite;

/// A point as the agent sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Polar {
    /// Offset from the agent in plane coordinates.
    pub(crate) offset: [f64; 2],
    pub(crate) range: f64,
    /// Above the agent, along the plane's normal.
    pub(crate) height: f64,
    pub(crate) bin: u32,
}

/// The agent as the centre of bearings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Eye {
    plane: AffinePlane,
    centre: [f64; 2],
    height: f64,
}

impl Eye {
    pub(crate) fn new(agent: [f64; 3], plane: &AffinePlane) -> Result<Self, ExitError> {
        if !is_finite(agent) {
            return Err(ExitError::Agent { position: agent });
        }
        Ok(Self {
            plane: *plane,
            centre: plane.project(agent),
            height: plane.height(agent),
        })
    }

    /// Distance of a point from the plane's origin, in plane coordinates.
    pub(crate) fn distance_from_origin(&self, point: [f64; 3]) -> f64 {
        let (offset, _) = self.offset(point);
        (self.centre[0] + offset[0]).hypot(self.centre[1] + offset[1])
    }

    /// Offset from the agent in plane coordinates, and height above it.
    #[inline]
    pub(crate) fn offset(&self, point: [f64; 3]) -> ([f64; 2], f64) {
        let q = self.plane.project(point);
        let height = self.plane.height(point) - self.height;
        ([q[0] - self.centre[0], q[1] - self.centre[1]], height)
    }

    /// A point in one of the bins; counts it in `counts` when it has no bearing.
    #[inline]
    pub(crate) fn look(
        &self,
        point: [f64; 3],
        edges: &Edges,
        counts: &mut PointCounts,
    ) -> Option<Polar> {
        let ([dx, dy], height) = self.offset(point);
        let squared = dx * dx + dy * dy;
        if !(squared + height.abs()).is_finite() {
            counts.non_finite += 1;
            return None;
        }
        if squared <= 0.0 {
            counts.at_agent += 1;
            return None;
        }
        Some(Polar {
            offset: [dx, dy],
            range: squared.sqrt(),
            height,
            bin: edges.bin_of([dx, dy]) as u32,
        })
    }
}

/// Points that are looked at together.
pub(crate) const BLOCK: usize = 64;

/// Offsets of several points, coordinate by coordinate, so that the compiler computes some of them at once. To the last bit what
/// [`Eye::look`] says of each.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) x: [f64; BLOCK],
    pub(crate) y: [f64; BLOCK],
    pub(crate) height: [f64; BLOCK],
    pub(crate) range: [f64; BLOCK],
    pub(crate) slope: [f64; BLOCK],
    squared: [f64; BLOCK],
}

impl Default for Block {
    fn default() -> Self {
        let zero = [0.0; BLOCK];
        Self {
            x: zero,
            y: zero,
            height: zero,
            range: zero,
            slope: zero,
            squared: zero,
        }
    }
}

impl Block {
    /// Offsets and heights of up to [`BLOCK`] points.
    pub(crate) fn place<P: PointLike>(&mut self, eye: &Eye, points: &[P]) {
        let slots = self.x.iter_mut().zip(&mut self.y).zip(&mut self.height);
        for (((x, y), height), &point) in slots.zip(points) {
            ([*x, *y], *height) = eye.offset(point.into());
        }
    }

    /// The same, their ranges and slopes.
    pub(crate) fn look<P: PointLike>(&mut self, eye: &Eye, points: &[P]) {
        self.place(eye, points);
        for k in 0..BLOCK {
            self.squared[k] = self.x[k] * self.x[k] + self.y[k] * self.y[k];
            self.range[k] = self.squared[k].sqrt();
            self.slope[k] = self.height[k] / self.range[k];
        }
    }

    /// Whether a point has a bearing; counts it in `counts` when not.
    #[inline]
    pub(crate) fn has_bearing(&self, k: usize, counts: &mut PointCounts) -> bool {
        let squared = self.squared[k];
        if !(squared + self.height[k].abs()).is_finite() {
            counts.non_finite += 1;
            return false;
        }
        counts.at_agent += usize::from(squared <= 0.0);
        squared > 0.0
    }
}
