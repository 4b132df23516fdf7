//! A real monocular ORB-SLAM3 map, brought to metres by the similarity that fits its keyframes to truth.

use flate2::read::GzDecoder;
use sparse_to_obstacles::Ray;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

pub(crate) type Vec3 = [f64; 3];

pub(crate) struct Map {
    pub(crate) points: Vec<Vec3>,
    pub(crate) rays: Vec<Ray>,
}

pub(crate) fn load(folder: &Path, poses: &[Pose]) -> Option<Map> {
    let map = folder.join("orbslam3-maps/sevenscenes_kitchen_mono_first500");
    let ply = std::fs::read_to_string(map.join("map.ply")).ok()?;
    let rows = ply
        .lines()
        .skip_while(|&line| line != "end_header")
        .skip(1)
        .map(numbers);
    let points: BTreeMap<usize, Vec3> = rows
        .map(|row| (row[7] as usize, [row[0], row[1], row[2]]))
        .collect();
    let csv = std::fs::read_to_string(map.join("keyframes.csv")).ok()?;
    let rows: Vec<Vec<f64>> = csv.lines().skip(1).map(numbers).collect();
    let place = |row: &Vec<f64>| [row[3], row[4], row[5]];
    let matches: Vec<(Vec3, Vec3)> = rows
        .iter()
        .filter_map(|row| Some((place(row), poses.get(row[1] as usize)?.translation)))
        .collect();
    let similarity = Similarity::fit(&matches);
    let keyframes: BTreeMap<usize, Vec3> = rows
        .iter()
        .map(|row| (row[0] as usize, similarity.apply(place(row))))
        .collect();
    let mut observations = String::new();
    let gz = std::fs::File::open(map.join("observations.csv.gz")).ok()?;
    GzDecoder::new(gz).read_to_string(&mut observations).ok()?;
    let rays = observations.lines().skip(1).map(numbers).flat_map(|row| {
        let end = points
            .get(&(row[0] as usize))
            .map(|&point| similarity.apply(point));
        let seen = row[1..]
            .iter()
            .filter_map(|&id| keyframes.get(&(id as usize)));
        let rays = seen.filter_map(|&origin| Some(Ray { origin, end: end? }));
        rays.collect::<Vec<_>>()
    });
    let rays = rays.collect();
    Some(Map {
        points: points
            .values()
            .map(|&point| similarity.apply(point))
            .collect(),
        rays,
    })
}

fn numbers(line: &str) -> Vec<f64> {
    line.split([',', ' '])
        .filter_map(|word| word.parse().ok())
        .collect()
}

/// A camera-to-world pose.
#[derive(Clone, Copy)]
pub(crate) struct Pose {
    pub(crate) rotation: [Vec3; 3],
    pub(crate) translation: Vec3,
}

impl Pose {
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let m: Vec<f64> = text
            .split_whitespace()
            .filter_map(|word| word.parse().ok())
            .collect();
        let row = |r: usize| Some([*m.get(4 * r)?, *m.get(4 * r + 1)?, *m.get(4 * r + 2)?]);
        let rotation = [row(0)?, row(1)?, row(2)?];
        Some(Pose {
            rotation,
            translation: [m[3], m[7], m[11]],
        })
    }

    pub(crate) fn apply(&self, p: Vec3) -> Vec3 {
        let turned = turn(&self.rotation, p);
        [0, 1, 2].map(|i| turned[i] + self.translation[i])
    }
}

fn turn(rotation: &[Vec3; 3], p: Vec3) -> Vec3 {
    [0, 1, 2].map(|i| rotation[i].iter().zip(p).map(|(a, b)| a * b).sum())
}

struct Similarity {
    scale: f64,
    pose: Pose,
}

impl Similarity {
    /// Least squares, by Horn's quaternion ("Closed-form solution of absolute orientation using unit
    /// quaternions", 1987) with a power iteration.
    fn fit(matches: &[(Vec3, Vec3)]) -> Self {
        let count = matches.len() as f64;
        let mean = |pick: fn(&(Vec3, Vec3)) -> Vec3| {
            [0, 1, 2].map(|i| matches.iter().map(|m| pick(m)[i]).sum::<f64>() / count)
        };
        let (from, to) = (mean(|m| m.0), mean(|m| m.1));
        let mut s = [[0.0; 3]; 3];
        let mut spread = 0.0;
        for (a, b) in matches {
            for i in 0..3 {
                spread += (a[i] - from[i]).powi(2);
                for j in 0..3 {
                    s[i][j] += (a[i] - from[i]) * (b[j] - to[j]);
                }
            }
        }
        let rotation = horn(&s);
        let covariance = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        let scale = covariance
            .map(|(i, j)| rotation[j][i] * s[i][j])
            .sum::<f64>()
            / spread;
        let turned = turn(&rotation, from);
        let translation = [0, 1, 2].map(|i| to[i] - scale * turned[i]);
        Similarity {
            scale,
            pose: Pose {
                rotation,
                translation,
            },
        }
    }

    fn apply(&self, p: Vec3) -> Vec3 {
        self.pose.apply(p.map(|c| c * self.scale))
    }
}

fn horn(s: &[Vec3; 3]) -> [Vec3; 3] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *s;
    let n = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let shift: f64 = n.iter().flatten().map(|v| v.abs()).sum();
    let mut q = [1.0, 0.1, 0.1, 0.1];
    for _ in 0..20_000 {
        let next: [f64; 4] = std::array::from_fn(|i| {
            shift * q[i] + n[i].iter().zip(q).map(|(a, b)| a * b).sum::<f64>()
        });
        let norm = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        q = next.map(|v| v / norm);
    }
    let [w, x, y, z] = q;
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}
