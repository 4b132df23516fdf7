//! Every ready-made function keeps the laws it claims, on random small instances.

#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

use proptest::prelude::*;
use submodular_minimax::functions::{
    Coverage, Dense, FacilityLocation, GraphCut, Kernel, Modular, Points, Representation,
    Restriction, Similarity, Sparse, WeightedSum,
};
use submodular_minimax::{
    JointFunction, SetFunction, Split, Subset, assert_jointly_submodular, assert_monotone,
    assert_normalised, assert_submodular, laws,
};

fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = Dense> {
    prop::collection::vec(prop_oneof![Just(0.0), 0.0..1.0_f64], rows * columns)
        .prop_map(move |values| Dense::new(rows, columns, values).unwrap())
}

fn sparse_of(dense: &Dense) -> Sparse {
    let rows = (0..dense.row_count()).map(|u| {
        let mut row = Vec::new();
        dense.for_each(u, &mut |v, s| row.push((v, s)));
        row
    });
    Sparse::new(rows.collect(), dense.column_count()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn facility_location_in_all_its_forms(
        dense in matrix(5, 6),
        caps in prop::collection::vec(0.0..1.0_f64, 6),
        weights in prop::collection::vec(0.0..3.0_f64, 6),
    ) {
        let plain = FacilityLocation::new(dense.clone());
        assert_submodular!(&plain);
        assert_monotone!(&plain);
        assert_normalised!(&plain);
        let full = FacilityLocation::new(sparse_of(&dense));
        let full = full.truncated(caps.clone()).unwrap().weighted(weights.clone()).unwrap();
        assert_submodular!(&full);
        assert_monotone!(&full);
        let same = FacilityLocation::new(dense).truncated(caps).unwrap().weighted(weights).unwrap();
        for mask in 0..32 {
            let set = Subset::from_mask(5, mask);
            let (a, b) = (
                SetFunction::value(&full, &set),
                SetFunction::value(&same, &set),
            );
            prop_assert!((a - b).abs() < 1e-12, "dense and sparse differ: {a} {b}");
        }
    }

    #[test]
    fn points_serve_like_their_matrix(
        points in prop::collection::vec(prop::array::uniform3(-3.0..3.0_f64), 2..7),
        kernel in prop_oneof![
            Just(Kernel::Linear { reach: 2.5 }), Just(Kernel::Rational { scale: 0.7 }),
            Just(Kernel::Reciprocal { scale: 0.7 }),
        ],
    ) {
        let function = FacilityLocation::new(Points::new(&points, kernel).unwrap());
        assert_submodular!(&function);
        let n = points.len();
        let dense = Dense::from_fn(n, n, |u, v| function.similarity().at(u, v)).unwrap();
        let full = Subset::full(n);
        let (a, b) = (
            SetFunction::value(&function, &full),
            SetFunction::value(&FacilityLocation::new(dense), &full),
        );
        prop_assert!((a - b).abs() < 1e-12);
    }

    #[test]
    fn cut_coverage_sums_and_restrictions(
        upper in prop::collection::vec(0.0..1.0_f64, 15),
        covers in prop::collection::vec(prop::collection::vec(0..7usize, 0..4), 6),
        weights in prop::collection::vec(-1.0..1.0_f64, 6),
    ) {
        let mut rows = vec![Vec::new(); 6];
        let pairs = (0..6).flat_map(|a| (a + 1..6).map(move |b| (a, b)));
        for ((a, b), w) in pairs.zip(upper) {
            rows[a].push((b, w));
            rows[b].push((a, w));
        }
        let cut = GraphCut::new(Sparse::new(rows, 6).unwrap()).unwrap();
        let coverage = Coverage::new(covers, (0..7).map(f64::from).collect()).unwrap();
        let modular = Modular { constant: 0.5, weights };
        assert_submodular!(&cut);
        assert_normalised!(&cut);
        assert_submodular!(&coverage);
        assert_monotone!(&coverage);
        assert_submodular!(&modular);
        let sum = WeightedSum::new(vec![
            (2.0, Box::new(&cut)), (0.5, Box::new(&coverage)), (1.0, Box::new(&modular)),
        ]).unwrap();
        assert_submodular!(&sum);
        assert_submodular!(&Restriction::new(&sum, &[1], vec![5, 0, 3]).unwrap());
        let doubled = Restriction::new(&sum, &[1], vec![5, 1, 5]).unwrap();
        prop_assert_eq!(laws::growth(&doubled, 1e-9), None);
        assert_jointly_submodular!(&Split::new(sum, 3));
    }

    #[test]
    fn eq_1_is_jointly_submodular_for_any_non_negative_score(
        dense in matrix(4, 4),
        lambda in prop::collection::vec(0.0..1.0_f64, 4),
        gamma in 0.0..1.0_f64,
    ) {
        let function = Representation::new(dense, lambda, gamma).unwrap();
        assert_jointly_submodular!(&function);
        for mask in 0..16 {
            let x = Subset::from_mask(4, mask);
            prop_assert_eq!(laws::growth(&function.given_x(&x), 1e-9), None);
            let modular = function.modular_given_y(&x).unwrap();
            for other in 0..16 {
                let set = Subset::from_mask(4, other);
                let (a, b) = (
                    SetFunction::value(&modular, &set),
                    function.value(&set, &x),
                );
                prop_assert!((a - b).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn eq_1_keeps_the_law_on_two_ground_sets_dense_and_sparse(
        dense in matrix(3, 5),
        lambda in prop::collection::vec(0.0..1.0_f64, 5),
    ) {
        let sparse = Representation::new(sparse_of(&dense), lambda.clone(), 0.0).unwrap();
        let dense = Representation::new(dense, lambda, 0.0).unwrap();
        assert_jointly_submodular!(&dense);
        assert_jointly_submodular!(&sparse);
        for (mask, other) in (0..32).flat_map(|x| (0..8).map(move |y| (x, y))) {
            let (x, y) = (Subset::from_mask(5, mask), Subset::from_mask(3, other));
            prop_assert!((dense.value(&x, &y) - sparse.value(&x, &y)).abs() < 1e-12);
        }
    }

    #[test]
    fn eq_1_is_not_negative_under_the_stated_condition(
        dense in matrix(6, 6),
        k in 1..5usize,
    ) {
        let lambda = k as f64 / 6.0;
        let function = Representation::new(dense, vec![lambda; 6], 1.0 / 6.0).unwrap();
        for mask in 0..64 {
            for other in 0..64 {
                let (x, y) = (Subset::from_mask(6, mask), Subset::from_mask(6, other));
                if y.len() <= k {
                    prop_assert!(function.value(&x, &y) > -1e-9);
                }
            }
        }
    }
}

#[test]
fn the_literal_score_breaks_the_law() {
    let line: [f64; 3] = [0.0, 0.3, 0.7];
    let literal = |u: usize, v: usize| {
        let d = (line[u] - line[v]).abs();
        if u == v { 0.0 } else { 1.0 - 1.0 / d }
    };
    struct Literal<F>(F);
    impl<F: Fn(usize, usize) -> f64> JointFunction for Literal<F> {
        fn x_size(&self) -> usize {
            3
        }
        fn y_size(&self) -> usize {
            3
        }
        fn value(&self, x: &Subset, y: &Subset) -> f64 {
            let best = |v: usize| {
                y.iter()
                    .map(|u| self.0(u, v))
                    .reduce(f64::max)
                    .unwrap_or(0.0)
            };
            let spread: f64 = y
                .iter()
                .flat_map(|u| y.iter().map(move |w| (u, w)))
                .map(|(u, w)| self.0(u, w))
                .sum();
            (0..3).filter(|&v| !x.contains(v)).map(best).sum::<f64>() - spread / 3.0
                + 0.6 * x.len() as f64
        }
    }
    assert!(laws::joint_submodularity(&Literal(literal), 1e-9).is_some());
}

/// A set function that only counts its members.
struct OfSize(fn(f64) -> f64);

impl SetFunction for OfSize {
    fn ground_size(&self) -> usize {
        4
    }

    fn value(&self, set: &Subset) -> f64 {
        (self.0)(set.len() as f64)
    }
}

#[test]
fn every_law_can_fail_and_says_which() {
    let squared = OfSize(|k| k * k);
    let found = laws::submodularity(&squared, 1e-9).unwrap();
    assert_eq!(
        (found.law, found.left, found.right),
        ("submodularity", 2.0, 4.0)
    );
    let falling = OfSize(|k| -k);
    let found = laws::monotonicity(&falling, 1e-9).unwrap();
    assert_eq!(
        (found.law, found.left, found.right),
        ("monotonicity", -1.0, 0.0)
    );
    let lifted = OfSize(|_| 1.0);
    let found = laws::normalisation(&lifted, 1e-9).unwrap();
    assert_eq!((found.law, found.left), ("normalisation", 1.0));
    assert_eq!(laws::submodularity(&OfSize(f64::sqrt), 1e-9), None);
}
