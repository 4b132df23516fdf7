//! Paints the surfaces of a world: textured patches, edges, a thin background, and blank walls that carry nothing.

use rand::{Rng, RngExt};

use super::floor_plan::{FloorPlan, Room};
use super::landmark::Landmark;
use super::solid::{Solid, SolidKind};
use crate::random::uniform;

/// Densities of the paint. Calibrated against real maps (see the crate's documentation), not measured on surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureConfig {
    /// Share of wall panels (pieces of a wall 1 m wide and half as high as the room) without any texture, 0..=0.5.
    pub blank_share: f64,
    /// Landmarks per square metre on panels that are not blank, outside of patches.
    pub background: f64,
    /// Landmarks per square metre on textured patches (shelves, pictures, windows with a view).
    pub patch: f64,
    /// Landmarks per square metre on furniture.
    pub furniture: f64,
    /// Landmarks per square metre on the floor.
    pub floor: f64,
    /// Landmarks per square metre on the ceiling.
    pub ceiling: f64,
    /// Landmarks per metre on edges of furniture and door frames.
    pub edge: f64,
}

impl Default for TextureConfig {
    fn default() -> Self {
        Self {
            blank_share: 0.42,
            background: 140.0,
            patch: 1000.0,
            furniture: 450.0,
            floor: 25.0,
            ceiling: 5.0,
            edge: 50.0,
        }
    }
}

/// Where the upper row of panels begins, relative to the height of the room.
const ROW_BORDER: f64 = 0.5;

/// Greatest width of a panel, metres.
const PANEL: f64 = 1.05;

/// Widest angle between a surface's normal and the direction to the camera, degrees: beyond it a patch is too foreshortened.
const GRAZING_DEGREES: f64 = 75.0;

/// Ratio between the farthest and the nearest distance at which a corner keeps its look: seven steps of an image
/// pyramid with factor 1.2, as ORB-SLAM builds it.
const SCALE_BAND: f64 = 3.583;

/// Landmarks of all surfaces that face a room.
pub(crate) fn paint(
    plan: &FloorPlan,
    solids: &[Solid],
    config: &TextureConfig,
    rng: &mut impl Rng,
) -> Vec<Landmark> {
    let mut painter = Painter {
        plan,
        solids,
        config,
        rng,
        landmarks: Vec::new(),
    };
    for (index, solid) in solids.iter().enumerate() {
        painter.paint_solid(index, solid);
    }
    painter.landmarks
}

struct Painter<'a, R> {
    plan: &'a FloorPlan,
    solids: &'a [Solid],
    config: &'a TextureConfig,
    rng: &'a mut R,
    landmarks: Vec<Landmark>,
}

/// One side of a solid: its fixed axis and value, and the ranges of the two others.
#[derive(Clone, Copy)]
struct Face {
    solid: usize,
    axis: usize,
    outward: f64,
    value: f64,
    low: [f64; 2],
    high: [f64; 2],
}

impl Face {
    fn axes(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    fn point(&self, uv: [f64; 2]) -> [f64; 3] {
        let mut point = [0.0; 3];
        let [u, v] = self.axes();
        point[self.axis] = self.value;
        point[u] = uv[0];
        point[v] = uv[1];
        point
    }

    fn normal(&self) -> [f64; 3] {
        let mut normal = [0.0; 3];
        normal[self.axis] = self.outward;
        normal
    }

    /// The part of the face with these ranges.
    fn part(&self, low: [f64; 2], high: [f64; 2]) -> Self {
        Self { low, high, ..*self }
    }
}

impl<R: Rng> Painter<'_, R> {
    fn paint_solid(&mut self, index: usize, solid: &Solid) {
        for axis in 0..3 {
            for outward in [-1.0, 1.0] {
                let face = face_of(index, solid, axis, outward);
                match solid.kind {
                    SolidKind::Floor if axis == 2 && outward > 0.0 => {
                        self.paint_by_room(&face, self.config.floor);
                    }
                    SolidKind::Ceiling if axis == 2 && outward < 0.0 => {
                        self.paint_by_room(&face, self.config.ceiling);
                    }
                    SolidKind::Wall | SolidKind::Lintel if axis != 2 => self.paint_wall(&face),
                    SolidKind::Furniture => self.paint_furniture(&face),
                    _ => {}
                }
            }
        }
        if matches!(
            solid.kind,
            SolidKind::Wall | SolidKind::Lintel | SolidKind::Furniture
        ) {
            self.paint_edges(index, solid);
        }
    }

    /// A wall: an upper and a lower row of panels, each panel blank or with a background and a patch.
    fn paint_wall(&mut self, face: &Face) {
        let vertical = usize::from(face.axes()[1] == 2);
        let [bottom, top] = [face.low[vertical], face.high[vertical]];
        let middle = self.plan.height * ROW_BORDER;
        for (from, to) in [(bottom, middle.min(top)), (middle.max(bottom), top)] {
            if to > from {
                let (mut low, mut high) = (face.low, face.high);
                (low[vertical], high[vertical]) = (from, to);
                self.paint_row(&face.part(low, high), 1 - vertical);
            }
        }
    }

    /// A row of panels; blank ones never stand side by side: people hang something on an empty wall.
    fn paint_row(&mut self, row: &Face, horizontal: usize) {
        let length = row.high[horizontal] - row.low[horizontal];
        let panels = (length / PANEL).ceil().max(1.0);
        let mut blank = false;
        for number in 0..panels as usize {
            let (mut low, mut high) = (row.low, row.high);
            low[horizontal] = row.low[horizontal] + length * number as f64 / panels;
            high[horizontal] = row.low[horizontal] + length * (number + 1) as f64 / panels;
            // The chance after a textured panel is such that the share comes out as asked.
            let chance = if blank {
                0.0
            } else {
                odds(self.config.blank_share)
            };
            blank = self.rng.random::<f64>() < chance;
            if !blank {
                let panel = row.part(low, high);
                let vivid = uniform(self.rng, 0.6, 1.4) * self.room_texture(&panel);
                self.scatter(&panel, self.config.background * vivid);
                self.paint_patch(&panel, horizontal, vivid);
            }
        }
    }

    /// Texture of the room that a panel faces; 1 when it faces none.
    fn room_texture(&self, panel: &Face) -> f64 {
        let mut middle = panel.point([0, 1].map(|side| 0.5 * (panel.low[side] + panel.high[side])));
        middle[panel.axis] += 0.05 * panel.outward;
        let faced = self
            .plan
            .rooms
            .iter()
            .find(|room| room_contains(room, middle));
        faced.map_or(1.0, |room| room.texture)
    }

    /// A picture, a shelf or a window somewhere on a panel.
    fn paint_patch(&mut self, panel: &Face, horizontal: usize, vivid: f64) {
        let vertical = 1 - horizontal;
        let size = [uniform(self.rng, 0.3, 0.9), uniform(self.rng, 0.3, 0.9)];
        let (mut low, mut high) = (panel.low, panel.high);
        for (axis, size) in [(horizontal, size[0]), (vertical, size[1])] {
            let room = panel.high[axis] - panel.low[axis];
            let size = size.min(room);
            low[axis] = panel.low[axis] + uniform(self.rng, 0.0, room - size);
            high[axis] = low[axis] + size;
        }
        self.scatter(&panel.part(low, high), self.config.patch * vivid);
    }

    fn paint_furniture(&mut self, face: &Face) {
        let number = self.solids[..face.solid]
            .iter()
            .filter(|solid| solid.kind == SolidKind::Furniture)
            .count();
        let texture = self
            .plan
            .furniture
            .get(number)
            .map_or(1.0, |item| item.texture);
        let vivid = uniform(self.rng, 0.1, 1.9);
        self.scatter(face, self.config.furniture * vivid * texture);
    }

    fn paint_by_room(&mut self, face: &Face, density: f64) {
        for room in &self.plan.rooms {
            let [u, v] = face.axes();
            let vivid = uniform(self.rng, 0.3, 1.7) * room.texture;
            let part = face.part([room.min[u], room.min[v]], [room.max[u], room.max[v]]);
            self.scatter(&part, density * vivid);
        }
    }

    /// Landmarks at random on a part of a face.
    fn scatter(&mut self, face: &Face, density: f64) {
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

    /// The edges of a box: vertical ones and, for furniture, the upper ones.
    fn paint_edges(&mut self, index: usize, solid: &Solid) {
        for along in 0..3 {
            for (side_a, side_b) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let [a, b] = [(along + 1) % 3, (along + 2) % 3];
                let lowest = (a == 2 && side_a < 0.0) || (b == 2 && side_b < 0.0);
                let wall_top = solid.kind != SolidKind::Furniture
                    && along != 2
                    && ((a == 2 && side_a > 0.0) || (b == 2 && side_b > 0.0));
                if wall_top || (lowest && solid.kind != SolidKind::Lintel) {
                    continue;
                }
                let mut corner = [0.0; 3];
                corner[a] = if side_a < 0.0 {
                    solid.min[a]
                } else {
                    solid.max[a]
                };
                corner[b] = if side_b < 0.0 {
                    solid.min[b]
                } else {
                    solid.max[b]
                };
                let mut normal = [0.0; 3];
                normal[a] = side_a * core::f64::consts::FRAC_1_SQRT_2;
                normal[b] = side_b * core::f64::consts::FRAC_1_SQRT_2;
                self.paint_edge(index, solid, along, corner, normal);
            }
        }
    }

    fn paint_edge(
        &mut self,
        index: usize,
        solid: &Solid,
        along: usize,
        corner: [f64; 3],
        normal: [f64; 3],
    ) {
        let length = solid.max[along] - solid.min[along];
        let vivid = uniform(self.rng, 0.3, 1.7);
        for _ in 0..self.whole(length * self.config.edge * vivid) {
            let mut position = corner;
            position[along] = uniform(self.rng, solid.min[along], solid.max[along]);
            self.place(position, normal, EDGE_LEAST_COSINE, index, 0.15);
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
            && self
                .plan
                .rooms
                .iter()
                .any(|room| room_contains(room, point))
    }

    /// A whole number with the given mean.
    fn whole(&mut self, mean: f64) -> usize {
        let part = self.rng.random::<f64>();
        (mean.clamp(0.0, 1e6) + part).floor() as usize
    }
}

fn room_contains(room: &Room, point: [f64; 3]) -> bool {
    (0..2).all(|axis| room.min[axis] <= point[axis] && point[axis] <= room.max[axis])
}

/// The odds of a chance, at most 1.
fn odds(chance: f64) -> f64 {
    if chance >= 0.5 {
        1.0
    } else {
        chance / (1.0 - chance)
    }
}

/// An edge is seen from everywhere outside of the two faces that meet in it: within 135 degrees less a margin.
const EDGE_LEAST_COSINE: f64 = -0.5;

fn face_of(solid_index: usize, solid: &Solid, axis: usize, outward: f64) -> Face {
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    Face {
        solid: solid_index,
        axis,
        outward,
        value: if outward < 0.0 {
            solid.min[axis]
        } else {
            solid.max[axis]
        },
        low: [solid.min[u], solid.min[v]],
        high: [solid.max[u], solid.max[v]],
    }
}
