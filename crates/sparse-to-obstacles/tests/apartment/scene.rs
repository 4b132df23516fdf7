//! The synthetic apartment: points, true boxes, cameras and queries, and what is true in it.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use sparse_to_obstacles::Ray;
use std::path::PathBuf;

pub(crate) type Vec3 = [f64; 3];

pub(crate) struct Scene {
    pub(crate) inliers: Vec<Vec3>,
    pub(crate) boxes: Vec<(Vec3, Vec3)>,
    pub(crate) cameras: Vec<Vec3>,
    pub(crate) queries: Vec<(Vec3, Vec3)>,
    pub(crate) bounds: (Vec3, Vec3),
}

/// Nearer than this to its point, a line of sight may enter a true box: the depth noise of the points.
const DEPTH_NOISE: f64 = 0.15;

impl Scene {
    pub(crate) fn load() -> Option<Self> {
        let folder = std::env::var("EXPLORER_DATA")
            .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").to_owned());
        let stem = PathBuf::from(folder).join("data/synthetic-apartment/apt_10k_o15");
        let read = |extension: &str| std::fs::read(stem.with_extension(extension)).ok();
        let points = npy(&read("npy")?);
        let labels = npy(&read("labels.npy")?);
        let number = |c: &[u8]| f64::from(f32::from_le_bytes([c[0], c[1], c[2], c[3]]));
        let points = points
            .chunks_exact(12)
            .map(|c| [0, 4, 8].map(|at| number(&c[at..])));
        let inliers = points
            .zip(labels)
            .filter(|&(_, label)| label == 0)
            .map(|(point, _)| point)
            .collect();
        let scene: serde_json::Value = serde_json::from_slice(&read("scene.json")?).ok()?;
        let boxes = scene["boxes"].as_array()?.iter().map(corners).collect();
        let cameras = scene["cameras"]
            .as_array()?
            .iter()
            .map(|c| vec3(c, 0))
            .collect();
        let queries = scene["queries"].as_array()?.iter();
        let queries = queries.map(|q| (vec3(&q[0], 0), vec3(&q[1], 0))).collect();
        Some(Scene {
            inliers,
            boxes,
            cameras,
            queries,
            bounds: corners(&scene["bounds"]),
        })
    }

    /// Rays from cameras to the points that they can see in truth, at most `observers` per point.
    pub(crate) fn rays(&self, range: f64, observers: usize, seed: u64) -> Vec<Ray> {
        let mut rng = Pcg64::seed_from_u64(seed);
        let mut rays = Vec::new();
        for &end in &self.inliers {
            let mut seen: Vec<Ray> = self
                .cameras
                .iter()
                .map(|&origin| Ray { origin, end })
                .filter(|ray| self.sees(ray, range))
                .collect();
            while seen.len() > observers {
                seen.swap_remove(rng.random_range(0..seen.len()));
            }
            rays.extend(seen);
        }
        rays
    }

    fn sees(&self, ray: &Ray, range: f64) -> bool {
        let length = distance(ray.origin, ray.end);
        if length > range || length < 0.3 {
            return false;
        }
        let before = lerp(ray.origin, ray.end, 1.0 - DEPTH_NOISE / length);
        !self.crosses(ray.origin, before)
    }

    /// Does the line cross a true box?
    pub(crate) fn crosses(&self, a: Vec3, b: Vec3) -> bool {
        self.boxes.iter().any(|&(low, high)| {
            let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
            for axis in 0..3 {
                let along = b[axis] - a[axis];
                if along == 0.0 {
                    if a[axis] < low[axis] || a[axis] > high[axis] {
                        return false;
                    }
                    continue;
                }
                let (t0, t1) = (
                    (low[axis] - a[axis]) / along,
                    (high[axis] - a[axis]) / along,
                );
                enter = enter.max(t0.min(t1));
                leave = leave.min(t0.max(t1));
            }
            enter <= leave
        })
    }

    /// The least distance of places on the line, one centimetre apart, from a true box or the bounds.
    pub(crate) fn clearance(&self, a: Vec3, b: Vec3) -> f64 {
        let steps = (distance(a, b) / 0.01).ceil().max(1.0) as usize;
        (0..=steps)
            .map(|i| self.point_clearance(lerp(a, b, i as f64 / steps as f64)))
            .fold(f64::INFINITY, f64::min)
    }

    fn point_clearance(&self, point: Vec3) -> f64 {
        let to_boxes = self.boxes.iter().map(|&(low, high)| {
            let gap = [0, 1, 2].map(|i| (low[i] - point[i]).max(point[i] - high[i]).max(0.0));
            (gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2]).sqrt()
        });
        let (low, high) = self.bounds;
        let to_bounds = (0..3).flat_map(|i| [point[i] - low[i], high[i] - point[i]]);
        to_boxes.chain(to_bounds).fold(f64::INFINITY, f64::min)
    }
}

fn npy(file: &[u8]) -> Vec<u8> {
    let header = usize::from(u16::from_le_bytes([file[8], file[9]]));
    file[10 + header..].to_vec()
}

fn vec3(value: &serde_json::Value, from: usize) -> Vec3 {
    [0, 1, 2].map(|axis| value[from + axis].as_f64().unwrap_or(f64::NAN))
}

fn corners(value: &serde_json::Value) -> (Vec3, Vec3) {
    (vec3(value, 0), vec3(value, 3))
}

pub(crate) fn distance(a: Vec3, b: Vec3) -> f64 {
    [0, 1, 2]
        .map(|i| (a[i] - b[i]).powi(2))
        .iter()
        .sum::<f64>()
        .sqrt()
}

pub(crate) fn lerp(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}
