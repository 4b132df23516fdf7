//! The ranged reading's scores against its definition, term by term, by brute force.
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

use proptest::prelude::*;
use submodular_minimax::{
    AmongCameras, Cues, DepthSource, ImageNeighbours, OutlierConfig, RayConfig, Tolerance, Views,
    remove_outliers,
};

type Point = [f64; 3];

fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

fn bearing(from: Point, to: Point) -> Point {
    let length = distance(from, to);
    [0, 1, 2].map(|i| (to[i] - from[i]) / length)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}

/// A cloud with observations, all of which the definition looks at.
#[derive(Debug)]
struct Scene {
    points: Vec<Point>,
    cameras: Vec<Point>,
    observers: Vec<Vec<usize>>,
    reach: Vec<Option<f64>>,
}

impl Scene {
    fn ranges(&self) -> Vec<f64> {
        let range = |v: usize| {
            let seen = self.observers[v].iter();
            median(
                seen.map(|&c| distance(self.points[v], self.cameras[c]))
                    .collect(),
            )
        };
        // What nobody observes is as far as the nearest point that somebody does.
        let nearest = |v: usize| {
            let observed = (0..self.points.len()).filter(|&u| !self.observers[u].is_empty());
            let to = |u: &usize| distance(self.points[*u], self.points[v]);
            observed.min_by(|a, b| to(a).total_cmp(&to(b))).unwrap()
        };
        (0..self.points.len()).map(|v| range(nearest(v))).collect()
    }

    /// min over u of D(u) + d(u, v).
    fn badness(&self, ranges: &[f64], exponent: f64) -> Vec<f64> {
        let n = self.points.len();
        let nearest = |v: usize| {
            let far = |u: usize| {
                distance(self.points[u], self.points[v])
                    / (ranges[u] * ranges[v]).powf(exponent / 2.0)
            };
            let mut all: Vec<(f64, usize)> =
                (0..n).filter(|&u| u != v).map(|u| (far(u), u)).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all.truncate(20);
            all
        };
        let near: Vec<Vec<(f64, usize)>> = (0..n).map(nearest).collect();
        let density = |v: usize| near[v].iter().map(|x| x.0).sum::<f64>() / near[v].len() as f64;
        let through = |v: usize| near[v].iter().map(|&(d, u)| density(u) + d);
        (0..n)
            .map(|v| through(v).fold(f64::INFINITY, f64::min))
            .collect()
    }

    /// Disagreements with the wide and the near image neighbours.
    fn disagreements(&self, v: usize, wider: ImageNeighbours) -> [f64; 2] {
        let row = &self.observers[v];
        if row.is_empty() {
            return [f64::NAN; 2];
        }
        let mut asked = vec![row[0], row[row.len() / 2], row[row.len() - 1]];
        asked.dedup();
        // A camera that sees fewer than 50 points tells nothing.
        let sees = |camera: usize| {
            self.observers
                .iter()
                .filter(|o| o.contains(&camera))
                .count()
        };
        asked.retain(|&camera| sees(camera) >= 50);
        if asked.is_empty() {
            return [f64::NAN; 2];
        }
        let (mut wide, mut near) = (Vec::new(), f64::INFINITY);
        for camera in asked {
            let from = self.cameras[camera];
            let own = bearing(from, self.points[v]);
            let depth = |u: usize| distance(from, self.points[u]).ln();
            let mut others: Vec<(f64, f64)> = (0..self.points.len())
                .filter(|&u| u != v && self.observers[u].contains(&camera))
                .map(|u| {
                    let apart = distance(own, bearing(from, self.points[u]));
                    (apart, (depth(u) - depth(v)).abs())
                })
                .collect();
            others.sort_by(|a, b| a.0.total_cmp(&b.0));
            let ranked = |count: usize, rank: usize| {
                let mut depths: Vec<f64> = others[..count].iter().map(|o| o.1).collect();
                depths.sort_by(f64::total_cmp);
                depths[rank - 1]
            };
            wide.push(ranked(wider.count, wider.rank));
            near = near.min(ranked(12, 3));
        }
        let wide = match wider.cameras {
            AmongCameras::Median => median(wide),
            AmongCameras::Largest => wide.into_iter().fold(0.0, f64::max),
        };
        [wide, near]
    }

    fn parallax(&self, v: usize) -> f64 {
        let row = &self.observers[v];
        if row.len() < 2 {
            return 0.0;
        }
        let rays: Vec<Point> = (row.iter())
            .map(|&c| bearing(self.cameras[c], self.points[v]))
            .collect();
        let sum = [0, 1, 2].map(|i| rays.iter().map(|ray| ray[i]).sum::<f64>());
        let mean = bearing([0.0; 3], sum);
        let farthest = rays.iter().map(|&ray| distance(ray, mean));
        4.0 * (farthest.fold(0.0, f64::max) / 2.0).asin()
    }

    /// Rays of cameras that do not see v: how many end well behind it, how many well before it.
    fn passing(&self, v: usize, rays: &RayConfig) -> [f64; 2] {
        let mut count = [0.0; 2];
        for (camera, &from) in self.cameras.iter().enumerate() {
            if self.observers[v].contains(&camera) {
                continue;
            }
            let (own, range) = (
                bearing(from, self.points[v]),
                distance(from, self.points[v]),
            );
            for u in (0..self.points.len()).filter(|&u| self.observers[u].contains(&camera)) {
                let length = distance(from, self.points[u]);
                let apart = distance(own, bearing(from, self.points[u]));
                if apart <= 2.0 * (rays.angle / 2.0).sin() {
                    count[0] += f64::from(u8::from(length > rays.margin * range));
                    count[1] += f64::from(u8::from(range > rays.margin * length));
                }
            }
        }
        count
    }

    /// What every point's score must be.
    fn scores(&self, weights: &Cues, rays: &RayConfig) -> Vec<f64> {
        let (n, ranges) = (self.points.len(), self.ranges());
        let badness = self.badness(&ranges, weights.range_exponent);
        let typical = median(ranges.clone());
        let coarse: Vec<Option<f64>> = (0..n).map(|v| Some(self.reach[v]? / ranges[v])).collect();
        let usual = median(coarse.iter().copied().flatten().chain([]).collect());
        let all = (0..n).map(|v| self.disagreements(v, weights.depth_neighbours));
        let all: Vec<[f64; 2]> = all.collect();
        let known = |at: usize| all.iter().map(move |d| d[at]).filter(|d| !d.is_nan());
        let usual_depths = [0, 1].map(|at| median(known(at).collect()));
        let judged = |v: usize| {
            let told = |at: usize| {
                if all[v][at].is_nan() {
                    usual_depths[at]
                } else {
                    all[v][at]
                }
            };
            let (wide, near) = (told(0), told(1));
            let [violating, hiding] = self.passing(v, rays);
            badness[v]
                * (wide + 0.02).powf(weights.depth_exponent)
                * (near + 0.02).powf(weights.near_depth_exponent)
                * (1.0 + violating).powf(weights.violation_exponent)
                * (1.0 + hiding).powf(weights.hidden_exponent)
                * (ranges[v] / typical).powf(weights.far_exponent)
                * (self.parallax(v) + 0.005).powf(weights.parallax_exponent)
                * coarse[v].unwrap_or(usual).powf(weights.coarseness_exponent)
        };
        let judged: Vec<f64> = (0..n).map(judged).collect();
        let middle = median(judged.clone());
        let decile = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values[values.len() * 9 / 10]
        };
        let tolerance = match weights.tolerance {
            Tolerance::Fixed(times) => times,
            Tolerance::BySpread(times) => {
                let spread = (decile(judged.clone()) / middle).ln();
                (times * spread.powf(0.7)).clamp(1.0, 3.0).exp()
            }
            Tolerance::ByDirt { least } => (0.08 / decile(known(1).collect()))
                .min(2.2)
                .exp()
                .max(least),
            _ => unreachable!("no other tolerance"),
        };
        let score = |bad: &f64| (bad / (tolerance * middle)).ln();
        judged.iter().map(score).collect()
    }
}

fn scene() -> impl Strategy<Value = Scene> {
    let point = (
        -1.0..1.0_f64,
        -1.0..1.0_f64,
        prop_oneof![Just(3.0), 2.0..6.0_f64],
    );
    let row = (0..5usize, any::<[bool; 5]>());
    let rows = prop::collection::vec(
        (point, row, prop::option::weighted(0.7, 2.0..30.0_f64)),
        110..150,
    );
    let camera = (-0.6..0.6_f64, -0.6..0.6_f64, -0.3..0.3_f64);
    let cameras = prop::collection::vec(camera, 5);
    (rows, cameras).prop_map(|(rows, cameras)| {
        let observers = |first: usize, more: [bool; 5]| {
            // Cameras 0 to 3 see about every second point, the last one nearly all.
            let seen = |c: usize| c == first || more[c] || (c == 4 && more[0] != more[1]);
            let nobody = more == [true, true, true, false, false];
            (0..5)
                .filter(|&c| seen(c) && !nobody)
                .collect::<Vec<usize>>()
        };
        Scene {
            points: rows.iter().map(|r| [r.0.0, r.0.1, r.0.2]).collect(),
            cameras: cameras.iter().map(|c| [c.0, c.1, c.2]).collect(),
            observers: (rows.iter()).map(|r| observers(r.1.0, r.1.1)).collect(),
            reach: rows.iter().map(|r| r.2).collect(),
        }
    })
}

fn weights() -> impl Strategy<Value = Cues> {
    let exponent = || prop_oneof![Just(0.0), 0.1..1.2_f64];
    let tolerance = prop_oneof![
        (1.5..9.0_f64).prop_map(Tolerance::Fixed),
        (0.8..3.0_f64).prop_map(Tolerance::BySpread),
        (1.1..4.0_f64).prop_map(|least| Tolerance::ByDirt { least }),
    ];
    let exponents = prop::array::uniform8(exponent());
    let neighbours = (12..45_usize).prop_flat_map(|count| (Just(count), 1..=count));
    let cameras = prop_oneof![Just(AmongCameras::Median), Just(AmongCameras::Largest)];
    let neighbours = (neighbours, cameras).prop_map(|((count, rank), cameras)| ImageNeighbours {
        count,
        rank,
        cameras,
    });
    (exponents, tolerance, neighbours).prop_map(|(e, tolerance, neighbours)| Cues {
        range_exponent: e[0],
        depth_exponent: e[1],
        depth_neighbours: neighbours,
        near_depth_exponent: e[2],
        violation_exponent: e[3],
        far_exponent: e[4],
        parallax_exponent: e[5],
        coarseness_exponent: e[6],
        hidden_exponent: e[7],
        tolerance,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn scores_are_what_the_definition_says(
        scene in scene(), cues in weights(), measured in any::<bool>(),
    ) {
        let mut config = OutlierConfig::default();
        config.rays.angle = 0.05;
        // The other weights would be told by their tolerance.
        let other = Cues { tolerance: Tolerance::Fixed(1e6), ..cues };
        let rays = &mut config.rays;
        (rays.measured, rays.triangulated) = if measured { (cues, other) } else { (other, cues) };
        rays.source = if measured { DepthSource::Measured } else { DepthSource::Triangulated };
        let views = Views::new(scene.cameras.clone(), scene.observers.clone()).unwrap();
        let views = views.with_max_distances(scene.reach.clone()).unwrap();
        let found = remove_outliers(&scene.points, Some(&views), &config).unwrap();
        let wanted = scene.scores(&cues, &config.rays);
        for (v, (found, wanted)) in found.scores.iter().zip(&wanted).enumerate() {
            let same = found == wanted || (found - wanted).abs() < 1e-7;
            prop_assert!(same, "point {}: {} for {}", v, found, wanted);
        }
    }
}
