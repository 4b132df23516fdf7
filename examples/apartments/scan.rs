//! Flies through an apartment with a pilot that knows the truth, and keeps what the simulated SLAM made of it.

use core::time::Duration;
use std::collections::HashMap;
use std::error::Error;

use explorer::map_views;
use indoor_sim::{SimConfig, Simulator, World};
use rand_pcg::Pcg64;
use rrt_refine::refine::{TautConfig, taut};
use rrt_refine::{Bounds, Path, Query, RrtConfig, rrt_connect};
use slam_bridge::nalgebra::Point3;
use slam_bridge::{KeyFrame, SlamSource};
use sparse_to_obstacles::Ray;
use submodular_minimax::{OutlierConfig, remove_outliers};
use tello_sdk::{Command, Distance, ReplyKind, Turn};

pub(crate) type Place = [f64; 3];

/// Height of the flight, metres.
const HEIGHT: f64 = 1.0;
/// The pilot keeps the first of these distances from everything, metres, with which there is a way: a hop errs by a few
/// centimetres, and doors are wide enough for the middle ones.
const BERTHS: [f64; 5] = [0.4, 0.35, 0.3, 0.25, 0.2];
/// Places to look around at keep this distance, metres.
const SITE_BERTH: f64 = 0.25;
/// Longest hop between two corrections, metres.
const HOP: f64 = 0.6;
/// Half the height of the layer in which ways are planned, metres.
const LEVEL: f64 = 0.01;
/// Shortest move that the drone knows, centimetres.
const SHORTEST_MOVE: i64 = 20;
/// A scan for every stretch of a room that is this long, metres.
const STRETCH: f64 = 5.0;

/// A map in the world's frame and metres, outliers removed, and the truth that the experiment is judged by.
pub(crate) struct Scan {
    pub(crate) world: World,
    /// The points kept.
    pub(crate) points: Vec<Place>,
    /// From each keyframe to the kept points that it sees.
    pub(crate) rays: Vec<Ray>,
    /// The same to where the corners truly are, without wrong points: what the scan really saw through.
    pub(crate) sight_lines: Vec<Ray>,
    pub(crate) keyframes: usize,
    /// Places to look around at, and at how many of them the pilot did.
    pub(crate) sites: usize,
    pub(crate) visited: usize,
}

/// Visits every room of the apartment that `seed` draws, turning once round in each.
pub(crate) fn scan(seed: u64) -> Result<Scan, Box<dyn Error>> {
    let world = World::named(&format!("generated:{seed}"), seed)?;
    let mut config = SimConfig::default();
    // One battery for all rooms.
    config.drone.hover_drain = 0.0;
    config.drone.motion_drain = 0.0;
    // Drift bends the map, and a path would have to be judged in a bent world. All other errors stay.
    config.slam.drift_per_meter = 0.0;
    config.slam.drift_per_radian = 0.0;
    let mut pilot = Pilot {
        sim: Simulator::new(world.clone(), config, seed)?,
    };
    pilot.order(&Command::TakeOff)?;
    pilot.look_around()?;
    let sites = sites(&world);
    let mut visited = 0;
    for &site in &sites {
        if pilot.go_to(site)? {
            pilot.look_around()?;
            visited += 1;
        }
    }
    let scan = collect(&pilot.sim, world)?;
    Ok(Scan {
        sites: sites.len(),
        visited,
        ..scan
    })
}

/// Where to look around: for each stretch of each room the nearest reachable place to its middle.
fn sites(world: &World) -> Vec<Place> {
    let reach = world.reachable(HEIGHT, 0.15, SITE_BERTH);
    let middles = world.rooms().iter().flat_map(|room| {
        let long = usize::from(room.max[1] - room.min[1] > room.max[0] - room.min[0]);
        let count = ((room.max[long] - room.min[long]) / STRETCH)
            .ceil()
            .max(1.0);
        (0..count as usize).map(move |i| {
            let share = |axis: usize| {
                if axis == long {
                    (i as f64 + 0.5) / count
                } else {
                    0.5
                }
            };
            [0, 1].map(|axis| room.min[axis] + share(axis) * (room.max[axis] - room.min[axis]))
        })
    });
    let nearest = |middle: [f64; 2]| {
        let away = |cell: &Place| (cell[0] - middle[0]).hypot(cell[1] - middle[1]);
        reach
            .cells
            .iter()
            .copied()
            .min_by(|a, b| away(a).total_cmp(&away(b)))
    };
    middles.filter_map(nearest).collect()
}

struct Pilot {
    sim: Simulator,
}

impl Pilot {
    /// Gives a command and waits for its answer; was it carried out?
    fn order(&mut self, command: &Command) -> Result<bool, Box<dyn Error>> {
        if self.sim.send(command).is_err() {
            return Ok(false); // crashed
        }
        let mut done = None;
        while done.is_none() || self.sim.is_busy() {
            self.sim.advance(Duration::from_millis(100));
            done = self
                .sim
                .poll_reply()
                .map(|reply| reply.kind == ReplyKind::Ok)
                .or(done);
        }
        Ok(done.unwrap_or(false))
    }

    fn here(&self) -> Place {
        self.sim.pose().translation.vector.into()
    }

    /// Once round in steps of 20 degrees, up and down, so that there is parallax.
    fn look_around(&mut self) -> Result<(), Box<dyn Error>> {
        let climb = Distance::from_cm(40)?;
        for step in 0..18 {
            let lift = if step % 2 == 0 {
                Command::Up(climb)
            } else {
                Command::Down(climb)
            };
            self.order(&lift)?;
            self.order(&Command::Clockwise(Turn::from_degrees(20)?))?;
        }
        Ok(())
    }

    /// Flies to a place on a way that the truth allows; was it reached?
    fn go_to(&mut self, goal: Place) -> Result<bool, Box<dyn Error>> {
        self.level()?;
        let Some(path) = BERTHS.iter().find_map(|&berth| self.way_to(goal, berth)) else {
            return Ok(false);
        };
        for &waypoint in &path.points()[1..] {
            self.fly_to(waypoint)?;
        }
        Ok(self.sim.is_flying())
    }

    /// A level way from here.
    fn way_to(&self, goal: Place, berth: f64) -> Option<Path<3>> {
        let world = self.sim.world();
        let here = self.here();
        let (mut low, mut high) = world.bounds();
        (low[2], high[2]) = (here[2] - LEVEL, here[2] + LEVEL);
        let bounds = Bounds::new(low, high).ok()?;
        let free = |a: &Place, b: &Place| world.segment_is_free(*a, *b, berth);
        let query = Query::new(here, [goal[0], goal[1], here[2]], bounds);
        let mut rng = Pcg64::new(1, 1);
        let plan = rrt_connect(&query, &free, &RrtConfig::default(), &mut rng).ok()?;
        let path = taut(&plan.path?, &free, &TautConfig::default()).ok()?;
        Some(path.path)
    }

    /// Back to the height of the flight: up and down, since a move has a least length.
    fn level(&mut self) -> Result<(), Box<dyn Error>> {
        let rise = (100.0 * (HEIGHT - self.here()[2])).round() as i64;
        let (up, down) = match rise {
            0 => return Ok(()),
            _ if rise >= SHORTEST_MOVE => (rise, 0),
            _ if -rise >= SHORTEST_MOVE => (0, -rise),
            _ => (SHORTEST_MOVE + rise.max(0), SHORTEST_MOVE + (-rise).max(0)),
        };
        if up > 0 {
            self.order(&Command::Up(Distance::from_cm(up)?))?;
        }
        if down > 0 {
            self.order(&Command::Down(Distance::from_cm(down)?))?;
        }
        Ok(())
    }

    /// Straight ahead in hops, the heading corrected before each.
    fn fly_to(&mut self, waypoint: Place) -> Result<(), Box<dyn Error>> {
        for _ in 0..60 {
            let pose = self.sim.pose();
            let to = pose.inverse_transform_point(&Point3::from(waypoint));
            let away = to.x.hypot(to.y);
            if 100.0 * away < SHORTEST_MOVE as f64 || !self.sim.is_flying() {
                break;
            }
            let turn = to.y.atan2(to.x).to_degrees().round();
            if turn.abs() >= 1.0 {
                let by = Turn::from_degrees(turn.abs() as i64)?;
                let command = if turn > 0.0 {
                    Command::CounterClockwise(by)
                } else {
                    Command::Clockwise(by)
                };
                self.order(&command)?;
            }
            let hop = Distance::from_cm((100.0 * away.min(HOP)).round() as i64)?;
            self.order(&Command::Forward(hop))?;
        }
        Ok(())
    }
}

fn collect(sim: &Simulator, world: World) -> Result<Scan, Box<dyn Error>> {
    let map = sim.slam_ref().map();
    let world_from_map = sim.world_from_map().ok_or("the scan made no map")?;
    let center = |keyframe: &KeyFrame| world_from_map * keyframe.center();
    let place: HashMap<_, _> = map
        .keyframes
        .iter()
        .map(|keyframe| (keyframe.id, center(keyframe).into()))
        .collect();
    let kept = remove_outliers(
        &map.positions(),
        map_views(&map)?.as_ref(),
        &OutlierConfig::default(),
    )?
    .kept;
    let (mut points, mut rays, mut sight_lines) = (Vec::new(), Vec::new(), Vec::new());
    for point in kept.into_iter().filter_map(|index| map.points.get(index)) {
        let end: Place = (world_from_map * point.position).into();
        points.push(end);
        let truth = sim.slam_ref().point_truth(point.id);
        for &origin in point.observers.iter().filter_map(|id| place.get(id)) {
            rays.push(Ray { origin, end });
            if let Some(truth) = truth.filter(|truth| truth.outlier.is_none()) {
                sight_lines.push(Ray {
                    origin,
                    end: truth.position,
                });
            }
        }
    }
    Ok(Scan {
        points,
        rays,
        sight_lines,
        keyframes: map.keyframes.len(),
        sites: 0,
        visited: 0,
        world,
    })
}
