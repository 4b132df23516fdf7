//! Rubbish in is an error that names it, never a panic.

#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

use submodular_minimax::functions::{
    Coverage, Dense, FacilityLocation, FunctionError, GraphCut, Representation, Restriction, Sparse,
};
use submodular_minimax::maximize::{Greedy, LazyGreedy, MaximizeError, Maximizer};
use submodular_minimax::{Beta, OutlierConfig, OutlierError, remove_outliers};

const BAD: [f64; 4] = [-1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn square() -> Dense {
    Dense::new(2, 2, vec![1.0, 0.5, 0.5, 1.0]).unwrap()
}

#[test]
fn choosing_none_is_an_error_and_choosing_more_than_there_are_is_not() {
    let function = FacilityLocation::new(square());
    let none = Greedy::cardinality(0).maximize(&function).unwrap_err();
    assert_eq!(none, MaximizeError::NoElements);
    let none = LazyGreedy::cardinality(0).maximize(&function).unwrap_err();
    assert_eq!(none, MaximizeError::NoElements);
    for k in [3, usize::MAX] {
        let plain = Greedy::cardinality(k).maximize(&function).unwrap();
        let lazy = LazyGreedy::cardinality(k).maximize(&function).unwrap();
        assert_eq!((plain.picks, lazy.picks), (vec![0, 1], vec![0, 1]));
    }
}

#[test]
fn scores_must_be_finite_and_not_negative() {
    for bad in BAD {
        let at_one = |error| matches!(error, FunctionError::Entry { index: 1, .. });
        assert!(at_one(Dense::new(1, 2, vec![0.0, bad]).unwrap_err()));
        assert!(matches!(
            Sparse::new(vec![vec![(0, bad)]], 1).unwrap_err(),
            FunctionError::Entry { .. }
        ));
        let facility = || FacilityLocation::new(square());
        assert!(at_one(facility().truncated(vec![0.0, bad]).unwrap_err()));
        assert!(at_one(facility().weighted(vec![0.0, bad]).unwrap_err()));
        assert!(at_one(
            Coverage::new(vec![vec![0]], vec![1.0, bad]).unwrap_err()
        ));
        assert!(at_one(
            Representation::new(square(), vec![0.0, bad], 0.1).unwrap_err()
        ));
    }
}

#[test]
fn asymmetric_weights_name_the_pair() {
    let weights = Sparse::new(vec![vec![(1, 2.0)], vec![(0, 3.0)]], 2).unwrap();
    assert_eq!(
        GraphCut::new(weights).unwrap_err(),
        FunctionError::Asymmetric {
            row: 0,
            column: 1,
            value: 2.0,
            mirrored: 3.0
        }
    );
    let one_way = Sparse::new(vec![vec![(1, 2.0)], vec![]], 2).unwrap();
    let error = GraphCut::new(one_way).unwrap_err();
    assert!(matches!(error, FunctionError::Asymmetric { .. }));
}

#[test]
fn indices_outside_the_ground_set_are_named() {
    let outside = |error| {
        matches!(
            error,
            FunctionError::OutOfRange {
                element: 7,
                size: 2,
                ..
            }
        )
    };
    assert!(outside(Sparse::new(vec![vec![(7, 1.0)]], 2).unwrap_err()));
    assert!(outside(
        Coverage::new(vec![vec![7]], vec![1.0, 1.0]).unwrap_err()
    ));
    let function = FacilityLocation::new(square());
    assert!(outside(
        Restriction::new(&function, &[7], vec![0]).err().unwrap()
    ));
    assert!(outside(
        Restriction::new(&function, &[], vec![7]).err().unwrap()
    ));
}

#[test]
fn lengths_must_match() {
    let length = |error| matches!(error, FunctionError::Length { .. });
    assert!(length(Dense::new(2, 2, vec![0.0; 3]).unwrap_err()));
    let facility = || FacilityLocation::new(square());
    assert!(length(facility().truncated(vec![0.0]).unwrap_err()));
    assert!(length(facility().weighted(vec![0.0; 3]).unwrap_err()));
    assert!(length(
        Representation::new(square(), vec![0.0], 0.1).unwrap_err()
    ));
    let oblong = Sparse::new(vec![vec![]], 2).unwrap();
    assert!(length(GraphCut::new(oblong).unwrap_err()));
}

#[test]
fn beta_must_be_positive_and_finite() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let config = OutlierConfig {
            beta: Beta::Fixed(bad),
            ..OutlierConfig::default()
        };
        let error = remove_outliers(&[[0.0; 3]], None, &config).unwrap_err();
        assert!(matches!(error, OutlierError::Setting { .. }), "{bad}");
        assert!(error.to_string().contains("beta"), "{error}");
    }
}

#[test]
fn an_empty_ground_set_gives_an_empty_answer() {
    let function = FacilityLocation::new(Dense::new(0, 0, vec![]).unwrap());
    assert!(
        Greedy::cardinality(1)
            .maximize(&function)
            .unwrap()
            .picks
            .is_empty()
    );
    let none: [[f64; 3]; 0] = [];
    let found = remove_outliers(&none, None, &OutlierConfig::default()).unwrap();
    assert!(found.kept.is_empty() && found.removed.is_empty() && found.scores.is_empty());
}
