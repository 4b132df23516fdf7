//! Apartments from a seed, made as the synthetic apartment of the data folder is described: textured
//! patches, edges and a thin background on walls and furniture, seen by cameras in the same room, depth
//! noise along the ray, three kinds of outliers, all farther than 20 cm from every true surface.

use super::Labelled;
use rand::{Rng, RngExt};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;

/// What a generated apartment looks like.
pub struct Apartment {
    pub points: usize,
    /// Share of outliers, 0 to 1.
    pub outliers: f64,
    pub seed: u64,
}

struct Solid {
    low: [f64; 3],
    high: [f64; 3],
}

/// A flat piece of texture: where, how far it reaches along each axis, how often it is seen.
struct Patch {
    center: [f64; 3],
    spread: [f64; 3],
    weight: f64,
}

struct Scene {
    size: [f64; 3],
    solids: Vec<Solid>,
    patches: Vec<Patch>,
    rooms: Vec<[f64; 4]>,
}

impl Apartment {
    /// Inliers first; the order means nothing to the algorithms.
    pub fn make(&self) -> Labelled {
        let mut rng = Pcg64::seed_from_u64(self.seed);
        let scene = Scene::new(&mut rng);
        let bad = (self.points as f64 * self.outliers).round() as usize;
        let mut points = Vec::with_capacity(self.points);
        while points.len() < self.points - bad {
            let at = scene.surface_point(&mut rng);
            let camera = scene.camera_near(at, &mut rng);
            if rng.random::<f64>() < (-0.5 * (distance(at, camera) - 2.0)).exp() {
                points.push(noisy(at, camera, &mut rng));
            }
        }
        let inliers = points.len();
        while points.len() < self.points {
            let room = self.points - points.len();
            points.extend(
                scene
                    .outliers(&points[..inliers], &mut rng)
                    .into_iter()
                    .take(room),
            );
        }
        let outlier = (0..points.len()).map(|v| Some(v >= inliers)).collect();
        let percent = 100.0 * self.outliers;
        let name = format!(
            "apartment {} n={} outliers={percent:.0} %",
            self.seed, self.points
        );
        Labelled {
            name,
            points,
            views: None,
            outlier,
        }
    }
}

impl Scene {
    fn new(rng: &mut impl Rng) -> Self {
        let (columns, rows) = (rng.random_range(2..4), rng.random_range(1..3));
        let (width, depth, height) = (uniform(rng, 3.4, 4.6), uniform(rng, 3.0, 4.2), 2.6);
        let size = [f64::from(columns) * width, f64::from(rows) * depth, height];
        let mut scene = Self {
            size,
            solids: Vec::new(),
            patches: Vec::new(),
            rooms: Vec::new(),
        };
        scene.build_walls(columns, rows, [width, depth], rng);
        for at in 0..scene.rooms.len() {
            scene.furnish(at, rng);
        }
        scene.texture(rng);
        scene
    }

    fn build_walls(&mut self, columns: i32, rows: i32, [w, d]: [f64; 2], rng: &mut impl Rng) {
        let [x, y, z] = self.size;
        for column in 0..=columns {
            let at = f64::from(column) * w;
            let door = uniform(rng, 0.3, y - 1.2);
            let inner = column > 0 && column < columns;
            self.wall([at - 0.05, 0.0], [at + 0.05, if inner { door } else { y }]);
            if inner {
                self.wall([at - 0.05, door + 0.9], [at + 0.05, y]);
            }
        }
        for row in 0..=rows {
            let at = f64::from(row) * d;
            let door = uniform(rng, 0.3, x - 1.2);
            let inner = row > 0 && row < rows;
            self.wall([0.0, at - 0.05], [if inner { door } else { x }, at + 0.05]);
            if inner {
                self.wall([door + 0.9, at - 0.05], [x, at + 0.05]);
            }
        }
        self.solids.push(Solid {
            low: [0.0, 0.0, -0.1],
            high: [x, y, 0.0],
        });
        self.solids.push(Solid {
            low: [0.0, 0.0, z],
            high: [x, y, z + 0.1],
        });
        for (column, row) in (0..columns).flat_map(|c| (0..rows).map(move |r| (c, r))) {
            let (left, front) = (f64::from(column) * w, f64::from(row) * d);
            self.rooms.push([left, front, left + w, front + d]);
        }
    }

    fn wall(&mut self, low: [f64; 2], high: [f64; 2]) {
        let (low, high) = ([low[0], low[1], 0.0], [high[0], high[1], self.size[2]]);
        self.solids.push(Solid { low, high });
    }

    fn furnish(&mut self, room: usize, rng: &mut impl Rng) {
        let [left, front, right, back] = self.rooms[room];
        for _ in 0..rng.random_range(3..7) {
            let size = [
                uniform(rng, 0.3, 1.4),
                uniform(rng, 0.3, 1.0),
                uniform(rng, 0.3, 1.9),
            ];
            let x = uniform(rng, left + 0.1, right - size[0] - 0.1);
            let y = if rng.random::<bool>() {
                front + 0.1
            } else {
                back - size[1] - 0.1
            };
            let low = [x, y, 0.0];
            self.solids.push(Solid {
                low,
                high: [0, 1, 2].map(|i| low[i] + size[i]),
            });
        }
    }

    /// Pictures, edges and a thin background on every face that a room can see.
    fn texture(&mut self, rng: &mut impl Rng) {
        for solid in &self.solids {
            for axis in 0..3 {
                for side in [solid.low[axis], solid.high[axis]] {
                    let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
                    let area = (solid.high[a] - solid.low[a]) * (solid.high[b] - solid.low[b]);
                    let count = 3.0 * DENSITY * area * rng.random::<f64>().powi(2);
                    let count = count + rng.random::<f64>();
                    for _ in 0..count as usize {
                        self.patches.push(Patch::on(solid, axis, side, rng));
                    }
                    // The thin background: a patch as large as the face.
                    let mut background = Patch::on(solid, axis, side, rng);
                    background.spread = [0, 1, 2].map(|i| -(solid.high[i] - solid.low[i]));
                    background.spread[axis] = 0.0;
                    background.center = [0, 1, 2].map(|i| solid.low[i]);
                    background.center[axis] = side;
                    background.weight = BACKGROUND * area;
                    self.patches.push(background);
                }
            }
        }
        let mut sum = 0.0;
        for patch in &mut self.patches {
            sum += patch.weight;
            patch.weight = sum;
        }
    }

    /// A point of a patch that lies inside the apartment and in no solid.
    fn surface_point(&self, rng: &mut impl Rng) -> [f64; 3] {
        let total = self.patches.last().map_or(0.0, |patch| patch.weight);
        loop {
            let pick = uniform(rng, 0.0, total);
            let at = self.patches.partition_point(|patch| patch.weight < pick);
            let point = self.patches[at].sample(rng);
            let inside = (0..3).all(|i| point[i] >= -1e-9 && point[i] <= self.size[i] + 1e-9);
            let buried = |s: &Solid| {
                (0..3).all(|i| point[i] > s.low[i] + 1e-6 && point[i] < s.high[i] - 1e-6)
            };
            if inside && !self.solids.iter().any(buried) {
                return point;
            }
        }
    }

    /// A camera in the room that the point belongs to, 0.9 to 1.5 m high.
    fn camera_near(&self, at: [f64; 3], rng: &mut impl Rng) -> [f64; 3] {
        let away = |r: &[f64; 4]| {
            (r[0] - at[0]).max(at[0] - r[2]).max(0.0) + (r[1] - at[1]).max(at[1] - r[3]).max(0.0)
        };
        let room = (self.rooms.iter())
            .min_by(|a, b| away(a).total_cmp(&away(b)))
            .unwrap();
        let x = uniform(rng, room[0] + 0.5, room[2] - 0.5);
        [
            x,
            uniform(rng, room[1] + 0.5, room[3] - 0.5),
            uniform(rng, 0.9, 1.5),
        ]
    }

    /// One uniform or stretched outlier or one clump, or nothing if it would lie near a surface.
    fn outliers(&self, inliers: &[[f64; 3]], rng: &mut impl Rng) -> Vec<[f64; 3]> {
        let far = |p: &[f64; 3]| self.solids.iter().all(|s| s.distance(*p) > 0.2);
        let kind = rng.random::<f64>();
        if kind < 0.39 {
            return Some(self.anywhere(rng)).filter(far).into_iter().collect();
        }
        if kind < 0.96 {
            let at = inliers[rng.random_range(0..inliers.len())];
            let camera = self.camera_near(at, rng);
            let (near, far_factor) = (uniform(rng, 0.25, 0.85), uniform(rng, 1.2, 2.5));
            let factor = if rng.random::<bool>() {
                near
            } else {
                far_factor
            };
            let moved = [0, 1, 2].map(|i| camera[i] + (at[i] - camera[i]) * factor);
            return Some(moved).filter(far).into_iter().collect();
        }
        let center = self.anywhere(rng);
        let size = rng.random_range(4..13);
        let spread = uniform(rng, 0.03, 0.08);
        let clump: Vec<_> = (0..size)
            .map(|_| center.map(|c| c + spread * normal(rng)))
            .collect();
        clump.into_iter().filter(far).collect()
    }

    fn anywhere(&self, rng: &mut impl Rng) -> [f64; 3] {
        [0, 1, 2].map(|i| uniform(rng, -1.0, self.size[i] + 1.0))
    }
}

impl Solid {
    fn distance(&self, p: [f64; 3]) -> f64 {
        let outside = |i: usize| (self.low[i] - p[i]).max(p[i] - self.high[i]).max(0.0);
        (0..3).map(|i| outside(i) * outside(i)).sum::<f64>().sqrt()
    }
}

impl Patch {
    fn on(solid: &Solid, axis: usize, side: f64, rng: &mut impl Rng) -> Self {
        let mut center = [0, 1, 2].map(|i| uniform(rng, solid.low[i], solid.high[i]));
        let mut spread = [uniform(rng, 0.04, 0.3); 3];
        if rng.random::<f64>() < 0.3 {
            spread[(axis + 1) % 3] = 0.01;
            spread[(axis + 2) % 3] = uniform(rng, 0.1, 0.5);
        }
        (center[axis], spread[axis]) = (side, 0.0);
        let [a, b] = [spread[(axis + 1) % 3], spread[(axis + 2) % 3]];
        let weight = uniform(rng, 0.3, 1.7) * a.max(0.03) * b.max(0.03);
        Self {
            center,
            spread,
            weight,
        }
    }

    /// Normal around the centre, or uniform from it where the spread is negative.
    fn sample(&self, rng: &mut impl Rng) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            let spread = self.spread[i];
            let along = if spread < 0.0 {
                -rng.random::<f64>()
            } else {
                normal(rng)
            };
            self.center[i] + spread * along
        })
    }
}

/// Depth noise of 0.6 % z + 0.4 % z² along the ray.
fn noisy(at: [f64; 3], camera: [f64; 3], rng: &mut impl Rng) -> [f64; 3] {
    let shift = (0.006 + 0.004 * distance(at, camera)) * normal(rng);
    [0, 1, 2].map(|i| at[i] + (at[i] - camera[i]) * shift)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

fn uniform(rng: &mut impl Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.random::<f64>()
}

/// The sum of twelve uniform numbers: normal enough.
fn normal(rng: &mut impl Rng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

/// Patches a square metre of an average face.
const DENSITY: f64 = 0.35;
/// Weight of a square metre of background, in square metres of patch (the product of its spreads).
const BACKGROUND: f64 = 0.00008;
