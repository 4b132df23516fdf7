//! Edge pixels linked to chains, each point refined below a pixel.

use super::EdgeMap;

/// A point of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Column, sub-pixel: the peak of a parabola through the gradient strengths across the edge.
    pub x: f64,
    /// Row, sub-pixel.
    pub y: f64,
    /// Unit vector of the gradient, from dark to bright, at a right angle to the edge.
    pub normal: [f64; 2],
    /// Gradient, grey levels per pixel.
    pub strength: f64,
}

/// Neighbouring edge points in order.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeChain {
    /// The points; consecutive ones stem from touching pixels.
    pub points: Vec<EdgePoint>,
    /// Whether the last touches the first.
    pub closed: bool,
}

/// Links edge pixels (8 neighbours) to chains and drops those under `shortest` pixels (20 is usual).
///
/// Chains start at loose ends in reading order, then at what is left (closed curves). At a branch the straight
/// neighbour goes before the diagonal one; every pixel belongs to at most one chain. Cost: O(pixels).
#[must_use]
pub fn trace_chains(edges: &EdgeMap, shortest: usize) -> Vec<EdgeChain> {
    let mut taken = vec![false; edges.width * edges.height];
    let mut chains = Vec::new();
    for ends_only in [true, false] {
        for index in 0..taken.len() {
            let (x, y) = (index % edges.width, index / edges.width);
            if taken[index] || !edges.is_edge(x, y) || (ends_only && degree(edges, x, y) != 1) {
                continue;
            }
            let pixels = follow(edges, &mut taken, x, y);
            if pixels.len() >= shortest.max(1) {
                let closed = pixels.len() > 3
                    && pixels
                        .last()
                        .is_some_and(|&(u, v)| x.abs_diff(u) <= 1 && y.abs_diff(v) <= 1);
                let points = pixels
                    .into_iter()
                    .map(|(x, y)| refine(edges, x, y))
                    .collect();
                chains.push(EdgeChain { points, closed });
            }
        }
    }
    chains
}

/// Straight neighbours first.
const STEPS: [(isize, isize); 8] = [
    (1, 0),
    (0, 1),
    (-1, 0),
    (0, -1),
    (1, 1),
    (-1, 1),
    (-1, -1),
    (1, -1),
];

fn neighbours(edges: &EdgeMap, x: usize, y: usize) -> impl Iterator<Item = (usize, usize)> {
    STEPS
        .iter()
        .map(move |&(dx, dy)| (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy)))
        .filter(|&(x, y)| edges.is_edge(x, y))
}

fn degree(edges: &EdgeMap, x: usize, y: usize) -> usize {
    neighbours(edges, x, y).count()
}

fn follow(edges: &EdgeMap, taken: &mut [bool], x: usize, y: usize) -> Vec<(usize, usize)> {
    let mut pixels = vec![(x, y)];
    taken[y * edges.width + x] = true;
    let mut here = (x, y);
    while let Some(next) =
        neighbours(edges, here.0, here.1).find(|&(x, y)| !taken[y * edges.width + x])
    {
        taken[next.1 * edges.width + next.0] = true;
        pixels.push(next);
        here = next;
    }
    pixels
}

/// Moves an edge pixel along its gradient, by at most half a step, to the peak of a parabola.
#[expect(clippy::cast_precision_loss, reason = "pixel coordinates")]
fn refine(edges: &EdgeMap, x: usize, y: usize) -> EdgePoint {
    let [gx, gy] = edges.gradient(x, y).map(f64::from);
    let length = gx.hypot(gy).max(f64::MIN_POSITIVE);
    let normal = [gx / length, gy / length];
    // The nearest of eight neighbours along the gradient, as in the thinning.
    let toward = |component: f64| match component {
        c if c > 0.382_683 => 1_isize,
        c if c < -0.382_683 => -1,
        _ => 0,
    };
    let (dx, dy) = (toward(normal[0]), toward(normal[1]));
    let at = |sign: isize| {
        let (u, v) = (
            x.wrapping_add_signed(sign * dx),
            y.wrapping_add_signed(sign * dy),
        );
        f64::from(edges.strength(u, v))
    };
    let (before, here, behind) = (at(-1), at(0), at(1));
    let curvature = before - 2.0 * here + behind;
    let shift = if curvature < 0.0 {
        0.5 * (before - behind) / curvature
    } else {
        0.0
    };
    let shift = shift.clamp(-0.5, 0.5);
    EdgePoint {
        x: x as f64 + shift * dx as f64,
        y: y as f64 + shift * dy as f64,
        normal,
        strength: length / 8.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge::{CannyConfig, canny};
    use crate::image::GrayImage;

    /// A bright disc with a soft rim of exact radius.
    fn rim(radius: f64) -> GrayImage {
        let pixel = |i: i32| {
            let distance = f64::from(i % 80 - 40).hypot(f64::from(i / 80 - 30));
            (40.0 + 170.0 / (1.0 + (1.5 * (distance - radius)).exp())).round() as u8
        };
        GrayImage::new((0..80 * 60).map(pixel).collect(), 80, 60).unwrap()
    }

    #[test]
    fn a_rim_is_one_chain_of_sub_pixel_points() {
        let edges = canny(&rim(18.3).view(), &CannyConfig::default()).unwrap();
        let chains = trace_chains(&edges, 20);
        let longest = chains.iter().max_by_key(|c| c.points.len()).unwrap();
        assert!(longest.points.len() > 80 && longest.closed);
        let errors: Vec<f64> = longest
            .points
            .iter()
            .map(|p| ((p.x - 40.0).hypot(p.y - 30.0) - 18.3).abs())
            .collect();
        assert!(errors.iter().sum::<f64>() / (errors.len() as f64) < 0.12);
        for p in &longest.points {
            let outward = [(p.x - 40.0) / 18.3, (p.y - 30.0) / 18.3];
            assert!(p.normal[0] * outward[0] + p.normal[1] * outward[1] < -0.95);
        }
    }

    #[test]
    fn every_pixel_is_used_once() {
        let edges = canny(&rim(15.0).view(), &CannyConfig::default()).unwrap();
        let all: usize = trace_chains(&edges, 1).iter().map(|c| c.points.len()).sum();
        assert_eq!(all, edges.count());
        assert!(trace_chains(&edges, 10_000).is_empty());
    }
}
