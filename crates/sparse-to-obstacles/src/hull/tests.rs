//! Tests of hulls: every rank, thin and far sets, distances against dense sampling.

use super::*;
use crate::vector::{Vec3, add, cross, distance, dot, lerp, norm, scale, sub};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn hull(points: &[Vec3]) -> Hull {
    build(points, (0..points.len()).collect())
}

/// Points in a box of these sizes, turned by an arbitrary rotation.
fn turned_box(sizes: Vec3, count: usize, rng: &mut Pcg64) -> Vec<Vec3> {
    let x = crate::vector::unit([0.3, -0.8, 0.52]).unwrap();
    let y = crate::vector::orthogonal(x);
    let z = cross(x, y);
    (0..count)
        .map(|_| {
            let [a, b, c] = sizes.map(|size| size * (rng.random::<f64>() - 0.5));
            add(
                [4.0, 5.0, -3.0],
                add(scale(x, a), add(scale(y, b), scale(z, c))),
            )
        })
        .collect()
}

fn contains(hull: &Hull, point: Vec3, tolerance: f64) -> bool {
    separation(&hull.vertices, point, point, f64::NAN).upper <= tolerance
}

#[test]
fn every_rank_is_recognised_and_contains_its_points() {
    let mut rng = Pcg64::seed_from_u64(1);
    for (sizes, kind) in [
        ([1.0, 1.0, 1.0], HullKind::Polytope),
        ([1.0, 0.003, 0.003], HullKind::Polytope),
        ([1.0, 1.0, 0.01], HullKind::Polytope),
        ([1.0, 0.5, 1e-4], HullKind::Polygon),
        ([1.0, 0.5, 0.0], HullKind::Polygon),
        ([1.0, 1e-4, 1e-4], HullKind::Segment),
        ([1.0, 0.0, 0.0], HullKind::Segment),
    ] {
        for _ in 0..40 {
            let points = turned_box(sizes, 30, &mut rng);
            let hull = hull(&points);
            assert_eq!(hull.kind, kind, "{sizes:?}");
            for &point in &points {
                assert!(contains(&hull, point, 2e-9), "{sizes:?} {point:?}");
            }
            for &vertex in &hull.vertices {
                let nearest = points
                    .iter()
                    .map(|&p| distance(p, vertex))
                    .fold(9.0, f64::min);
                assert!(nearest < 0.5);
            }
        }
    }
}

#[test]
fn needles_that_defeat_hull_code_keep_their_length() {
    let mut rng = Pcg64::seed_from_u64(2);
    for thickness in [1e-2, 3e-3, 1.1e-3, 1e-3, 9e-4, 1e-5, 1e-9] {
        for _ in 0..100 {
            let points = turned_box([1.0, thickness, thickness], 30, &mut rng);
            let hull = hull(&points);
            // Queries in a hull as thin as this are exact to 1e-7 of its length.
            assert!(points.iter().all(|&point| contains(&hull, point, 1e-7)));
        }
    }
}

#[test]
fn degenerate_points_give_documented_hulls() {
    let point = [1.0, -2.0, 3.0];
    assert_eq!(hull(&[point]).kind, HullKind::Point);
    assert_eq!(hull(&[point; 20]).kind, HullKind::Point);
    assert_eq!(hull(&[point; 20]).vertices, [point]);
    let pair = hull(&[point, [2.0, -2.0, 3.0], point]);
    assert_eq!((pair.kind, pair.vertices.len()), (HullKind::Segment, 2));
    let line: Vec<Vec3> = (0..10)
        .map(|i| [f64::from(i), 2.0 * f64::from(i), 0.0])
        .collect();
    assert_eq!(hull(&line).kind, HullKind::Segment);
    assert_eq!(hull(&line).vertices.len(), 2);
    let square: Vec<Vec3> = (0..25)
        .map(|i| [f64::from(i % 5), f64::from(i / 5), 1.0])
        .collect();
    let flat = hull(&square);
    assert_eq!(
        (flat.kind, flat.vertices.len(), flat.triangles.len()),
        (HullKind::Polygon, 4, 4)
    );
    let triangle = hull(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(
        (triangle.kind, triangle.vertices.len()),
        (HullKind::Polygon, 3)
    );
    let cube: Vec<Vec3> = (0..125)
        .map(|i| [i % 5, i / 5 % 5, i / 25].map(f64::from))
        .collect();
    assert_eq!(hull(&cube).kind, HullKind::Polytope);
    assert_eq!(hull(&cube).vertices.len(), 8);
}

#[test]
fn scale_and_far_origins_do_not_matter() {
    let mut rng = Pcg64::seed_from_u64(3);
    let unit = turned_box([1.0, 0.7, 0.3], 30, &mut rng);
    for factor in [1e-12, 1e-3, 1e9] {
        let points: Vec<Vec3> = unit.iter().map(|&point| scale(point, factor)).collect();
        let hull = hull(&points);
        assert_eq!(hull.kind, HullKind::Polytope);
        assert!(
            points
                .iter()
                .all(|&point| contains(&hull, point, 1e-8 * factor))
        );
    }
}

#[test]
fn faces_look_outwards() {
    let mut rng = Pcg64::seed_from_u64(4);
    for sizes in [[1.0, 0.8, 0.6], [1.0, 0.8, 5e-4], [1.0, 5e-4, 5e-4]] {
        let points = turned_box(sizes, 30, &mut rng);
        let hull = hull(&points);
        let sum = hull
            .vertices
            .iter()
            .fold([0.0; 3], |sum, &vertex| add(sum, vertex));
        let centre = scale(sum, 1.0 / hull.vertices.len() as f64);
        for face in &hull.triangles {
            let [a, b, c] = face.map(|vertex| hull.vertices[vertex]);
            assert!(
                dot(cross(sub(b, a), sub(c, a)), sub(a, centre)) >= 0.0,
                "{sizes:?}"
            );
        }
    }
}

/// The distance by dense sampling of the segment against every triangle.
fn sampled_distance(hull: &Hull, a: Vec3, b: Vec3) -> f64 {
    let steps = 400;
    (0..=steps)
        .map(|i| {
            let point = lerp(a, b, f64::from(i) / f64::from(steps));
            let triangles = hull
                .triangles
                .iter()
                .map(|face| face.map(|v| hull.vertices[v]));
            triangles
                .map(|[p, q, r]| to_triangle(point, p, q, r))
                .fold(f64::INFINITY, f64::min)
        })
        .fold(f64::INFINITY, f64::min)
}

fn to_triangle(point: Vec3, p: Vec3, q: Vec3, r: Vec3) -> f64 {
    let normal = cross(sub(q, p), sub(r, p));
    let height = dot(sub(point, p), normal) / norm(normal);
    let foot = sub(point, scale(normal, height / norm(normal)));
    let inside = [(p, q), (q, r), (r, p)]
        .iter()
        .all(|&(s, t)| dot(cross(sub(t, s), sub(foot, s)), normal) >= 0.0);
    if inside {
        return height.abs();
    }
    let edge = |s: Vec3, t: Vec3| {
        let along = sub(t, s);
        let at = (dot(sub(point, s), along) / dot(along, along)).clamp(0.0, 1.0);
        distance(point, lerp(s, t, at))
    };
    edge(p, q).min(edge(q, r)).min(edge(r, p))
}

#[test]
fn separation_agrees_with_dense_sampling() {
    let mut rng = Pcg64::seed_from_u64(5);
    for sizes in [[1.0, 0.8, 0.6], [1.0, 0.8, 0.0], [1.0, 0.02, 0.01]] {
        for _ in 0..60 {
            let hull = hull(&turned_box(sizes, 12, &mut rng));
            let mut end = || {
                add(
                    [4.0, 5.0, -3.0],
                    [0, 1, 2].map(|_| 4.0 * rng.random::<f64>() - 2.0),
                )
            };
            let (a, b) = (end(), end());
            let exact = separation(&hull.vertices, a, b, f64::NAN);
            assert!(exact.lower <= exact.upper + 1e-12);
            assert!(exact.upper - exact.lower <= 1e-7, "{exact:?}");
            if exact.upper > 1e-6 {
                let sampled = sampled_distance(&hull, a, b);
                assert!(exact.upper <= sampled + 1e-9 && sampled <= exact.upper + 0.02);
            }
        }
    }
}

proptest! {
    #[test]
    fn integer_grids_never_lose_a_point(
        cells in prop::collection::vec(prop::array::uniform3(0_i32..4), 1..40),
    ) {
        let points: Vec<Vec3> = cells.iter().map(|cell| cell.map(f64::from)).collect();
        let hull = hull(&points);
        for &point in &points {
            prop_assert!(contains(&hull, point, 1e-8));
        }
    }

    #[test]
    fn bounds_meet(
        vertices in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..20),
        a in prop::array::uniform3(-3.0..3.0_f64),
        b in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let found = separation(&vertices, a, b, f64::NAN);
        prop_assert!(found.lower <= found.upper + 1e-12);
        prop_assert!(found.upper - found.lower <= 1e-7);
    }
}
