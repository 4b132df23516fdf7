//! Apartments as a sparse map has them: the recorded one, and generated ones of the same kind.
//!
//! Kind: points in textured patches of walls and furniture, with an error along the line of sight that grows with the square of the
//! depth; blank walls have none; outliers are removed.

use std::error::Error;
use std::path::{Path, PathBuf};

use indoor_sim::World;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rrt_refine::{Bounds, Query};
use serde_json::Value;

pub(crate) type Place = [f64; 3];

/// Of the ball that moves, metres.
pub(crate) const RADIUS: f64 = 0.15;
/// Height of the cameras, and of both ends of a query, metres.
const HEIGHT: f64 = 1.2;
/// Largest error of a point 1 m away, metres.
const ERROR: f64 = 0.005;
/// Farthest point that a camera keeps, metres.
const RANGE: f64 = 6.0;
const QUERIES: usize = 50;

pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) points: Vec<Place>,
    pub(crate) bounds: Bounds<3>,
    pub(crate) queries: Vec<Query<3>>,
}

impl Scene {
    /// As `NAME.xyz` in the folder.
    pub(crate) fn write(&self, folder: &Path) -> std::io::Result<()> {
        let lines = self.points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n"));
        let file = format!("{}-{}.xyz", self.name.replace(':', "-"), self.points.len());
        std::fs::write(folder.join(file), lines.collect::<String>())
    }
}

/// `count` points of the apartment that `seed` draws, and queries from room to room.
pub(crate) fn generated(seed: u64, count: usize) -> Result<Scene, Box<dyn Error>> {
    let name = format!("generated:{seed}");
    let world = World::named(&name, seed)?;
    let mut rng = Pcg64::seed_from_u64(seed);
    let cameras = world.reachable(HEIGHT, 0.2, 0.25).cells;
    if cameras.is_empty() || world.landmarks().is_empty() {
        return Err("an apartment without room or texture".into());
    }
    let (low, high) = world.bounds();
    let bounds = Bounds::new(low.map(|c| c + RADIUS), high.map(|c| c - RADIUS))?;
    let mut queries = Vec::new();
    while queries.len() < QUERIES {
        let [a, b] = [0, 1].map(|_| cameras[rng.random_range(0..cameras.len())]);
        if world.room_at(a) != world.room_at(b) {
            queries.push(Query::new(a, b, bounds));
        }
    }
    let points = (0..count).map(|_| triangulated(&world, &cameras, &mut rng));
    Ok(Scene {
        name,
        points: points.collect(),
        bounds,
        queries,
    })
}

/// A landmark that a camera sees, with the error of its depth.
fn triangulated(world: &World, cameras: &[Place], rng: &mut impl Rng) -> Place {
    let landmarks = world.landmarks();
    loop {
        let landmark = &landmarks[rng.random_range(0..landmarks.len())];
        let camera = cameras[rng.random_range(0..cameras.len())];
        let ray: Place = std::array::from_fn(|k| landmark.position[k] - camera[k]);
        let depth = ray.iter().map(|c| c * c).sum::<f64>().sqrt();
        if depth <= RANGE && world.sees_landmark(camera, landmark) {
            let error = ERROR * depth * depth * (2.0 * rng.random::<f64>() - 1.0);
            return std::array::from_fn(|k| landmark.position[k] + error * ray[k] / depth);
        }
    }
}

/// The recorded apartment, unless the data folder is absent.
pub(crate) fn recorded() -> Result<Option<Scene>, Box<dyn Error>> {
    let folder = std::env::var("EXPLORER_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared").to_owned());
    let stem = PathBuf::from(folder).join("data/synthetic-apartment/apt_10k_o15");
    if !stem.with_extension("npy").exists() {
        println!(
            "skipped: {} is not there (set EXPLORER_DATA)",
            stem.display()
        );
        return Ok(None);
    }
    let (points, labels) = (payload(&stem, "npy")?, payload(&stem, "labels.npy")?);
    let number = |c: &[u8]| f64::from(f32::from_le_bytes([c[0], c[1], c[2], c[3]]));
    // Label 0 is a point of a surface, anything else an outlier.
    let points = points.chunks_exact(12).zip(labels);
    let points = points.filter(|&(_, label)| label == 0);
    let points = points
        .map(|(c, _)| [0, 4, 8].map(|at| number(&c[at..])))
        .collect();
    let scene: Value = serde_json::from_slice(&std::fs::read(stem.with_extension("scene.json"))?)?;
    let vector = |value: &Value, from: usize| {
        [0, 1, 2].map(|axis| value[from + axis].as_f64().unwrap_or(f64::NAN))
    };
    let bounds = Bounds::new(vector(&scene["bounds"], 0), vector(&scene["bounds"], 3))?;
    let queries = scene["queries"].as_array().ok_or("no queries")?;
    let queries = queries
        .iter()
        .map(|query| Query::new(vector(&query[0], 0), vector(&query[1], 0), bounds))
        .collect();
    Ok(Some(Scene {
        name: "recorded".to_owned(),
        points,
        bounds,
        queries,
    }))
}

/// The bytes behind the header of a .npy file.
fn payload(stem: &Path, extension: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let bytes = std::fs::read(stem.with_extension(extension))?;
    // The length of the header stands in bytes 8 and 9.
    let start = match bytes.get(8..10) {
        Some(length) => 10 + usize::from(u16::from_le_bytes([length[0], length[1]])),
        None => return Err("not a .npy file".into()),
    };
    Ok(bytes.get(start..).unwrap_or_default().to_vec())
}
