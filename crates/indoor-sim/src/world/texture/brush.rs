//! Puts landmarks on faces and edges, and drops those that nobody could see.

use rand::{Rng, RngExt};

use super::Painter;
use super::face::Face;
use crate::random::uniform;
use crate::world::floor_plan::Room;
use crate::world::landmark::Landmark;
use crate::world::solid::{Solid, SolidKind};

/// Widest angle between a surface's normal and the direction to the camera, degrees: beyond it a patch is too foreshortened.
const GRAZING_DEGREES: f64 = 75.0;

/// Ratio between the farthest and the nearest distance at which a corner keeps its look: seven steps of an image
/// pyramid with factor 1.2, as ORB-SLAM builds it.
const SCALE_BAND: f64 = 3.583;

/// An edge is seen from everywhere outside of the two faces that meet in it: within 135 degrees less a margin.
const EDGE_LEAST_COSINE: f64 = -0.5;

/// A straight edge of a box: it runs along one axis through `corner`.
struct Edge {
    solid: usize,
    along: usize,
    corner: [f64; 3],
    normal: [f64; 3],
}

impl<R: Rng> Painter<'_, R> {
    /// Landmarks at random on a part of a face.
    pub(super) fn scatter(&mut self, face: &Face, density: f64) {
        let area = (face.high[0] - face.low[0]) * (face.high[1] - face.low[1]);
        let count = self.whole(area * density);
        let least_cosine = GRAZING_DEGREES.to_radians().cos();
        for _ in 0..count {
            let uv = [
                uniform(self.rng, face.low[0], face.high[0]),
                uniform(self.rng, face.low[1], face.high[1]),
            ];
            self.place(face.point(uv), face.normal(), least_cosine, face.solid, 0.0);
        }
    }

    /// The edges of a box that can be seen: vertical ones, the lower ones of lintels and the upper ones of furniture.
    pub(super) fn paint_edges(&mut self, index: usize, solid: &Solid) {
        for along in 0..3 {
            for sides in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
                if is_bare(solid, along, sides) {
                    self.paint_edge(solid, &edge(index, solid, along, sides));
                }
            }
        }
    }

    fn paint_edge(&mut self, solid: &Solid, edge: &Edge) {
        let (low, high) = (solid.min[edge.along], solid.max[edge.along]);
        let vivid = uniform(self.rng, 0.3, 1.7);
        for _ in 0..self.whole((high - low) * self.config.edge * vivid) {
            let mut position = edge.corner;
            position[edge.along] = uniform(self.rng, low, high);
            self.place(position, edge.normal, EDGE_LEAST_COSINE, edge.solid, 0.15);
        }
    }

    /// Adds a landmark unless it is buried in another solid or faces no room.
    fn place(
        &mut self,
        position: [f64; 3],
        normal: [f64; 3],
        least_cosine: f64,
        solid: usize,
        bonus: f64,
    ) {
        let strength = (self.rng.random::<f64>() + bonus).min(1.0);
        let far = 1.2 * (2.3 * self.rng.random::<f64>()).exp();
        let outside: [f64; 3] = core::array::from_fn(|axis| position[axis] + 0.01 * normal[axis]);
        let buried = self
            .solids
            .iter()
            .enumerate()
            .any(|(number, other)| number != solid && other.contains(outside));
        if buried || !self.faces_a_room(outside) {
            return;
        }
        let near = far / SCALE_BAND;
        self.landmarks.push(Landmark {
            position,
            normal,
            least_cosine,
            strength,
            near,
            far,
        });
    }

    fn faces_a_room(&self, point: [f64; 3]) -> bool {
        point[2] > 0.0
            && point[2] < self.plan.height
            && self.plan.rooms.iter().any(|room| contains(room, point))
    }

    /// A whole number with the given mean.
    fn whole(&mut self, mean: f64) -> usize {
        let part = self.rng.random::<f64>();
        (mean.clamp(0.0, 1e6) + part).floor() as usize
    }
}

/// The edge along an axis on these sides (±1) of the two others.
fn edge(solid_index: usize, solid: &Solid, along: usize, sides: [f64; 2]) -> Edge {
    let mut edge = Edge {
        solid: solid_index,
        along,
        corner: [0.0; 3],
        normal: [0.0; 3],
    };
    for (offset, side) in sides.into_iter().enumerate() {
        let axis = (along + 1 + offset) % 3;
        edge.corner[axis] = if side < 0.0 {
            solid.min[axis]
        } else {
            solid.max[axis]
        };
        edge.normal[axis] = side * core::f64::consts::FRAC_1_SQRT_2;
    }
    edge
}

/// Whether an edge does not lie on the floor or at the ceiling.
fn is_bare(solid: &Solid, along: usize, sides: [f64; 2]) -> bool {
    let side_of_height = match along {
        0 => sides[1],
        1 => sides[0],
        _ => return true,
    };
    match solid.kind {
        SolidKind::Furniture => side_of_height > 0.0,
        SolidKind::Lintel => side_of_height < 0.0,
        _ => false,
    }
}

/// Whether the point is in the room or above or below it.
pub(super) fn contains(room: &Room, point: [f64; 3]) -> bool {
    (0..2).all(|axis| room.min[axis] <= point[axis] && point[axis] <= room.max[axis])
}
