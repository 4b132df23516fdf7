//! Maximisers, minimisers and minimax algorithms against exhaustive search.

#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

use proptest::prelude::*;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use submodular_minimax::functions::{Coverage, Dense, FacilityLocation, GraphCut, Modular};
use submodular_minimax::functions::{Representation, Sparse, WeightedSum};
use submodular_minimax::maximize::{
    Constraint, Exhaustive, Greedy, LazyGreedy, Maximizer, RandomGreedy, StochasticGreedy,
};
use submodular_minimax::minimax::{
    best_response, iterative_x_growing, max_then_min, min_as_oracle, min_by_singletons,
};
use submodular_minimax::minimize::{BruteForce, MinNormPoint, MinimizeStop, Minimizer};
use submodular_minimax::{Beta, JointFunction, MinimaxConfig, SetFunction, StopReason, Subset};

fn cut_with_weights(n: usize) -> impl Strategy<Value = (GraphCut, Modular)> {
    let pairs = n * (n - 1) / 2;
    let edges = prop::collection::vec(prop_oneof![Just(0.0), 0.0..1.0_f64], pairs);
    (edges, prop::collection::vec(-2.0..2.0_f64, n)).prop_map(move |(edges, weights)| {
        let mut rows = vec![Vec::new(); n];
        let pairs = (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b)));
        for ((a, b), w) in pairs.zip(edges) {
            rows[a].push((b, w));
            rows[b].push((a, w));
        }
        let cut = GraphCut::new(Sparse::new(rows, n).unwrap()).unwrap();
        (
            cut,
            Modular {
                constant: 0.25,
                weights,
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn min_norm_point_equals_brute_force((cut, modular) in cut_with_weights(9)) {
        let sum: WeightedSum<'_> =
            WeightedSum::new(vec![(1.0, Box::new(&cut)), (1.0, Box::new(&modular))]).unwrap();
        let exact = BruteForce.minimize(&sum).unwrap();
        let found = MinNormPoint::default().minimize(&sum).unwrap();
        prop_assert_eq!(found.stop, MinimizeStop::Optimal);
        prop_assert!((found.value - exact.value).abs() < 1e-7, "{} {}", found.value, exact.value);
        prop_assert!((sum.value(&found.set) - found.value).abs() < 1e-9);
        prop_assert!(found.lower_bound <= exact.value + 1e-9);
        prop_assert!(found.gap() < 1e-6);
    }

    #[test]
    fn greedy_keeps_its_factor_and_lazy_greedy_its_picks(
        covers in prop::collection::vec(prop::collection::vec(0..9usize, 0..5), 9),
        weights in prop::collection::vec(0.0..2.0_f64, 9),
        costs in prop::collection::vec(0.2..2.0_f64, 9),
        k in 1..5usize,
    ) {
        let function = Coverage::new(covers, weights).unwrap();
        let knapsack = Constraint::Knapsack { costs, budget: 2.5 };
        for constraint in [Constraint::Cardinality(k), knapsack] {
            let mut greedy = Greedy { constraint: constraint.clone() };
            let mut lazy = LazyGreedy { constraint: constraint.clone() };
            let best = Exhaustive { constraint: constraint.clone() }.maximize(&function).unwrap();
            let found = greedy.maximize(&function).unwrap();
            let fast = lazy.maximize(&function).unwrap();
            prop_assert_eq!(&found.picks, &fast.picks);
            prop_assert!(constraint.allows(&found.set));
            prop_assert!(found.value >= greedy.factor(true).unwrap() * best.value - 1e-9);
            prop_assert!(constraint.upper_bound(&function) >= best.value - 1e-9);
            prop_assert!((function.value(&found.set) - found.value).abs() < 1e-9);
        }
    }

    #[test]
    fn random_oracles_repeat_for_a_seed_and_keep_the_constraint(
        (cut, _) in cut_with_weights(8), k in 1..6usize, seed in any::<u64>(),
    ) {
        let run = || {
            let mut rng = Pcg64::seed_from_u64(seed);
            let a = RandomGreedy::cardinality(k, &mut rng).maximize(&cut).unwrap();
            let b = StochasticGreedy::cardinality(k, 0.2, &mut rng).maximize(&cut).unwrap();
            (a, b)
        };
        let (a, b) = run();
        prop_assert!(a.set.len() <= k && b.set.len() <= k);
        prop_assert!((cut.value(&a.set) - a.value).abs() < 1e-9);
        prop_assert_eq!(run(), (a, b));
    }

    #[test]
    fn minimax_bounds_hold_on_enumerable_instances(
        values in prop::collection::vec(0.0..1.0_f64, 16),
        beta in prop_oneof![Just(Beta::Sqrt), Just(Beta::Fixed(1.0)), Just(Beta::Fixed(0.3))],
        exact_oracle in any::<bool>(),
    ) {
        let (n, k) = (4, 2);
        let similarity = Dense::new(n, n, values).unwrap();
        let lambda = vec![k as f64 / n as f64; n];
        let f = Representation::new(similarity, lambda, 1.0 / n as f64).unwrap();
        let worst = |x: &Subset| {
            (0..16).map(|m| Subset::from_mask(n, m)).filter(|y| y.len() <= k)
                .map(|y| f.value(x, &y)).fold(f64::NEG_INFINITY, f64::max)
        };
        let tau = (0..16).map(|m| worst(&Subset::from_mask(n, m))).fold(f64::INFINITY, f64::min);
        let max_min = (0..16).map(|m| Subset::from_mask(n, m)).filter(|y| y.len() <= k)
            .map(|y| (0..16).map(|m| f.value(&Subset::from_mask(n, m), &y))
                .fold(f64::INFINITY, f64::min))
            .fold(f64::NEG_INFINITY, f64::max);
        let (mut exact, mut greedy) = (Exhaustive::cardinality(k), Greedy::cardinality(k));
        let oracle: &mut dyn Maximizer = if exact_oracle { &mut exact } else { &mut greedy };
        let config = MinimaxConfig { beta, ..MinimaxConfig::default() };

        let grown = iterative_x_growing(&f, oracle, &BruteForce, &config).unwrap();
        let b = beta.value(n);
        if exact_oracle {
            let t = grown.iterations as f64;
            prop_assert!(worst(&grown.x) <= (2.0 + (t - 1.0) / b + b) * tau + 1e-9);
        }
        prop_assert!(grown.iterations <= n + 1);
        prop_assert_ne!(grown.stop, StopReason::IterationLimit);
        let singles = min_by_singletons(&f, oracle, &BruteForce).unwrap();
        prop_assert!(worst(&singles.x) <= (n as f64 + 1.0) * tau + 1e-9);
        // h(X) = f(X) + Σ f(X ∪ {u}), of which theirs is the least.
        let h = |x: &Subset| {
            let alone = (0..n).map(|u| f.value(x, &Subset::from_indices(n, [u]))).sum::<f64>();
            f.value(x, &Subset::empty(n)) + alone
        };
        let least = (0..16).map(|m| h(&Subset::from_mask(n, m))).fold(f64::INFINITY, f64::min);
        prop_assert!(h(&singles.x) <= least + 1e-9);
        let others = [
            best_response(&f, oracle, &BruteForce, &config).unwrap(),
            max_then_min(&f, oracle, &BruteForce).unwrap(),
        ];
        // Best-Response meets the empty set first and the answer of Max-and-then-Min next, and keeps the best.
        let nothing = oracle.constraint().upper_bound(f.given_x(&Subset::empty(n)).as_ref());
        let met = nothing.min(others[1].certificate.upper_bound);
        prop_assert!(others[0].certificate.upper_bound <= met + 1e-9);
        for solution in [&grown, &singles].into_iter().chain(&others) {
            prop_assert!(solution.certificate.lower_bound <= tau + 1e-9);
            prop_assert!(worst(&solution.x) <= solution.certificate.upper_bound + 1e-9);
            prop_assert!(solution.value <= worst(&solution.x) + 1e-9);
        }
        let guarded = min_as_oracle(&f, oracle, &BruteForce).unwrap();
        prop_assert!(guarded.certificate.lower_bound <= max_min + 1e-9);
        prop_assert!(guarded.certificate.upper_bound >= max_min - 1e-9);
        if exact_oracle {
            prop_assert!((guarded.value - max_min).abs() < 1e-9);
        }
    }

    #[test]
    fn the_general_minimiser_and_the_closed_form_grow_the_same_set(
        values in prop::collection::vec(0.0..1.0_f64, 36), lambda in 0.05..0.6_f64,
    ) {
        struct Opaque<'a>(&'a Representation<Dense>);
        impl JointFunction for Opaque<'_> {
            fn x_size(&self) -> usize { self.0.x_size() }
            fn y_size(&self) -> usize { self.0.y_size() }
            fn value(&self, x: &Subset, y: &Subset) -> f64 { self.0.value(x, y) }
        }
        let f = Representation::new(Dense::new(6, 6, values).unwrap(), vec![lambda; 6], 0.1).unwrap();
        let config = MinimaxConfig::paper();
        let mut oracle = Greedy::cardinality(3);
        let closed = iterative_x_growing(&f, &mut oracle, &BruteForce, &config).unwrap();
        let searched =
            iterative_x_growing(&Opaque(&f), &mut oracle, &MinNormPoint::default(), &config).unwrap();
        prop_assert_eq!(&closed.x, &searched.x);
        prop_assert_eq!(closed.iterations, searched.iterations);
        prop_assert!((closed.value - searched.value).abs() < 1e-9);
    }
}

#[test]
fn facility_location_over_no_elements_is_empty() {
    let function = FacilityLocation::new(Dense::new(0, 0, vec![]).unwrap());
    let found = LazyGreedy::cardinality(3).maximize(&function).unwrap();
    assert!(found.picks.is_empty());
    assert_eq!(
        MinNormPoint::default().minimize(&function).unwrap().value,
        0.0
    );
}
