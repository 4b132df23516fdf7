//! A rule to compare with: median range in a window of ±5 degrees over the median of its ±50 degrees, half maximum as the
//! sector. It always names an exit.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "shared by tests and examples, each uses its part"
)]

use exit_finder::AffinePlane;

/// Half the window and half the neighbourhood, degrees.
const WINDOW: usize = 5;
const NEIGHBOURHOOD: usize = 50;
/// Half the height band, as a share of the median range.
const BAND: f64 = 0.25;
/// Points that a window needs.
const LEAST: usize = 6;

/// The sector with the largest ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contrast {
    pub bearing_rad: f64,
    pub width_rad: f64,
    pub ratio: f64,
}

/// The rule's exit, `None` where too few points are at flying height.
pub fn exit(points: &[[f64; 3]], agent: [f64; 3], plane: &AffinePlane) -> Option<Contrast> {
    let (centre, level) = (plane.project(agent), plane.height(agent));
    let polar = |&p: &[f64; 3]| {
        let q = plane.project(p);
        let offset = [q[0] - centre[0], q[1] - centre[1]];
        let degrees = offset[1].atan2(offset[0]).to_degrees().rem_euclid(360.0);
        (
            degrees as usize % 360,
            offset[0].hypot(offset[1]),
            plane.height(p) - level,
        )
    };
    let seen: Vec<(usize, f64, f64)> = points.iter().map(polar).collect();
    let reach = BAND * median(seen.iter().map(|p| p.1).collect())?;
    let mut bins = vec![Vec::new(); 360];
    for (bin, range, _) in seen.iter().filter(|p| p.2.abs() < reach) {
        bins[*bin].push(*range);
    }
    let around = |bin: usize, half: usize| (bin + 360 - half..=bin + 360 + half).map(|k| k % 360);
    let window = |bin: usize| {
        let ranges: Vec<f64> = around(bin, WINDOW).flat_map(|k| bins[k].clone()).collect();
        (ranges.len() >= LEAST).then(|| median(ranges)).flatten()
    };
    let windows: Vec<Option<f64>> = (0..360).map(window).collect();
    let ratio = |bin: usize| {
        let neighbours = around(bin, NEIGHBOURHOOD)
            .filter_map(|k| windows[k])
            .collect();
        Some(windows[bin]? / median(neighbours)?)
    };
    let ratios: Vec<f64> = (0..360).map(|bin| ratio(bin).unwrap_or(0.0)).collect();
    let best = (0..360).max_by(|&a, &b| ratios[a].total_cmp(&ratios[b]))?;
    let half = 1.0 + 0.5 * (ratios[best] - 1.0);
    let run = |step: usize| {
        (1..180)
            .take_while(|k| ratios[(best + k * step) % 360] > half)
            .count()
    };
    let (before, after) = (run(359), run(1));
    let start = best as f64 - before as f64;
    let width = (before + after + 1) as f64;
    Some(Contrast {
        bearing_rad: (start + 0.5 * width).to_radians(),
        width_rad: width.to_radians(),
        ratio: ratios[best],
    })
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len().checked_sub(1)? / 2).copied()
}
