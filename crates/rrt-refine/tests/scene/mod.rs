//! A world of boxes for a ball-shaped vehicle, checked exactly, and the recorded apartment as such a world.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a broken expectation must fail the test"
)]

use std::path::PathBuf;

use rrt_refine::{Bounds, Query};
use serde_json::Value;

/// Closed axis-aligned boxes that a ball of `radius` must not touch.
pub(crate) struct BoxWorld {
    pub(crate) boxes: Vec<([f64; 3], [f64; 3])>,
    pub(crate) radius: f64,
    /// Where the centre of the ball may be: the building without a shell of one radius.
    pub(crate) bounds: Bounds<3>,
}

impl BoxWorld {
    /// Distance from the motion to the nearest box must exceed the radius: the swept ball, exactly.
    pub(crate) fn is_free(&self, from: &[f64; 3], to: &[f64; 3]) -> bool {
        let limit = self.radius * self.radius;
        self.boxes.iter().all(|(min, max)| {
            far_apart(from, to, min, max, self.radius) || squared_gap(from, to, min, max) > limit
        })
    }
}

/// Cheap rejection: a plane of an axis separates the two by more than the radius.
fn far_apart(from: &[f64; 3], to: &[f64; 3], min: &[f64; 3], max: &[f64; 3], radius: f64) -> bool {
    (0..3).any(|k| from[k].min(to[k]) - max[k] > radius || min[k] - from[k].max(to[k]) > radius)
}

/// Squared distance between a segment and a box: along the segment it is convex and quadratic between the places where a
/// coordinate enters or leaves the box's interval.
pub(crate) fn squared_gap(from: &[f64; 3], to: &[f64; 3], min: &[f64; 3], max: &[f64; 3]) -> f64 {
    let mut cuts = vec![0.0, 1.0];
    for k in 0..3 {
        for plane in [min[k], max[k]] {
            let cut = (plane - from[k]) / (to[k] - from[k]);
            if cut > 0.0 && cut < 1.0 {
                cuts.push(cut);
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut best = cuts
        .iter()
        .map(|&t| squared_at(from, to, min, max, t))
        .fold(f64::INFINITY, f64::min);
    for pair in cuts.windows(2) {
        // On this piece the sum of (a + b t)² over the axes outside their interval.
        let (mut ab, mut bb) = (0.0, 0.0);
        for k in 0..3 {
            let (speed, middle) = (to[k] - from[k], (pair[0] + pair[1]) / 2.0);
            let here = from[k] + speed * middle;
            let side = if here < min[k] {
                min[k]
            } else if here > max[k] {
                max[k]
            } else {
                continue;
            };
            ab += (from[k] - side) * speed;
            bb += speed * speed;
        }
        let lowest = -ab / bb;
        if lowest > pair[0] && lowest < pair[1] {
            best = best.min(squared_at(from, to, min, max, lowest));
        }
    }
    best
}

fn squared_at(from: &[f64; 3], to: &[f64; 3], min: &[f64; 3], max: &[f64; 3], t: f64) -> f64 {
    (0..3)
        .map(|k| {
            let here = from[k] * (1.0 - t) + to[k] * t;
            (min[k] - here).max(here - max[k]).max(0.0).powi(2)
        })
        .sum()
}

/// The synthetic apartment with its true walls and furniture, and its start and goal pairs; `None` without the data folder.
pub(crate) fn apartment() -> Option<(BoxWorld, Vec<Query<3>>)> {
    let folder = std::env::var("EXPLORER_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").to_owned());
    let file = PathBuf::from(folder).join("data/synthetic-apartment/apt_10k_o15.scene.json");
    let Ok(text) = std::fs::read_to_string(&file) else {
        println!(
            "skipped: {} is not there (set EXPLORER_DATA)",
            file.display()
        );
        return None;
    };
    let scene: Value = serde_json::from_str(&text).expect("the scene is JSON");
    let radius = scene["drone_radius"].as_f64().expect("a radius");
    let corners = |value: &Value| {
        let v = numbers(value);
        ([v[0], v[1], v[2]], [v[3], v[4], v[5]])
    };
    let (low, high) = corners(&scene["bounds"]);
    let world = BoxWorld {
        boxes: list(&scene["boxes"]).iter().map(corners).collect(),
        radius,
        bounds: Bounds::new(low.map(|v| v + radius), high.map(|v| v - radius)).expect("a box"),
    };
    let point = |value: &Value| {
        let v = numbers(value);
        [v[0], v[1], v[2]]
    };
    let queries = list(&scene["queries"])
        .iter()
        .map(|q| Query::new(point(&q[0]), point(&q[1]), world.bounds))
        .collect();
    Some((world, queries))
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().expect("a list")
}

fn numbers(value: &Value) -> Vec<f64> {
    list(value)
        .iter()
        .map(|v| v.as_f64().expect("a number"))
        .collect()
}
