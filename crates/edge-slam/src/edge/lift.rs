//! Edges and L-junctions in space: pixels with depth become points, arms become straight lines.
//!
//! 1. Edge point: its undistorted ray times its depth; none where depth is unknown or jumps.
//! 2. Arm of a junction: samples with the median depth of 3x3 pixels; of all lines through two of them the one
//!    that most samples agree with (within 2 % of their depth), refitted to these.
//! 3. Junction: both arms need 70 % of their samples, and the lines must nearly meet.

use nalgebra::{Matrix3, Point2, Point3, SymmetricEigen, Vector3};

use super::{EdgeChain, JunctionConfig, LJunction};
use crate::camera::Camera;
use crate::depth::DepthImage;

/// A point of an edge in the camera's frame, units of the depth.
pub type EdgePoint3 = Point3<f64>;

/// Two straight edges that start at a vertex, in the camera's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialJunction {
    /// Midpoint of the shortest stretch between the two lines, units of the depth.
    pub vertex: Point3<f64>,
    /// Unit directions away from the vertex.
    pub directions: [Vector3<f64>; 2],
    /// Angle between the arms, radians.
    pub angle: f64,
}

/// The points of a chain whose depth is known, in the camera's frame. Cost: O(points).
#[must_use]
pub fn lift_chain(chain: &EdgeChain, camera: &Camera, depth: &DepthImage) -> Vec<EdgePoint3> {
    let lift = |point: &super::EdgePoint| {
        let z = depth.bilinear(point.x, point.y)?;
        at_depth(camera, [point.x, point.y], z)
    };
    chain.points.iter().filter_map(lift).collect()
}

/// The junction in space; `None` where its arms have too little depth, are not straight in space, or do not meet.
///
/// Cost: O(samples³), samples at most 10.
#[must_use]
pub fn lift_junction(
    junction: &LJunction,
    camera: &Camera,
    depth: &DepthImage,
    config: &JunctionConfig,
) -> Option<SpatialJunction> {
    let samples = config.samples.clamp(2, MOST_SAMPLES);
    let line = |arm: usize| {
        let points: Vec<Point3<f64>> = junction
            .arm(arm, samples)
            .filter_map(|[x, y]| at_depth(camera, [x, y], median_depth(depth, x, y)?))
            .collect();
        line_through(&points, samples)
    };
    let [(p, a), (q, b)] = [line(0)?, line(1)?];
    let cosine = a.dot(&b);
    let sine_square = 1.0 - cosine * cosine;
    if !(sine_square > 1e-3) {
        return None;
    }
    // Feet of the shortest stretch between p + s a and q + t b.
    let between = p - q;
    let s = (cosine * between.dot(&b) - between.dot(&a)) / sine_square;
    let t = (between.dot(&b) - cosine * between.dot(&a)) / sine_square;
    let (foot, other) = (p + a * s, q + b * t);
    let near = (foot - other).norm() <= 2.0 * LINE_SHARE * foot.z.abs();
    let vertex = nalgebra::center(&foot, &other);
    // Lines are fitted to samples along the arm: away from the vertex is towards their middle.
    let directions = [(p, a), (q, b)].map(|(middle, direction)| {
        let outward: Vector3<f64> = middle - vertex;
        if outward.dot(&direction) < 0.0 {
            -direction
        } else {
            direction
        }
    });
    let angle = directions[0].dot(&directions[1]).clamp(-1.0, 1.0).acos();
    (near && vertex.z > 0.0).then_some(SpatialJunction {
        vertex,
        directions,
        angle,
    })
}

/// Greatest distance of a sample from its line, and half that of the two lines, as a share of the depth.
const LINE_SHARE: f64 = 0.02;
const MOST_SAMPLES: usize = 10;

fn at_depth(camera: &Camera, [x, y]: [f64; 2], z: f64) -> Option<Point3<f64>> {
    let ideal = camera.undistort(&Point2::new(x, y))?;
    Some(Point3::from(camera.pinhole.ray(&ideal) * z))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked not negative"
)]
fn median_depth(depth: &DepthImage, x: f64, y: f64) -> Option<f64> {
    if !(x >= 0.0 && y >= 0.0) {
        return None;
    }
    let (x, y) = (x.round() as usize, y.round() as usize);
    let mut near: Vec<f64> = (y.saturating_sub(1)..=y + 1)
        .flat_map(|v| (x.saturating_sub(1)..=x + 1).filter_map(move |u| depth.get(u, v)))
        .collect();
    near.sort_by(f64::total_cmp);
    near.get(near.len() / 2).copied()
}

/// Middle and unit direction of the line that most points agree with; they must be 70 % of `wanted`.
fn line_through(points: &[Point3<f64>], wanted: usize) -> Option<(Point3<f64>, Vector3<f64>)> {
    let agreeing = |from: &Point3<f64>, direction: &Vector3<f64>| -> Vec<Point3<f64>> {
        let near =
            |point: &&Point3<f64>| (*point - from).cross(direction).norm() <= LINE_SHARE * point.z;
        points.iter().filter(near).copied().collect()
    };
    let mut best: Vec<Point3<f64>> = Vec::new();
    for (index, first) in points.iter().enumerate() {
        for second in &points[index + 1..] {
            let Some(direction) = (second - first).try_normalize(1e-9) else {
                continue;
            };
            let found = agreeing(first, &direction);
            if found.len() > best.len() {
                best = found;
            }
        }
    }
    if best.len() < 2 || 10 * best.len() < 7 * wanted {
        return None;
    }
    #[expect(clippy::cast_precision_loss, reason = "at most ten")]
    let middle = Point3::from(
        best.iter().map(|point| point.coords).sum::<Vector3<f64>>() / best.len() as f64,
    );
    let scatter: Matrix3<f64> = best
        .iter()
        .map(|point| (point - middle) * (point - middle).transpose())
        .sum();
    // Eigenvalues of what is not finite are sought without end.
    if !scatter.iter().all(|value| value.is_finite()) {
        return None;
    }
    let eigen = SymmetricEigen::new(scatter);
    let direction = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    Some((middle, direction.into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PinholeCamera;
    use core::f64::consts::FRAC_PI_2;

    fn camera() -> Camera {
        Camera::ideal(PinholeCamera::new(100.0, 100.0, 80.0, 60.0).unwrap())
    }

    fn corner() -> LJunction {
        LJunction {
            vertex: [60.0, 50.0],
            directions: [[1.0, 0.0], [0.0, 1.0]],
            lengths: [40.0, 40.0],
            angle: FRAC_PI_2,
        }
    }

    #[test]
    fn a_corner_on_a_slanted_wall_is_lifted() {
        // The wall z = 2 / (1 - 0.5 x), x on the plane z = 1: z = 2 + 0.5 X.
        let wall = |i: usize| 2.0 / (1.0 - 0.5 * ((i % 160) as f32 - 80.0) / 100.0);
        let depth = DepthImage::new((0..160 * 120).map(wall).collect(), 160, 120).unwrap();
        let config = JunctionConfig::default();
        let found = lift_junction(&corner(), &camera(), &depth, &config).unwrap();
        let z = 2.0 / 1.1;
        let expected = Point3::new(-0.2 * z, -0.1 * z, z);
        // The median reads whole pixels: half a pixel of the slope is 0.01.
        assert!((found.vertex - expected).norm() < 0.02, "{}", found.vertex);
        // The row lies above the axis, so that the arm rises as it recedes.
        let along = Vector3::new(1.0, -0.05, 0.5).normalize();
        assert!(found.directions[0].dot(&along) > 0.999, "{found:?}");
        assert!(found.directions[1].y > 0.999);
        assert!((found.angle - along.y.acos()).abs() < 0.01);
    }

    #[test]
    fn arms_without_depth_or_that_miss_each_other_are_refused() {
        let config = JunctionConfig::default();
        let lift = |pixel: fn(usize) -> f32| {
            let depth = DepthImage::new((0..160 * 120).map(pixel).collect(), 160, 120).unwrap();
            lift_junction(&corner(), &camera(), &depth, &config)
        };
        assert!(lift(|_| f32::NAN).is_none());
        assert!(lift(|_| 1.5).is_some());
        // The arm to the right lies half a metre behind the one that goes down.
        assert!(lift(|i| if i % 160 > 61 { 2.0 } else { 1.5 }).is_none());
    }

    #[test]
    fn places_that_cannot_be_squared_are_no_line() {
        let pinhole = PinholeCamera::new(1e-250, 1e-250, 80.0, 60.0).unwrap();
        let depth = DepthImage::new(vec![2.0; 160 * 120], 160, 120).unwrap();
        let along_the_axes = LJunction {
            vertex: [80.0, 60.0],
            ..corner()
        };
        let config = JunctionConfig::default();
        let found = lift_junction(&along_the_axes, &Camera::ideal(pinhole), &depth, &config);
        assert!(found.is_none(), "{found:?}");
    }

    #[test]
    fn chains_keep_the_points_with_depth() {
        let point = |x: f64| crate::edge::EdgePoint {
            x,
            y: 60.0,
            normal: [0.0, 1.0],
            strength: 9.0,
        };
        let chain = EdgeChain {
            points: vec![point(30.0), point(80.0), point(400.0)],
            closed: false,
        };
        let half = |i: usize| if i % 160 < 50 { 0.0 } else { 3.0 };
        let depth = DepthImage::new((0..160 * 120).map(half).collect(), 160, 120).unwrap();
        let lifted = lift_chain(&chain, &camera(), &depth);
        assert_eq!(lifted, [Point3::new(0.0, 0.0, 3.0)]);
    }
}
