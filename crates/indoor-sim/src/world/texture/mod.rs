//! Paints the surfaces of a world: textured patches, edges, a thin background, and blank walls that carry nothing.

mod brush;
mod face;

use rand::{Rng, RngExt};

use super::WorldError;
use super::floor_plan::{FloorPlan, bounded};
use super::landmark::Landmark;
use super::solid::{Solid, SolidKind};
use crate::random::uniform;
use brush::contains;
use face::Face;

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

impl TextureConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`WorldError::OutOfRange`] names the first number that is out of its range.
    pub fn validate(&self) -> Result<(), WorldError> {
        bounded("texture.blank_share", self.blank_share, 0.0, 0.5)?;
        bounded("texture.background", self.background, 0.0, DENSEST)?;
        bounded("texture.patch", self.patch, 0.0, DENSEST)?;
        bounded("texture.furniture", self.furniture, 0.0, DENSEST)?;
        bounded("texture.floor", self.floor, 0.0, DENSEST)?;
        bounded("texture.ceiling", self.ceiling, 0.0, DENSEST)?;
        bounded("texture.edge", self.edge, 0.0, DENSEST)
    }
}

/// No surface carries more corners per square metre, no edge more per metre.
const DENSEST: f64 = 1e4;

/// Where the upper row of panels begins, relative to the height of the room.
const ROW_BORDER: f64 = 0.5;

/// Greatest width of a panel, metres.
const PANEL: f64 = 1.05;

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

impl<R: Rng> Painter<'_, R> {
    fn paint_solid(&mut self, index: usize, solid: &Solid) {
        for axis in 0..3 {
            for outward in [-1.0, 1.0] {
                let face = Face::of(index, solid, axis, outward);
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
        let front = panel.front();
        let faced = self.plan.rooms.iter().find(|room| contains(room, front));
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
}

/// The odds of a chance, at most 1.
fn odds(chance: f64) -> f64 {
    if chance >= 0.5 {
        1.0
    } else {
        chance / (1.0 - chance)
    }
}
