//! The accelerated assignment is Lloyd's: among ties, where digits are lost, after steps and jumps.

use super::*;

#[test]
fn accelerated_equals_lloyd_bit_for_bit() {
    for seed in 0..6 {
        for (points, clusters) in [(spread(900, seed), 40), (gridded(300, seed), 25)] {
            let lloyd = KMeansConfig {
                method: KMeansMethod::Lloyd,
                ..config(clusters)
            };
            let reference = kmeans(&points, &lloyd, &mut rng(seed)).unwrap();
            let fast = kmeans(&points, &config(clusters), &mut rng(seed)).unwrap();
            assert_eq!(reference, fast);
            assert_eq!(fast.stop, KMeansStop::Converged);
        }
    }
}

#[test]
fn the_methods_agree_where_squares_lose_digits_too() {
    for size in [1e-162, 1e-158, 1e-150, 1e130] {
        let points: Vec<Vec3> = spread(400, 5).iter().map(|p| p.map(|c| c * size)).collect();
        let lloyd = KMeansConfig {
            method: KMeansMethod::Lloyd,
            ..config(20)
        };
        let reference = kmeans(&points, &lloyd, &mut rng(1)).unwrap();
        assert_eq!(
            reference,
            kmeans(&points, &config(20), &mut rng(1)).unwrap()
        );
    }
}

#[test]
fn the_bounds_allow_for_squares_that_lose_digits() {
    // Squares of 1e-161 have one or two digits left: without an absolute slack the bounds are wrong by a tenth.
    for seed in 0..30 {
        for size in [3e-163, 1e-162, 1e-161, 1e-160] {
            let points: Vec<Vec3> = spread(300, seed)
                .iter()
                .map(|p| p.map(|c| c * size))
                .collect();
            let lloyd = KMeansConfig {
                method: KMeansMethod::Lloyd,
                ..config(30)
            };
            let reference = kmeans(&points, &lloyd, &mut rng(seed)).unwrap();
            let fast = kmeans(&points, &config(30), &mut rng(seed)).unwrap();
            assert_eq!(reference, fast, "seed {seed}, size {size}");
        }
    }
}

#[test]
fn neighbours_find_what_the_tree_finds_or_say_that_they_cannot() {
    let mut rng = rng(7);
    for (points, clusters) in [
        (spread(600, 1), 60),
        (gridded(600, 2), 60),
        (spread(40, 3), 12),
    ] {
        let mut centroids = points[..clusters].to_vec();
        let mut neighbours =
            neighbours::Neighbours::new(&centroids, &tree::CentroidTree::new(&centroids));
        let (mut told, mut asked) = (0, 0);
        for round in 0..20 {
            // Small movements wear the lists, one large one in a while breaks them.
            let size = if round % 7 == 6 { 4.0 } else { 0.05 };
            let before = centroids.clone();
            for centroid in &mut centroids {
                *centroid = centroid.map(|c| c + size * (rng.random::<f64>() - 0.5));
            }
            let tree = tree::CentroidTree::new(&centroids);
            neighbours.moved(&before, &centroids);
            neighbours.refresh(&centroids, || &tree);
            for &point in &points {
                let nearest = tree.nearest_two(point);
                asked += 1;
                if let Some(found) = neighbours.nearest_two(&centroids, point, nearest.index) {
                    told += 1;
                    assert_eq!(found.index, nearest.index);
                    assert_eq!(found.second_squared, nearest.second_squared);
                }
                let far = rng.random_range(0..clusters);
                if let Some(found) = neighbours.nearest_two(&centroids, point, far) {
                    assert_eq!(found.index, nearest.index);
                    assert_eq!(found.second_squared, nearest.second_squared);
                }
            }
        }
        assert!(5 * told > 4 * asked, "{told} of {asked}");
    }
}

#[test]
fn any_guess_of_the_labels_leads_to_the_same_assignment() {
    use iterate::Assignment as _;
    let points = spread(500, 2);
    let centroids = points[..40].to_vec();
    let mut expected = vec![0; 500];
    lloyd::Lloyd.assign(&points, &centroids, &mut expected);
    for guess in 0..40 {
        let mut labels = vec![guess; 500];
        accelerated::Accelerated::new(500).assign(&points, &centroids, &mut labels);
        assert_eq!(labels, expected);
    }
}

#[test]
fn labels_follow_centroids_that_step_and_jump_among_ties() {
    use iterate::Assignment as _;
    // Tenths are rounded, so that distances tie in one order of operations and differ by a digit in another.
    let place = |rng: &mut Pcg64| [0, 1, 2].map(|_| 0.1 * f64::from(rng.random_range(0..12_i32)));
    for seed in 0..4 {
        let mut rng = rng(seed);
        let points: Vec<Vec3> = (0..200).map(|_| place(&mut rng)).collect();
        let mut centroids: Vec<Vec3> = (0..40).map(|_| place(&mut rng)).collect();
        let (mut labels, mut expected) = (vec![0; 200], vec![0; 200]);
        let mut fast = accelerated::Accelerated::new(200);
        for round in 0..300 {
            fast.assign(&points, &centroids, &mut labels);
            lloyd::Lloyd.assign(&points, &centroids, &mut expected);
            assert_eq!(labels, expected, "seed {seed}, round {round}");
            let before = centroids.clone();
            for _ in 0..3 {
                let step = centroids[rng.random_range(0..40)].map(|c| c + 0.1);
                centroids[rng.random_range(0..40)] = step;
            }
            if round % 5 == 0 {
                centroids[rng.random_range(0..40)] = place(&mut rng);
            }
            fast.moved(&before, &centroids);
            let changed = rng.random_range(0..200);
            labels[changed] = rng.random_range(0..40);
            fast.relabelled(changed);
        }
    }
}

#[test]
fn a_tie_at_the_end_of_many_steps_is_seen() {
    use iterate::Assignment as _;
    // The second centroid leaves the point in steps until both are equally far; the sum of the steps is a digit less at times.
    for size in (1..60).map(|i| f64::from(i) / 7.0) {
        for steps in 2..40 {
            let mut fast = accelerated::Accelerated::new(1);
            let out = |step: i32| [0.6, 0.8, 0.3].map(|c| size * f64::from(step) * c);
            let at = |step: i32| [out(-steps), out(step)];
            let mut labels = [0];
            for step in 0..steps {
                fast.assign(&[[0.0; 3]], &at(step), &mut labels);
                assert_eq!(labels, [1]);
                fast.moved(&at(step), &at(step + 1));
            }
            fast.assign(&[[0.0; 3]], &at(steps), &mut labels);
            assert_eq!(labels, [0], "{steps} steps of {size}");
        }
    }
}
