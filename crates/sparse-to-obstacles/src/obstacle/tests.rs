//! Tests of obstacle sets: queries against brute force, splitting, updates, export.

use super::*;
use crate::KMeansError;
use crate::hull::HullKind;
use crate::vector::{add, distance, lerp};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn rng(seed: u64) -> Pcg64 {
    Pcg64::seed_from_u64(seed)
}

fn random_point(rng: &mut Pcg64) -> Vec3 {
    [10.0, 10.0, 3.0].map(|size| size * rng.random::<f64>())
}

fn blobs(count: usize, rng: &mut Pcg64) -> Vec<Vec3> {
    (0..count)
        .flat_map(|_| {
            let centre = random_point(rng);
            let blob: Vec<Vec3> = (0..12)
                .map(|_| add(centre, [0, 1, 2].map(|_| 0.5 * rng.random::<f64>())))
                .collect();
            blob
        })
        .collect()
}

fn brute_clearance(set: &ObstacleSet, a: Vec3, b: Vec3) -> f64 {
    let distances = set.obstacles().iter();
    distances
        .map(|hull| hull::separation(&hull.vertices, a, b, f64::NAN).upper)
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn queries_agree_with_brute_force_and_with_each_other() {
    let mut rng = rng(1);
    let points = blobs(80, &mut rng);
    let set =
        ObstacleSet::from_points(&points, &ObstacleConfig::with_clusters(80), &mut rng).unwrap();
    let (mut free, mut blocked) = (0, 0);
    for _ in 0..400 {
        let (a, b) = (random_point(&mut rng), random_point(&mut rng));
        let b = lerp(a, b, 0.3);
        let clearance = set.clearance(a, b);
        assert!((clearance - brute_clearance(&set, a, b)).abs() < 1e-9);
        for radius in [0.0, 0.1, 0.3] {
            let is_free = set.motion_is_free(a, b, radius);
            if (clearance - radius).abs() > 1e-9 {
                assert_eq!(is_free, clearance > radius);
            }
            match set.first_contact(a, b, radius) {
                None => free += 1,
                Some(contact) => {
                    blocked += 1;
                    let gap = set.point_clearance(contact.centre);
                    assert!(contact.at == 0.0 || (gap - radius).abs() < 1e-6);
                    assert!(gap <= radius + 1e-6);
                    let before = lerp(a, b, (contact.at - 1e-4).max(0.0));
                    assert!(contact.at == 0.0 || set.motion_is_free(a, before, radius * 0.999));
                }
            }
            assert_eq!(is_free, set.first_contact(a, b, radius).is_none());
        }
    }
    assert!(free > 100 && blocked > 100);
}

#[test]
fn free_motions_touch_nothing_at_any_sampled_place() {
    let mut rng = rng(2);
    let points = blobs(40, &mut rng);
    let set =
        ObstacleSet::from_points(&points, &ObstacleConfig::with_clusters(40), &mut rng).unwrap();
    for _ in 0..300 {
        let (a, b) = (random_point(&mut rng), random_point(&mut rng));
        let sampled = (0..=200).map(|i| set.point_clearance(lerp(a, b, f64::from(i) / 200.0)));
        let nearest = sampled.fold(f64::INFINITY, f64::min);
        if set.motion_is_free(a, b, 0.2) {
            assert!(nearest > 0.2);
        } else {
            assert!(nearest < 0.2 + 0.5 * distance(a, b) / 200.0 + 1e-9);
        }
    }
}

#[test]
fn every_point_is_inside_its_obstacle() {
    let mut rng = rng(3);
    let points: Vec<Vec3> = (0..600).map(|_| random_point(&mut rng)).collect();
    let set =
        ObstacleSet::from_points(&points, &ObstacleConfig::with_clusters(70), &mut rng).unwrap();
    let mut seen = vec![0; points.len()];
    for hull in set.obstacles() {
        for &index in &hull.point_indices {
            seen[index] += 1;
            let point = points[index];
            let gap = hull::separation(&hull.vertices, point, point, f64::NAN).upper;
            assert!(gap < 1e-8);
        }
    }
    assert!(seen.iter().all(|&count| count == 1));
}

#[test]
fn inputs_of_every_rank_are_obstacles() {
    let config = ObstacleConfig::with_clusters(1);
    let build = |points: &[Vec3]| ObstacleSet::from_points(points, &config, &mut rng(1)).unwrap();
    let inputs: [(&[Vec3], HullKind); 3] = [
        (&[[1.0, 0.0, 0.0]], HullKind::Point),
        (&[[1.0, -1.0, 0.0], [1.0, 1.0, 0.0]], HullKind::Segment),
        (
            &[[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 0.0, 1.0]],
            HullKind::Polygon,
        ),
    ];
    for (points, kind) in inputs {
        let set = build(points);
        assert_eq!((set.len(), set.degenerate_count()), (1, 1));
        assert_eq!(set.obstacles()[0].kind, kind);
        assert!(!set.motion_is_free([0.0; 3], [2.0, 0.0, 0.0], 0.0));
        assert!(set.motion_is_free([0.0, 0.0, 5.0], [2.0, 0.0, 5.0], 0.5));
        let contact = set.first_contact([0.0; 3], [2.0, 0.0, 0.0], 0.25).unwrap();
        assert!((contact.at - 0.375).abs() < 1e-9, "{kind:?} {contact:?}");
        assert_eq!(set.point_clearance([0.0; 3]), 1.0);
    }
}

#[test]
fn an_empty_set_is_free_everywhere() {
    let none: [Vec3; 0] = [];
    let set = ObstacleSet::from_points(&none, &ObstacleConfig::default(), &mut rng(1)).unwrap();
    assert!(set.is_empty());
    assert!(set.motion_is_free([0.0; 3], [1.0; 3], 0.3));
    assert_eq!(set.clearance([0.0; 3], [1.0; 3]), f64::INFINITY);
    assert_eq!(set.first_contact([0.0; 3], [1.0; 3], 0.3), None);
}

#[test]
fn input_that_is_not_finite_is_never_free() {
    let set = ObstacleSet::from_points(&[[5.0; 3]], &ObstacleConfig::with_clusters(1), &mut rng(1))
        .unwrap();
    assert!(!set.motion_is_free([f64::NAN, 0.0, 0.0], [0.0; 3], 0.1));
    assert!(!set.motion_is_free([0.0; 3], [0.0; 3], f64::NAN));
    assert!(!set.motion_is_free([0.0; 3], [0.0; 3], -0.1));
    assert!(set.clearance([0.0; 3], [f64::INFINITY, 0.0, 0.0]).is_nan());
    let nan = [[0.0; 3], [f64::NAN; 3]];
    let refused = ObstacleSet::from_points(&nan, &ObstacleConfig::default(), &mut rng(1));
    assert!(matches!(
        refused,
        Err(ObstacleError::KMeans(KMeansError::NotFinite { index: 1 }))
    ));
}

/// One obstacle of each rank, and a few polytopes.
fn of_every_rank() -> ObstacleSet {
    let mut points: Vec<Vec3> = (0..64)
        .map(|i| [i % 4, i / 4 % 4, i / 16].map(|c| f64::from(c) / 7.0))
        .collect();
    points.push([50.0, 0.1, 0.3]);
    points.extend([[70.0, 0.0, 0.0], [70.0, 1.0 / 3.0, 0.0]]);
    points.extend([[90.0, 0.0, 0.1], [90.0, 1.0, 0.2], [90.0, 0.3, 1.0]]);
    let labels = (0..70).map(|i| match i {
        0..64 => i / 32,
        64 => 2,
        65 | 66 => 3,
        _ => 4,
    });
    let clustering = Clustering {
        labels: labels.collect(),
        centroids: vec![[0.0; 3]; 5],
        inertia: 0.0,
        iterations: 1,
        stop: crate::KMeansStop::Converged,
    };
    ObstacleSet::from_clustering(&points, &clustering).unwrap()
}

fn numbers<T: std::str::FromStr<Err: std::fmt::Debug>>(line: &str) -> Vec<T> {
    line.split(' ').map(|word| word.parse().unwrap()).collect()
}

#[test]
fn what_is_written_as_obj_reads_back() {
    let set = of_every_rank();
    let mut text = Vec::new();
    set.write_obj(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let mut objects: Vec<(Vec<Vec3>, Vec<Vec<usize>>)> = Vec::new();
    let mut before = 0;
    for line in text.lines() {
        let (key, rest) = line.split_once(' ').unwrap();
        if key == "o" {
            assert_eq!(rest, format!("obstacle_{}", objects.len()));
            before += objects.last().map_or(0, |object| object.0.len());
            objects.push(Default::default());
            continue;
        }
        let object = objects.last_mut().unwrap();
        match key {
            "v" => object.0.push(numbers::<f64>(rest).try_into().unwrap()),
            "p" | "l" | "f" => {
                let elements: Vec<usize> = numbers(rest);
                assert_eq!(
                    elements.len(),
                    [("p", 1), ("l", 2), ("f", 3)]
                        .iter()
                        .find(|e| e.0 == key)
                        .unwrap()
                        .1
                );
                // Counted from 1, over the whole file.
                object
                    .1
                    .push(elements.iter().map(|index| index - 1 - before).collect());
            }
            _ => panic!("{line}"),
        }
    }
    assert_eq!(objects.len(), set.len());
    for ((vertices, elements), hull) in objects.iter().zip(set.obstacles()) {
        assert_eq!(*vertices, hull.vertices);
        match hull.kind {
            HullKind::Point => assert_eq!(*elements, [[0]]),
            HullKind::Segment => assert_eq!(*elements, [[0, 1]]),
            _ => assert_eq!(*elements, hull.triangles),
        }
    }
}

#[test]
fn what_is_written_as_ply_reads_back() {
    let set = of_every_rank();
    let mut text = Vec::new();
    set.write_ply(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let (header, body) = text.split_once("end_header\n").unwrap();
    assert!(header.starts_with("ply\nformat ascii 1.0\n"));
    let count = |element: &str| -> usize {
        let line = header
            .lines()
            .find_map(|line| line.strip_prefix(element))
            .unwrap();
        line.trim().parse().unwrap()
    };
    let (vertices, faces) = (count("element vertex"), count("element face"));
    let rows: Vec<&str> = body.lines().collect();
    assert_eq!(rows.len(), vertices + faces);
    let (mut at, mut face_at) = (0, vertices);
    for (number, hull) in set.obstacles().iter().enumerate() {
        for (row, vertex) in rows[at..].iter().zip(&hull.vertices) {
            let [x, y, z, obstacle] = numbers::<f64>(row)[..] else {
                panic!("{row}")
            };
            assert_eq!(([x, y, z], obstacle), (*vertex, number as f64));
        }
        for (row, [a, b, c]) in rows[face_at..].iter().zip(&hull.triangles) {
            assert_eq!(numbers::<usize>(row), [3, at + a, at + b, at + c]);
        }
        at += hull.vertices.len();
        face_at += hull.triangles.len();
    }
    assert_eq!((at, face_at), (vertices, vertices + faces));
}

#[test]
fn a_ball_is_added_exactly_round_at_faces_edges_and_corners() {
    // The unit cube, and motions that pass its face, edge and corner at a given distance, square to the nearest direction.
    let cube: Vec<Vec3> = (0..8)
        .map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from))
        .collect();
    let set =
        ObstacleSet::from_points(&cube, &ObstacleConfig::with_clusters(1), &mut rng(1)).unwrap();
    let radius = 0.2;
    for (nearest, away) in [
        ([1.0, 0.5, 0.5], [1.0, 0.0, 0.0]),
        ([1.0, 1.0, 0.5], [1.0, 1.0, 0.0]),
        ([1.0, 1.0, 1.0], [1.0, 1.0, 1.0]),
        ([1.0, 1.0, 1.0], [1.0, 2.0, 0.5]),
    ] {
        let away = crate::vector::unit(away).unwrap();
        let along = crate::vector::orthogonal(away);
        for (gap, is_free) in [(radius - 1e-8, false), (radius + 1e-8, true)] {
            let middle = add(nearest, crate::vector::scale(away, gap));
            let [a, b] = [-2.0, 2.0].map(|s| add(middle, crate::vector::scale(along, s)));
            assert!((set.clearance(a, b) - gap).abs() < 1e-9, "{away:?}");
            assert_eq!(set.motion_is_free(a, b, radius), is_free, "{away:?} {gap}");
            assert_eq!(set.first_contact(a, b, radius).is_none(), is_free);
        }
    }
}

/// Two pieces of wall at x = 2 with a doorway between y = -0.5 and 0.5.
fn doorway() -> Vec<Vec3> {
    let column = |y: f64| (0..20).map(move |i| [2.0, y, 0.1 * f64::from(i)]);
    let sides = (0..15).flat_map(|i| [0.5 + 0.1 * f64::from(i), -0.5 - 0.1 * f64::from(i)]);
    sides.flat_map(column).collect()
}

#[test]
fn a_cluster_that_rays_cross_does_not_bridge_a_doorway() {
    let points = doorway();
    let rays: Vec<Ray> = (0..20)
        .map(|i| Ray {
            origin: [0.0, 0.0, 1.0],
            end: [5.0, 0.05 * f64::from(i) - 0.5, 1.0],
        })
        .collect();
    let config = ObstacleConfig::with_clusters(1);
    let through = |set: &ObstacleSet| set.motion_is_free([1.0, 0.0, 1.0], [3.0, 0.0, 1.0], 0.2);
    let bridged = ObstacleSet::from_points(&points, &config, &mut rng(1)).unwrap();
    assert!(!through(&bridged));
    let split = ObstacleSet::from_observed_points(&points, &rays, &config, &mut rng(1)).unwrap();
    assert_eq!(split.len(), 2);
    assert!(through(&split));
    assert!(!split.motion_is_free([1.0, 1.0, 1.0], [3.0, 1.0, 1.0], 0.2));
    let few = ObstacleSet::from_observed_points(&points, &rays[..3], &config, &mut rng(1)).unwrap();
    assert!(!through(&few));
    let sparse = ObstacleConfig {
        min_split_points: points.len() + 1,
        ..config
    };
    let whole = ObstacleSet::from_observed_points(&points, &rays, &sparse, &mut rng(1)).unwrap();
    assert_eq!(whole.len(), 1);
}

#[test]
fn rays_that_end_on_an_obstacle_do_not_split_it() {
    let points: Vec<Vec3> = (0..100)
        .map(|i| [2.0, 0.1 * f64::from(i % 10), 0.1 * f64::from(i / 10)])
        .collect();
    let rays: Vec<Ray> = points
        .iter()
        .map(|&end| Ray {
            origin: [0.0, 0.5, 0.5],
            end,
        })
        .collect();
    let config = ObstacleConfig::with_clusters(1);
    let set = ObstacleSet::from_observed_points(&points, &rays, &config, &mut rng(1)).unwrap();
    assert_eq!(set.len(), 1);
}

#[test]
fn the_diameter_is_bounded_and_no_point_is_lost() {
    let mut rng = rng(6);
    let points: Vec<Vec3> = (0..300).map(|_| random_point(&mut rng)).collect();
    let config = ObstacleConfig {
        max_diameter: 2.0,
        ..ObstacleConfig::with_clusters(3)
    };
    let set = ObstacleSet::from_points(&points, &config, &mut rng).unwrap();
    let mut seen: Vec<usize> = set
        .obstacles()
        .iter()
        .flat_map(|hull| hull.point_indices.iter().copied())
        .collect();
    seen.sort_unstable();
    assert_eq!(seen, (0..points.len()).collect::<Vec<_>>());
    for hull in set.obstacles() {
        let own: Vec<Vec3> = hull
            .point_indices
            .iter()
            .map(|&index| points[index])
            .collect();
        assert!(hull::longest_axis(&own).1 <= 2.0);
    }
    let duplicates = [[1.0, 2.0, 3.0]; 9];
    let rays = [Ray {
        origin: [0.0, 2.0, 3.0],
        end: [9.0, 2.0, 3.0],
    }; 9];
    let config = ObstacleConfig {
        max_diameter: 1e-9,
        ..ObstacleConfig::with_clusters(2)
    };
    let set = ObstacleSet::from_observed_points(&duplicates, &rays, &config, &mut rng).unwrap();
    assert_eq!(set.degenerate_count(), set.len());
}

#[test]
fn an_update_takes_over_what_did_not_change() {
    let mut rng = rng(7);
    let points = blobs(60, &mut rng);
    let config = ObstacleConfig::with_clusters(60);
    let mut set = ObstacleSet::from_points(&points, &config, &mut rng).unwrap();
    let mut grown = points.clone();
    grown.extend(
        points[..12]
            .iter()
            .map(|&point| add(point, [0.01, 0.0, 0.0])),
    );
    let update = set.update(&grown, &[], &config, &mut rng).unwrap();
    assert_eq!(update.reused + update.built, set.len());
    assert!(update.reused >= 45, "{update:?}");
    for hull in set.obstacles() {
        for &index in &hull.point_indices {
            let point = grown[index];
            assert!(hull::separation(&hull.vertices, point, point, f64::NAN).upper < 1e-8);
        }
    }
    assert!(
        set.update(&[[f64::NAN; 3]], &[], &config, &mut rng)
            .is_err()
    );
    assert_eq!(set.len(), update.reused + update.built);
    let none: [Vec3; 0] = [];
    set.update(&none, &[], &config, &mut rng).unwrap();
    assert!(set.is_empty());
}

#[test]
fn an_update_gives_what_the_same_clusters_give_anew() {
    let mut rng = rng(8);
    let points = blobs(50, &mut rng);
    let config = ObstacleConfig {
        max_diameter: 0.9,
        ..ObstacleConfig::with_clusters(40)
    };
    let rays: Vec<Ray> = (0..300)
        .map(|_| Ray {
            origin: random_point(&mut rng),
            end: random_point(&mut rng),
        })
        .collect();
    let set = ObstacleSet::from_observed_points(&points, &rays, &config, &mut rng).unwrap();
    // New points, and some that a corrected map has moved a little, under the same indices.
    let mut grown = points.clone();
    for point in grown.iter_mut().step_by(37) {
        *point = add(*point, [0.003, -0.002, 0.001]);
    }
    grown.extend(blobs(4, &mut rng));
    let mut updated = set.clone();
    let update = updated
        .update(&grown, &rays, &config, &mut Pcg64::seed_from_u64(1))
        .unwrap();
    // The same warm start without a hull to take over.
    let mut anew = ObstacleSet {
        centroids: set.centroids.clone(),
        ..ObstacleSet::default()
    };
    let built = anew
        .update(&grown, &rays, &config, &mut Pcg64::seed_from_u64(1))
        .unwrap();
    assert_eq!((built.reused, built.built), (0, anew.len()));
    assert!(update.reused > 10 && update.built > 10, "{update:?}");
    assert_eq!(updated.obstacles(), anew.obstacles());
    assert_eq!(
        (updated.centroids(), updated.inertia()),
        (anew.centroids(), anew.inertia())
    );
    for _ in 0..200 {
        let (a, b) = (random_point(&mut rng), random_point(&mut rng));
        assert_eq!(updated.clearance(a, b), anew.clearance(a, b));
        assert_eq!(
            updated.first_contact(a, b, 0.1),
            anew.first_contact(a, b, 0.1)
        );
    }
}

#[test]
fn where_the_drone_is_no_hull_stays() {
    let post = |x: f64| [[x, 0.0, -1.0], [x, 0.0, 0.0], [x, 0.0, 1.0], [x, 0.2, 0.5]];
    let points: Vec<[f64; 3]> = post(0.1).into_iter().chain(post(50.0)).collect();
    let mut rng = Pcg64::seed_from_u64(1);
    let config = ObstacleConfig::with_clusters(2);
    let mut set = ObstacleSet::from_points(&points, &config, &mut rng).unwrap();
    let (here, away) = ([0.0; 3], [1.0, 0.0, 0.0]);
    assert!(!set.motion_is_free(here, away, 0.15));
    set.clear_ball(here, 0.15).unwrap();
    assert!(set.motion_is_free(here, [-1.0, 0.0, 0.0], 0.15));
    // One point lay in the ball, the other three of its hull stand alone now.
    assert_eq!(set.len(), 4);
    assert!(!set.motion_is_free([0.0, 0.0, 0.9], [1.0, 0.0, 0.9], 0.15));
    assert!(!set.motion_is_free([49.0, 0.0, 0.3], [51.0, 0.0, 0.3], 0.15));
    let before = set.obstacles().to_vec();
    set.clear_ball([2.5, 0.0, 0.0], 0.15).unwrap();
    assert_eq!(set.obstacles().len(), before.len());
    assert!(set.clear_ball([f64::NAN; 3], 0.1).is_err() && set.clear_ball(here, -1.0).is_err());
    // A map that grows afterwards is clustered anew.
    set.update(&points, &[], &config, &mut rng).unwrap();
    assert_eq!(set.len(), 2);
}
