//! A picture of the triangles that a keyframe saw through, by which the voxels before them are found.
//!
//! Drawing the triangles once and asking for each voxel's centre which of them it lies behind or before
//! costs a few operations a voxel, however many triangles there are; following rays through them
//! visits the voxels near the camera again and again.

use super::config::FreeSpaceConfig;
use super::evidence::PointId;
use crate::vector::{Vec3, cross, dot, max, min, norm, norm_squared, orthogonal, sub};

/// Stereographic projection around a direction: the whole sphere but its opposite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    ahead: Vec3,
    right: Vec3,
    down: Vec3,
}

impl Projection {
    pub(super) fn towards(ahead: Vec3) -> Self {
        let right = orthogonal(ahead);
        Projection {
            ahead,
            right,
            down: cross(ahead, right),
        }
    }

    /// The image of a direction of this length; the opposite of what is ahead has none.
    #[inline]
    pub(super) fn of(&self, direction: Vec3, length: f64) -> Option<[f64; 2]> {
        let from_pole = length + dot(direction, self.ahead);
        (from_pole > 1e-6 * length).then(|| {
            let inverse = 1.0 / from_pole;
            [
                dot(direction, self.right) * inverse,
                dot(direction, self.down) * inverse,
            ]
        })
    }
}

/// A triangle whose corners were seen, relative to the keyframe, and its image.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    corners: [Vec3; 3],
    image: [[f64; 2]; 3],
    points: [PointId; 3],
    /// The widest angle between the corners, radians.
    width: f64,
    /// The plane through the corners, towards the keyframe's far side: what is before it has been seen through.
    normal: Vec3,
    offset: f64,
}

impl Facet {
    /// `None` where the triangle has no area or is seen from the side.
    pub(super) fn new(
        corners: [Vec3; 3],
        image: [[f64; 2]; 3],
        points: [PointId; 3],
        width: f64,
    ) -> Option<Self> {
        let [a, b, c] = corners;
        let across = cross(sub(b, a), sub(c, a));
        let normal = if dot(across, a) < 0.0 {
            across.map(|c| -c)
        } else {
            across
        };
        let offset = dot(normal, a);
        (offset > 1e-12 * norm(normal) * norm(a)).then_some(Facet {
            corners,
            image,
            points,
            width,
            normal,
            offset,
        })
    }
}

/// What a keyframe saw a place between.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) corners: [PointId; 3],
    /// How far apart the lines of sight to the corners are there.
    pub(super) gap: f64,
}

/// A pixel's width, in voxels at the farthest corner.
const PIXEL: f64 = 0.5;
/// Images beyond this, from 152 degrees off the middle, are cut off.
const RIM: f64 = 4.0;
/// Most pixels; a picture that needs more becomes coarser.
const MOST_PIXELS: f64 = 4e6;
const NOTHING: u32 = u32::MAX;

/// The triangles seen from one place, drawn on the plane of projection.
#[derive(Debug)]
pub(super) struct Panorama {
    origin: Vec3,
    projection: Projection,
    facets: Vec<Facet>,
    low: [f64; 2],
    pixels_per_unit: f64,
    size: [usize; 2],
    /// The number of the facet at each pixel's centre.
    pixels: Vec<u32>,
}

impl Panorama {
    pub(super) fn draw(
        origin: Vec3,
        projection: Projection,
        facets: Vec<Facet>,
        config: &FreeSpaceConfig,
    ) -> Option<Self> {
        let corners = facets.iter().flat_map(|facet| facet.corners);
        let farthest = corners.map(norm_squared).fold(0.0, f64::max).sqrt();
        let (low, high) = bounds(&facets)?;
        // In the middle of the plane a unit of it is two radians.
        let wanted = 2.0 * farthest / (PIXEL * config.resolution);
        let [width, height] = [high[0] - low[0], high[1] - low[1]];
        let most = (MOST_PIXELS / (width * height).max(1e-12)).sqrt();
        let pixels_per_unit = wanted
            .min(most)
            .min(0.25 * MOST_PIXELS / width.max(height).max(1e-12));
        let size = [width, height].map(|extent| (extent * pixels_per_unit) as usize + 1);
        let mut panorama = Panorama {
            origin,
            projection,
            facets,
            low,
            pixels_per_unit,
            size,
            pixels: vec![NOTHING; size[0] * size[1]],
        };
        for number in 0..panorama.facets.len() {
            panorama.fill(number);
        }
        Some(panorama)
    }

    /// Marks the pixels whose centres lie in the image of a facet, row by row.
    fn fill(&mut self, number: usize) {
        let corners = self.facets[number].image.map(|corner| {
            [0, 1].map(|axis| (corner[axis] - self.low[axis]) * self.pixels_per_unit - 0.5)
        });
        let rows = corners.map(|corner| corner[1]);
        let first = rows
            .iter()
            .fold(f64::INFINITY, |a, &b| a.min(b))
            .ceil()
            .max(0.0);
        let last = rows.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        let last = last.floor().min(self.size[1] as f64 - 1.0);
        let mut row = first;
        while row <= last {
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            for (p, q) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
                if (p[1] <= row) != (q[1] <= row) || p[1] == row || q[1] == row {
                    let share = if p[1] == q[1] {
                        0.0
                    } else {
                        (row - p[1]) / (q[1] - p[1])
                    };
                    let at = p[0] + share.clamp(0.0, 1.0) * (q[0] - p[0]);
                    (from, to) = (from.min(at), to.max(at));
                }
            }
            let start = row as usize * self.size[0];
            let from = from.ceil().max(0.0);
            let to = to.floor().min(self.size[0] as f64 - 1.0);
            if from <= to {
                self.pixels[start + from as usize..=start + to as usize].fill(number as u32);
            }
            row += 1.0;
        }
    }

    /// A box that holds all that has been seen through.
    pub(super) fn extent(&self) -> (Vec3, Vec3) {
        let corners = self.facets.iter().flat_map(|facet| facet.corners);
        let (low, high) = corners.fold(([0.0; 3], [0.0; 3]), |(low, high), corner| {
            (min(low, corner), max(high, corner))
        });
        let place = |corner: Vec3| crate::vector::add(self.origin, corner);
        (place(low), place(high))
    }

    /// The triangle before which this place lies, as seen from the keyframe.
    #[inline]
    pub(super) fn seen_through(&self, place: Vec3) -> Option<View> {
        let direction = sub(place, self.origin);
        let length = norm(direction);
        let image = self.projection.of(direction, length)?;
        let [x, y] = [0, 1].map(|axis| (image[axis] - self.low[axis]) * self.pixels_per_unit);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (x, y) = (x as usize, y as usize);
        if x >= self.size[0] || y >= self.size[1] {
            return None;
        }
        let facet = self
            .facets
            .get(self.pixels[y * self.size[0] + x] as usize)?;
        (dot(facet.normal, direction) <= facet.offset).then_some(View {
            corners: facet.points,
            gap: facet.width * length,
        })
    }
}

/// The corners of the rectangle of all images; `None` without any.
fn bounds(facets: &[Facet]) -> Option<([f64; 2], [f64; 2])> {
    let images = facets.iter().flat_map(|facet| facet.image);
    let inside = images.map(|image| image.map(|c| c.clamp(-RIM, RIM)));
    inside.fold(None, |bounds, image| {
        let (low, high) = bounds.unwrap_or((image, image));
        Some((
            [low[0].min(image[0]), low[1].min(image[1])],
            [high[0].max(image[0]), high[1].max(image[1])],
        ))
    })
}
