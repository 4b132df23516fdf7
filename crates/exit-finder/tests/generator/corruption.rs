//! Outliers of a sparse map, and a plain radius filter that stands for the cleaning before the search.

use std::collections::BTreeMap;

use rand::RngExt;
use rand_pcg::Pcg64;

/// Adds outliers until they are `rate` of the cloud: half along the ray (depth × 0.25–0.85 or
/// 1.2–2.5), a third uniform in the bounding box, the rest in clumps of 4 to 12.
pub fn corrupted(
    points: &[[f64; 3]],
    agent: [f64; 3],
    rate: f64,
    rng: &mut Pcg64,
) -> Vec<[f64; 3]> {
    let mut cloud = points.to_vec();
    let wanted = (points.len() as f64 * rate / (1.0 - rate)) as usize;
    let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|i| points.iter().fold(start, |m, p| pick(m, p[i])))
    };
    let (low, high) = (
        bound(f64::min, f64::INFINITY),
        bound(f64::max, f64::NEG_INFINITY),
    );
    let uniform = |rng: &mut Pcg64| -> [f64; 3] {
        std::array::from_fn(|i| low[i] + rng.random::<f64>() * (high[i] - low[i]))
    };
    while cloud.len() < points.len() + wanted {
        match rng.random_range(0..6) {
            0..3 => {
                let p = points[rng.random_range(0..points.len())];
                let near = rng.random_bool(0.5);
                let f = if near {
                    rng.random_range(0.25..0.85)
                } else {
                    rng.random_range(1.2..2.5)
                };
                cloud.push(std::array::from_fn(|i| agent[i] + f * (p[i] - agent[i])));
            }
            3..5 => cloud.push(uniform(rng)),
            _ if rng.random_bool(0.125) => {
                let centre = uniform(rng);
                let spread = 0.01 * (high[0] - low[0]);
                for _ in 0..rng.random_range(4..=12) {
                    cloud.push(centre.map(|x| x + spread * rng.random_range(-1.0..1.0)));
                }
            }
            _ => {}
        }
    }
    cloud
}

/// Indices of the points with at least four neighbours within four median nearest-neighbour distances, where
/// distances are divided by the range from the agent: a sparse map thins out with range.
pub fn cleaned(points: &[[f64; 3]], agent: [f64; 3]) -> Vec<usize> {
    let squared = |p: &[f64; 3], q: &[f64; 3]| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>();
    // Bearing, elevation and log range: neighbours in these coordinates are neighbours relative to range.
    let relative: Vec<[f64; 3]> = points
        .iter()
        .map(|p| {
            let d: [f64; 3] = std::array::from_fn(|i| p[i] - agent[i]);
            let flat = d[0].hypot(d[1]);
            [
                d[1].atan2(d[0]),
                (d[2] / flat).atan(),
                0.4 * flat.hypot(d[2]).ln(),
            ]
        })
        .collect();
    let mut nearest: Vec<f64> = relative
        .iter()
        .step_by((points.len() / 200).max(1))
        .map(|p| {
            relative
                .iter()
                .map(|q| squared(p, q))
                .filter(|&d| d > 0.0)
                .fold(f64::MAX, f64::min)
        })
        .collect();
    nearest.sort_by(f64::total_cmp);
    let reach = 4.0 * nearest[nearest.len() / 2].sqrt();
    let cell = |p: &[f64; 3]| p.map(|x| (x / reach).floor() as i64);
    let mut grid: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (i, p) in relative.iter().enumerate() {
        grid.entry(cell(p)).or_default().push(i);
    }
    let neighbours = |p: &[f64; 3]| {
        let [x, y, z] = cell(p);
        let cells = (0..27).map(move |k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let near = cells.filter_map(|c| grid.get(&c)).flatten();
        near.filter(|&&i| squared(p, &relative[i]) <= reach * reach)
            .count()
    };
    (0..points.len())
        .filter(|&i| neighbours(&relative[i]) > 3)
        .collect()
}
