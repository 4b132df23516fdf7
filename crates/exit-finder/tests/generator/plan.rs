//! Floor plans: a rectangular room, doors to what lies behind, furniture, textured and weak walls.

use rand::RngExt;
use rand_pcg::Pcg64;

use super::Opening;

pub const CEILING: f64 = 2.5;
const LINTEL: f64 = 2.05;
const WALL: f64 = 0.12;
/// Share of nearly blank wall. In two real scans that turned right round, 5 and 17 % of the 5 degree
/// sectors hold less than a twentieth of the usual number of points.
const BLANK: f64 = 0.12;

/// A vertical rectangle: a piece of wall, a jamb, a side of a box.
#[derive(Debug, Clone, Copy)]
pub struct Panel {
    pub a: [f64; 2],
    pub b: [f64; 2],
    pub z: [f64; 2],
    /// Features per square metre.
    pub density: f64,
}

/// A door in a wall of the main room.
#[derive(Debug, Clone, Copy)]
pub struct Door {
    pub jambs: [[f64; 2]; 2],
    pub seen_through: bool,
}

/// What is unusual about a room.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kind {
    /// Straight walls, doors with lintels.
    #[default]
    Plain,
    /// Walls along a superellipse: round, oval, or straight with rounded corners. No furniture.
    Curved,
    /// The openings are closed below by a counter.
    Counter,
    /// The openings reach up to the ceiling.
    Tall,
}

/// A room with everything that can be seen from it.
pub struct Plan {
    pub kind: Kind,
    /// Exponent of the superellipse, of curved rooms.
    pub exponent: f64,
    pub size: [f64; 2],
    pub agent: [f64; 2],
    pub doors: Vec<Door>,
    /// Whether nothing behind the doors can be seen.
    dark: bool,
    pub panels: Vec<Panel>,
    /// Floor rectangles (low corner, high corner, density); the ceiling has the same.
    pub floors: Vec<([f64; 2], [f64; 2], f64)>,
    boxes: Vec<([f64; 2], [f64; 2])>,
}

impl Plan {
    pub fn random(kind: Kind, doors: usize, dark: bool, rng: &mut Pcg64) -> Self {
        if kind == Kind::Curved {
            return Self::curved(doors, dark, rng);
        }
        let size = if rng.random_bool(0.2) {
            [rng.random_range(6.0..10.0), rng.random_range(1.6..2.4)]
        } else {
            [rng.random_range(3.0..8.0), rng.random_range(2.8..6.0)]
        };
        let mut plan = Self::empty(kind, size, dark, rng);
        for (index, side) in shuffled_sides(rng).into_iter().enumerate() {
            plan.build_side(side, index < doors, rng);
        }
        plan.furnish(rng);
        plan.place_agent(rng);
        plan
    }

    pub(super) fn empty(kind: Kind, size: [f64; 2], dark: bool, rng: &mut Pcg64) -> Self {
        let floor = ([0.0; 2], size, rng.random_range(2.0..10.0));
        Plan {
            kind,
            exponent: f64::INFINITY,
            size,
            agent: [0.0; 2],
            doors: Vec::new(),
            dark,
            panels: Vec::new(),
            floors: vec![floor],
            boxes: Vec::new(),
        }
    }

    /// Point of a side: `along` its length, `out` of the room.
    pub(super) fn on_side(&self, side: usize, along: f64, out: f64) -> [f64; 2] {
        match side {
            0 => [along, -out],
            1 => [self.size[0] + out, along],
            2 => [along, self.size[1] + out],
            _ => [-out, along],
        }
    }

    fn build_side(&mut self, side: usize, with_door: bool, rng: &mut Pcg64) {
        let length = self.size[side % 2];
        if !with_door {
            self.wall(side, 0.0, 0.0, length, rng);
            return;
        }
        let width = rng.random_range(0.8..1.3f64).min(length - 0.4);
        let from = rng.random_range(0.15..length - width - 0.14);
        let to = from + width;
        self.wall(side, 0.0, 0.0, from, rng);
        self.wall(side, 0.0, to, length, rng);
        let lintel = [self.on_side(side, from, 0.0), self.on_side(side, to, 0.0)];
        self.door(side, [from, to], lintel, rng);
    }

    /// A door from jamb to jamb and what lies behind it.
    pub(super) fn door(
        &mut self,
        side: usize,
        [from, to]: [f64; 2],
        lintel: [[f64; 2]; 2],
        rng: &mut Pcg64,
    ) {
        if self.kind == Kind::Counter {
            self.panel(lintel, [0.0, rng.random_range(0.7..1.0)], 40.0);
        }
        if self.kind != Kind::Tall {
            self.panel(lintel, [LINTEL, CEILING], 30.0);
        }
        for (along, jamb) in [from, to].into_iter().zip(lintel) {
            let jamb = [jamb, self.on_side(side, along, WALL)];
            self.panel(jamb, [0.0, LINTEL], 60.0);
        }
        let seen_through = !self.dark;
        if seen_through {
            self.space_behind(side, from, to, rng);
        }
        self.doors.push(Door {
            jambs: [lintel[0], lintel[1]],
            seen_through,
        });
    }

    /// The room or corridor behind a door.
    fn space_behind(&mut self, side: usize, from: f64, to: f64, rng: &mut Pcg64) {
        let (depth, left, right) = match rng.random_range(0..3) {
            0 => (
                rng.random_range(1.2..2.0),
                rng.random_range(2.0..6.0),
                rng.random_range(2.0..6.0),
            ),
            1 => (rng.random_range(4.0..8.0), 0.2, 0.2),
            _ => (
                rng.random_range(2.5..6.0),
                rng.random_range(0.3..3.0),
                rng.random_range(0.3..3.0),
            ),
        };
        let (low, high) = (from - left, to + right);
        self.wall(side, WALL + depth, low, high, rng);
        for along in [low, high] {
            let ends = [
                self.on_side(side, along, WALL),
                self.on_side(side, along, WALL + depth),
            ];
            self.patches(ends, rng);
        }
        self.panel_pair(side, low, from, to, high);
        let corners = [
            self.on_side(side, low, WALL),
            self.on_side(side, high, WALL + depth),
        ];
        let low_corner = std::array::from_fn(|i| corners[0][i].min(corners[1][i]));
        let high_corner = std::array::from_fn(|i| corners[0][i].max(corners[1][i]));
        self.floors
            .push((low_corner, high_corner, rng.random_range(2.0..10.0)));
    }

    /// The far faces of the wall beside a door: they hide, but show nothing to the main room.
    fn panel_pair(&mut self, side: usize, low: f64, from: f64, to: f64, high: f64) {
        for (a, b) in [(low, from), (to, high)] {
            let ends = [self.on_side(side, a, WALL), self.on_side(side, b, WALL)];
            self.panel(ends, [0.0, CEILING], 0.0);
        }
    }

    fn wall(&mut self, side: usize, out: f64, from: f64, to: f64, rng: &mut Pcg64) {
        let ends = [self.on_side(side, from, out), self.on_side(side, to, out)];
        self.patches(ends, rng);
    }

    /// Cuts a wall into patches of their own texture; some are nearly blank.
    pub(super) fn patches(&mut self, [a, b]: [[f64; 2]; 2], rng: &mut Pcg64) {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let mut done = 0.0;
        while done < length {
            let next = (done + rng.random_range(0.4..1.4f64)).min(length);
            let density = if rng.random_bool(BLANK) {
                rng.random_range(1.5..4.0)
            } else {
                rng.random_range(12.0..80.0)
            };
            let at = |s: f64| {
                [
                    a[0] + (b[0] - a[0]) * s / length,
                    a[1] + (b[1] - a[1]) * s / length,
                ]
            };
            self.panel([at(done), at(next)], [0.0, CEILING], density);
            done = next;
        }
    }

    pub(super) fn panel(&mut self, [a, b]: [[f64; 2]; 2], z: [f64; 2], density: f64) {
        self.panels.push(Panel { a, b, z, density });
    }

    /// Cabinets and tables against the walls, never before a door.
    fn furnish(&mut self, rng: &mut Pcg64) {
        for _ in 0..rng.random_range(0..6) {
            let side = rng.random_range(0..4);
            let length = self.size[side % 2];
            let (along, width) = (rng.random_range(0.0..length), rng.random_range(0.4..1.6));
            let depth = rng
                .random_range(0.3..0.7f64)
                .min(0.3 * self.size[1 - side % 2]);
            let p = self.on_side(side, along, 0.0);
            let q = self.on_side(side, (along + width).min(length), -depth);
            let low: [f64; 2] = std::array::from_fn(|i| p[i].min(q[i]));
            let high: [f64; 2] = std::array::from_fn(|i| p[i].max(q[i]));
            if self.doors.iter().any(|door| near_door(door, low, high)) {
                continue;
            }
            let height = if rng.random_bool(0.4) {
                1.9
            } else {
                rng.random_range(0.4..1.0)
            };
            let density = rng.random_range(15.0..60.0);
            let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
            for i in 0..4 {
                self.panel([corners[i], corners[(i + 1) % 4]], [0.0, height], density);
            }
            self.boxes.push((low, high));
        }
    }

    fn place_agent(&mut self, rng: &mut Pcg64) {
        let margin = 0.7;
        for _ in 0..200 {
            let at = std::array::from_fn(|i| rng.random_range(margin..self.size[i] - margin));
            self.agent = at;
            let free = |(low, high): &([f64; 2], [f64; 2])| {
                (0..2).any(|i| at[i] < low[i] - 0.4 || at[i] > high[i] + 0.4)
            };
            if self.boxes.iter().all(free) {
                return;
            }
        }
    }

    /// How far behind the room's wall the points in a sector lie, those from half a metre on.
    fn depths_behind(&self, points: &[[f64; 3]], start: f64, width: f64) -> Vec<f64> {
        let within = |p: &&[f64; 3]| {
            let bearing = (p[1] - self.agent[1]).atan2(p[0] - self.agent[0]);
            (bearing - start).rem_euclid(std::f64::consts::TAU) < width
        };
        let outside = |p: &[f64; 3]| {
            let beyond = |i: usize| (-p[i]).max(p[i] - self.size[i]);
            beyond(0).max(beyond(1))
        };
        let depths = points.iter().filter(within).map(outside);
        depths.filter(|&depth| depth > 0.5).collect()
    }

    /// The doors as seen from the agent after turning the world by `yaw`.
    pub fn openings(&self, yaw: f64, points: &[[f64; 3]]) -> Vec<Opening> {
        let opening = |door: &Door| {
            let [a, b] = door
                .jambs
                .map(|j| (j[1] - self.agent[1]).atan2(j[0] - self.agent[0]));
            let turn = (b - a).rem_euclid(std::f64::consts::TAU);
            let (start, width) = if turn < std::f64::consts::PI {
                (a, turn)
            } else {
                (b, std::f64::consts::TAU - turn)
            };
            let clear = [0.1, 0.3, 0.5, 0.7, 0.9].iter().all(|&share: &f64| {
                let [a, b] = door.jambs;
                let q = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
                !self
                    .boxes
                    .iter()
                    .any(|(low, high)| crosses_box(self.agent, q, *low, *high))
            });
            let middle: [f64; 2] =
                std::array::from_fn(|i| 0.5 * (door.jambs[0][i] + door.jambs[1][i]));
            let range = (middle[0] - self.agent[0]).hypot(middle[1] - self.agent[1]);
            // At least 10 degrees and half a metre wide as seen, not behind furniture.
            let fair =
                clear && width > 10f64.to_radians() && 2.0 * range * (0.5 * width).sin() > 0.5;
            let depths = self.depths_behind(points, start, width);
            Opening {
                behind: depths.len(),
                depth: depths.iter().sum::<f64>() / depths.len().max(1) as f64,
                start: start + yaw,
                width,
                fair,
                seen_through: door.seen_through,
            }
        };
        self.doors.iter().map(opening).collect()
    }
}

/// The sides in random order.
pub(super) fn shuffled_sides(rng: &mut Pcg64) -> [usize; 4] {
    let mut sides = [0, 1, 2, 3];
    for i in (1..4).rev() {
        sides.swap(i, rng.random_range(0..=i));
    }
    sides
}

fn near_door(door: &Door, low: [f64; 2], high: [f64; 2]) -> bool {
    let reach = 0.8;
    let [a, b] = door.jambs;
    (0..2).all(|i| a[i].min(b[i]) - reach < high[i] && a[i].max(b[i]) + reach > low[i])
}

fn crosses_box(p: [f64; 2], q: [f64; 2], low: [f64; 2], high: [f64; 2]) -> bool {
    (0..=40).any(|k| {
        let s = f64::from(k) / 40.0;
        (0..2).all(|i| {
            let x = p[i] + s * (q[i] - p[i]);
            x > low[i] && x < high[i]
        })
    })
}
