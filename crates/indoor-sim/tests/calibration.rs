//! The stand-in's maps compared with a real ORB-SLAM3 map, figure by figure.
//!
//! `cargo test -p indoor-sim --test calibration -- --nocapture` prints the table of the README. The real column is read
//! from the recorded map where it is at hand; the bars are derived from it.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that prints a table"
)]

use core::time::Duration;
use std::collections::HashMap;
use std::path::PathBuf;

use indoor_sim::slam_bridge::{
    KeyFrameId, Map, MapPoint, SlamSource, TrackingState, read_map_folder,
};
use indoor_sim::{SimConfig, Simulator, World};
use nalgebra::{Point3, Vector3};
use tello_sdk::{Command, Distance, Turn};

/// What is compared; each a list of values whose quantiles count.
#[derive(Default)]
struct Figures {
    observers: Vec<f64>,
    per_keyframe: Vec<f64>,
    parallax_degrees: Vec<f64>,
    depth_error: Vec<f64>,
    tracked: Vec<f64>,
    open_surface: Vec<f64>,
    /// Depth errors of points with three to five observers, and with ten or more.
    few_many: [Vec<f64>; 2],
}

impl Figures {
    /// Counts a map whose points have these signed relative errors of depth.
    fn add(&mut self, map: &Map, errors: &HashMap<u64, f64>) {
        let mut per: HashMap<KeyFrameId, f64> = HashMap::new();
        for point in &map.points {
            self.observers.push(point.observers.len() as f64);
            for &id in &point.observers {
                *per.entry(id).or_default() += 1.0;
            }
            let centers: Vec<Point3<f64>> = point
                .observers
                .iter()
                .filter_map(|&id| Some(map.keyframe(id)?.center()))
                .collect();
            self.parallax_degrees
                .push(widest(point.position, &centers).to_degrees());
            let Some(error) = errors.get(&point.id.0) else {
                continue;
            };
            self.depth_error.push(error.abs());
            match point.observers.len() {
                3..=5 => self.few_many[0].push(error.abs()),
                10.. => self.few_many[1].push(error.abs()),
                _ => {}
            }
        }
        self.per_keyframe.extend(per.into_values());
    }

    fn rows(&self) -> Vec<(&'static str, f64)> {
        let gross = |errors: &[f64]| share(errors, 0.2);
        vec![
            ("observers per point, 10 %", quantile(&self.observers, 0.1)),
            (
                "observers per point, median",
                quantile(&self.observers, 0.5),
            ),
            ("observers per point, 90 %", quantile(&self.observers, 0.9)),
            (
                "points per keyframe, median",
                quantile(&self.per_keyframe, 0.5),
            ),
            (
                "widest parallax, degrees, median",
                quantile(&self.parallax_degrees, 0.5),
            ),
            ("depth error, 25 %", quantile(&self.depth_error, 0.25)),
            ("depth error, median", quantile(&self.depth_error, 0.5)),
            ("depth error, 75 %", quantile(&self.depth_error, 0.75)),
            ("depth error, 90 %", quantile(&self.depth_error, 0.9)),
            ("share off by more than 20 %", gross(&self.depth_error)),
            ("the same, 3 to 5 observers", gross(&self.few_many[0])),
            ("the same, 10 or more observers", gross(&self.few_many[1])),
            (
                "share of surface without a point within 0.2 m",
                quantile(&self.open_surface, 0.5),
            ),
            (
                "points tracked per frame, median",
                quantile(&self.tracked, 0.5),
            ),
        ]
    }
}

fn widest(point: Point3<f64>, centers: &[Point3<f64>]) -> f64 {
    let rays: Vec<Vector3<f64>> = centers.iter().map(|center| point - center).collect();
    let pairs = rays
        .iter()
        .flat_map(|a| rays.iter().map(move |b| a.angle(b)));
    pairs.fold(0.0, f64::max)
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
        .get((share * sorted.len().saturating_sub(1) as f64) as usize)
        .copied()
        .unwrap_or(f64::NAN)
}

fn share(values: &[f64], above: f64) -> f64 {
    values.iter().filter(|&&value| value > above).count() as f64 / values.len() as f64
}

/// Scans of the start rooms: a full turn in 18 steps, each with 40 cm up or down.
fn simulated() -> Figures {
    let mut figures = Figures::default();
    for (name, seed) in [("apartment", 1), ("two-rooms", 2), ("closed-room", 3)] {
        let world = World::named(name, seed).unwrap();
        let mut sim = Simulator::new(world, SimConfig::default(), seed).unwrap();
        let level = Distance::from_cm(40).unwrap();
        let turn = Command::Clockwise(Turn::from_degrees(20).unwrap());
        let step = |i| {
            if i % 2 == 0 {
                Command::Up(level)
            } else {
                Command::Down(level)
            }
        };
        let scan = (0..18).flat_map(|i| [step(i), turn.clone()]);
        for command in core::iter::once(Command::TakeOff).chain(scan) {
            sim.send(&command).unwrap();
            while sim.poll_reply().is_none() {
                sim.advance(Duration::from_millis(100));
            }
            let updates = core::iter::from_fn(|| sim.slam().poll());
            let good = updates.filter(|update| update.state == TrackingState::Tracking);
            figures
                .tracked
                .extend(good.map(|update| update.tracked_points as f64));
        }
        let map = sim.slam_ref().map();
        figures.add(&map, &depth_errors(&sim, &map));
        figures.open_surface.push(open_surface(&sim));
    }
    figures
}

/// Signed relative error of each point's mean distance from its observers.
fn depth_errors(sim: &Simulator, map: &Map) -> HashMap<u64, f64> {
    let world_from_map = sim.world_from_map().unwrap();
    let error = |point: &MapPoint| {
        let truth = Point3::from(sim.slam_ref().point_truth(point.id)?.position);
        let place = world_from_map * point.position;
        let (mut mapped, mut real) = (0.0, 0.0);
        for &id in &point.observers {
            let center = world_from_map * map.keyframe(id)?.center();
            mapped += (place - center).norm();
            real += (truth - center).norm();
        }
        Some((point.id.0, mapped / real - 1.0))
    };
    map.points.iter().filter_map(error).collect()
}

/// Share of the start room's surfaces, 0.2 m to 2 m above the floor, that lie farther than 0.2 m from every map point:
/// what obstacles made of points alone leave open. On the real kitchen map it is 0.27 of the surface voxels.
fn open_surface(sim: &Simulator) -> f64 {
    let world_from_map = sim.world_from_map().unwrap();
    let map = sim.slam_ref().map();
    let points: Vec<Point3<f64>> = map
        .points
        .iter()
        .map(|p| world_from_map * p.position)
        .collect();
    let world = sim.world();
    let [x, y] = world.start().position;
    let room = world.room_at([x, y, 1.0]);
    let (mut open, mut all) = (0, 0);
    for (solid, axis, side) in world
        .solids()
        .iter()
        .flat_map(|solid| (0..3).flat_map(move |axis| [-1.0, 1.0].map(|side| (solid, axis, side))))
    {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        let count = |a: usize| ((solid.max[a] - solid.min[a]) / 0.2) as usize;
        for (i, j) in (0..count(u)).flat_map(|i| (0..count(v)).map(move |j| (i, j))) {
            let mut place = if side < 0.0 { solid.min } else { solid.max };
            place[u] = solid.min[u] + 0.2 * i as f64 + 0.1;
            place[v] = solid.min[v] + 0.2 * j as f64 + 0.1;
            let mut front = place;
            front[axis] += 0.07 * side;
            let looked_at = world.room_at(front) == room && world.clearance(front) > 0.06;
            if looked_at && (0.2..2.0).contains(&place[2]) {
                let place = Point3::from(place);
                all += 1;
                open += usize::from(points.iter().all(|point| (point - place).norm() > 0.2));
            }
        }
    }
    open as f64 / all as f64
}

/// The real kitchen map with its depth labels; `None` where the recordings are not at hand.
fn real() -> Option<Figures> {
    let root = std::env::var("EXPLORER_DATA").map_or_else(
        |_| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")),
        PathBuf::from,
    );
    let folder = root.join("data/orbslam3-maps/sevenscenes_kitchen_mono_first500");
    let map = read_map_folder(&folder, None).ok()?;
    let labels = std::fs::read_to_string(folder.join("depth_check.csv")).ok()?;
    let row = |line: &str| {
        let mut cells = line.split(',');
        Some((cells.next()?.parse().ok()?, cells.nth(1)?.parse().ok()?))
    };
    let errors = labels.lines().skip(1).filter_map(row).collect();
    let frames = std::fs::read_to_string(folder.join("frames.csv")).ok()?;
    let tracked = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        (*cells.get(1)? == "OK").then(|| cells.get(3)?.parse().ok())?
    };
    let mut figures = Figures {
        tracked: frames.lines().filter_map(tracked).collect(),
        ..Figures::default()
    };
    figures.add(&map, &errors);
    // Measured once against the depth camera's surfaces, which are not at hand here.
    figures.open_surface.push(0.27);
    Some(figures)
}

#[test]
fn maps_resemble_a_real_one() {
    let simulated = simulated().rows();
    let Some(real) = real() else {
        println!("skipped: no recorded maps; set EXPLORER_DATA to the folder that holds data/");
        return;
    };
    println!("| figure | real kitchen | simulated scans |\n| --- | --- | --- |");
    for ((name, real), (_, simulated)) in real.rows().into_iter().zip(&simulated) {
        println!("| {name} | {real:.3} | {simulated:.3} |");
        let ratio = simulated / real;
        assert!(
            (0.5..2.0).contains(&ratio),
            "{name}: {simulated} against {real}"
        );
    }
}
