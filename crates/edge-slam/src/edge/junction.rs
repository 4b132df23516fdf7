//! L-junctions: places where two straight edges end together, as the corners of doors, tables and windows do.
//!
//! 1. Split chains by Douglas-Peucker; keep long runs; fit lines by total least squares.
//! 2. For each pair of ends near each other: intersect the lines; both ends must lie near the intersection, the
//!    angle must be far from straight, and pixels near the vertex must support both arms.
//! 3. With depth: corners at a jump of depth are an accident of the view (occlusion) and are dropped.

use super::line::{LineSegment, fit_line, split_chain};
use super::{EdgeChain, EdgeMap};
use crate::depth::DepthImage;

/// Parameters of [`find_junctions`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JunctionConfig {
    /// Greatest distance of a run from its chord, pixels, > 0. Default 1.5.
    pub split_tolerance: f64,
    /// Shortest straight run, pixels. Default 25.
    pub shortest_run: f64,
    /// Greatest root mean square distance of a run from its line, pixels. Default 0.8.
    pub line_rms: f64,
    /// Greatest distance of both runs' ends from the intersection, pixels. Default 6.
    pub end_distance: f64,
    /// Least angle between the arms, radians; the greatest is π minus this. Default 30 degrees.
    pub least_angle: f64,
    /// Greatest relative jump of depth across an arm. Default 0.1.
    pub depth_jump: f64,
    /// Points sampled along each arm, 5..=10. Default 8.
    pub samples: usize,
}

impl Default for JunctionConfig {
    fn default() -> Self {
        Self {
            split_tolerance: 1.5,
            shortest_run: 25.0,
            line_rms: 0.8,
            end_distance: 6.0,
            least_angle: 30_f64.to_radians(),
            depth_jump: 0.1,
            samples: 8,
        }
    }
}

/// Two arms that start at a vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct LJunction {
    /// Intersection of the two lines, pixels.
    pub vertex: [f64; 2],
    /// Unit directions away from the vertex.
    pub directions: [[f64; 2]; 2],
    /// Lengths of the arms, pixels.
    pub lengths: [f64; 2],
    /// Angle between the arms, radians.
    pub angle: f64,
}

impl LJunction {
    /// `count` places on arm 0 or 1 (others count as 1), evenly spaced from near the vertex to the end, pixels.
    pub fn arm(&self, arm: usize, count: usize) -> impl Iterator<Item = [f64; 2]> {
        let k = arm.min(1);
        let (length, [dx, dy], [x, y]) = (self.lengths[k], self.directions[k], self.vertex);
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let step = length / count.max(1) as f64;
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let along = move |i: usize| step * (i as f64 + 0.5);
        (0..count).map(move |i| [x + along(i) * dx, y + along(i) * dy])
    }
}

/// The L-junctions of an image, strongest (longest shorter arm) first, no two vertices within 3 pixels.
///
/// Without `depth`, and with one of another size than the image's, corners at jumps of depth stay. Cost: O(points + lines²).
///
/// ```
/// use edge_slam::edge::{CannyConfig, JunctionConfig, canny, find_junctions, trace_chains};
/// use edge_slam::image::GrayImage;
/// let is_door = |i: usize| (40..120).contains(&(i % 160)) && (30..90).contains(&(i / 160));
/// let pixels = (0..160 * 120).map(|i| if is_door(i) { 200 } else { 60 });
/// let edges = canny(&GrayImage::new(pixels.collect(), 160, 120)?.view(), &CannyConfig::default())?;
/// let found = find_junctions(&edges, &trace_chains(&edges, 20), None, &JunctionConfig::default());
/// assert_eq!(found.len(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn find_junctions(
    edges: &EdgeMap,
    chains: &[EdgeChain],
    depth: Option<&DepthImage>,
    config: &JunctionConfig,
) -> Vec<LJunction> {
    let same_size =
        |depth: &&DepthImage| [depth.width(), depth.height()] == [edges.width, edges.height];
    let depth = depth.filter(same_size);
    let lines = straight_runs(chains, config);
    let mut junctions = Vec::new();
    for (index, first) in lines.iter().enumerate() {
        for second in &lines[index + 1..] {
            junctions.extend(join(first, second, config));
        }
    }
    junctions.retain(|junction| {
        [0, 1]
            .iter()
            .all(|&arm| supported(edges, junction, arm, config.samples))
            && !depth.is_some_and(|depth| is_occlusion(depth, junction, config))
    });
    let weakest = |j: &LJunction| j.lengths[0].min(j.lengths[1]);
    junctions.sort_by(|a, b| weakest(b).total_cmp(&weakest(a)));
    let mut kept: Vec<LJunction> = Vec::new();
    for junction in junctions {
        let near = |other: &LJunction| {
            (other.vertex[0] - junction.vertex[0]).hypot(other.vertex[1] - junction.vertex[1]) < 3.0
        };
        if !kept.iter().any(near) {
            kept.push(junction);
        }
    }
    kept
}

fn straight_runs(chains: &[EdgeChain], config: &JunctionConfig) -> Vec<LineSegment> {
    let runs = chains.iter().flat_map(|chain| {
        split_chain(&chain.points, config.split_tolerance)
            .into_iter()
            .filter_map(|range| fit_line(&chain.points[range]))
    });
    runs.filter(|line| line.length() >= config.shortest_run && line.rms <= config.line_rms)
        .collect()
}

/// The junction of the two nearest ends, if they make one.
fn join(first: &LineSegment, second: &LineSegment, config: &JunctionConfig) -> Option<LJunction> {
    let [ax, ay] = first.direction;
    let [bx, by] = second.direction;
    let cross = ax * by - ay * bx;
    if cross.abs() < config.least_angle.sin() {
        return None;
    }
    let (dx, dy) = (
        second.start[0] - first.start[0],
        second.start[1] - first.start[1],
    );
    let along = (dx * by - dy * bx) / cross;
    let vertex = [first.start[0] + along * ax, first.start[1] + along * ay];
    let arm = |line: &LineSegment| {
        let distance = |p: &[f64; 2]| (p[0] - vertex[0]).hypot(p[1] - vertex[1]);
        let (near, far) = if distance(&line.start) <= distance(&line.end) {
            (line.start, line.end)
        } else {
            (line.end, line.start)
        };
        let length = distance(&far);
        (distance(&near) <= config.end_distance && length > 0.0).then(|| {
            (
                [(far[0] - vertex[0]) / length, (far[1] - vertex[1]) / length],
                length,
            )
        })
    };
    let ((a, long), (b, wide)) = (arm(first)?, arm(second)?);
    let angle = (a[0] * b[0] + a[1] * b[1]).clamp(-1.0, 1.0).acos();
    Some(LJunction {
        vertex,
        directions: [a, b],
        lengths: [long, wide],
        angle,
    })
}

/// Whether at least two thirds of the samples along an arm have an edge pixel within one pixel.
fn supported(edges: &EdgeMap, junction: &LJunction, arm: usize, samples: usize) -> bool {
    let hits = junction
        .arm(arm, samples)
        .filter(|&[x, y]| near_edge(edges, x, y))
        .count();
    3 * hits >= 2 * samples
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to zero first"
)]
fn near_edge(edges: &EdgeMap, x: f64, y: f64) -> bool {
    let (x, y) = (x.round().max(0.0) as usize, y.round().max(0.0) as usize);
    (y.saturating_sub(1)..=y + 1)
        .any(|v| (x.saturating_sub(1)..=x + 1).any(|u| edges.is_edge(u, v)))
}

/// Whether most samples of an arm have a jump of depth between their two sides.
fn is_occlusion(depth: &DepthImage, junction: &LJunction, config: &JunctionConfig) -> bool {
    [0, 1].iter().any(|&arm| {
        let [dx, dy] = junction.directions[arm];
        let (mut known, mut jumps) = (0, 0);
        for [x, y] in junction.arm(arm, config.samples) {
            let side = |sign: f64| depth_near(depth, x - sign * 4.0 * dy, y + sign * 4.0 * dx);
            if let (Some(a), Some(b)) = (side(1.0), side(-1.0)) {
                known += 1;
                jumps += usize::from((a - b).abs() > config.depth_jump * a.min(b));
            }
        }
        known > 0 && 2 * jumps > known
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked not negative"
)]
fn depth_near(depth: &DepthImage, x: f64, y: f64) -> Option<f64> {
    (x >= 0.0 && y >= 0.0)
        .then(|| depth.get(x.round() as usize, y.round() as usize))
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge::{CannyConfig, canny, trace_chains};
    use crate::image::GrayImage;

    fn rectangle() -> (EdgeMap, Vec<EdgeChain>) {
        let inside = |i: usize| (40..120).contains(&(i % 160)) && (30..90).contains(&(i / 160));
        let pixels = (0..160 * 120).map(|i| if inside(i) { 200 } else { 60 });
        let image = GrayImage::new(pixels.collect(), 160, 120).unwrap();
        let edges = canny(&image.view(), &CannyConfig::default()).unwrap();
        let chains = trace_chains(&edges, 20);
        (edges, chains)
    }

    #[test]
    fn a_rectangle_has_four_right_angles() {
        let (edges, chains) = rectangle();
        let junctions = find_junctions(&edges, &chains, None, &JunctionConfig::default());
        assert_eq!(junctions.len(), 4);
        for junction in &junctions {
            assert!((junction.angle.to_degrees() - 90.0).abs() < 2.0);
            let [x, y] = junction.vertex;
            assert!((x - 39.5).abs().min((x - 119.5).abs()) < 0.7, "{x}");
            assert!((y - 29.5).abs().min((y - 89.5).abs()) < 0.7, "{y}");
        }
    }

    #[test]
    fn occlusion_corners_are_dropped_and_flat_ones_stay() {
        let (edges, chains) = rectangle();
        let config = JunctionConfig::default();
        let flat = DepthImage::new(vec![2.0; 160 * 120], 160, 120).unwrap();
        assert_eq!(
            find_junctions(&edges, &chains, Some(&flat), &config).len(),
            4
        );
        let inside = |i: usize| (40..120).contains(&(i % 160)) && (30..90).contains(&(i / 160));
        let near = (0..160 * 120)
            .map(|i| if inside(i) { 1.0 } else { 2.0 })
            .collect();
        let near = DepthImage::new(near, 160, 120).unwrap();
        assert!(find_junctions(&edges, &chains, Some(&near), &config).is_empty());
        // The same at half the size would be read in the wrong places.
        let half = (0..80 * 60).map(|i| {
            if inside(2 * (i % 80) + 320 * (i / 80)) {
                1.0
            } else {
                2.0
            }
        });
        let half = DepthImage::new(half.collect(), 80, 60).unwrap();
        let plain = find_junctions(&edges, &chains, None, &config);
        assert_eq!(find_junctions(&edges, &chains, Some(&half), &config), plain);
        let unknown = DepthImage::new(vec![f32::NAN; 160 * 120], 160, 120).unwrap();
        assert_eq!(
            find_junctions(&edges, &chains, Some(&unknown), &config).len(),
            4
        );
    }
}
