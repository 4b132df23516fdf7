//! Every exported law macro fails on a function that breaks its law: a law that cannot fail proves nothing.

use submodular_minimax::{
    Growth, SetFunction, Split, Subset, assert_jointly_submodular, assert_monotone,
    assert_normalised, assert_submodular, laws,
};

/// A function of how many elements are chosen.
struct OfSize(fn(f64) -> f64);

impl SetFunction for OfSize {
    fn ground_size(&self) -> usize {
        4
    }

    fn value(&self, set: &Subset) -> f64 {
        (self.0)(set.iter().count() as f64)
    }
}

/// |S|, whose growth reports every gain and value with an error, or forgets what is inserted.
#[derive(Default)]
struct WrongGrowth {
    gain: f64,
    value: f64,
    forgets: bool,
}

struct Wrong<'a>(&'a WrongGrowth, Subset);

impl SetFunction for WrongGrowth {
    fn ground_size(&self) -> usize {
        4
    }

    fn value(&self, set: &Subset) -> f64 {
        set.iter().count() as f64
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        Box::new(Wrong(self, base.clone()))
    }
}

impl Growth for Wrong<'_> {
    fn value(&self) -> f64 {
        self.0.value(&self.1) + self.0.value
    }

    fn gain(&self, element: usize) -> f64 {
        if self.1.contains(element) {
            0.0
        } else {
            1.0 + self.0.gain
        }
    }

    fn insert(&mut self, element: usize) {
        if !self.0.forgets {
            self.1.insert(element);
        }
    }

    fn members(&self) -> &Subset {
        &self.1
    }
}

#[test]
fn growth_names_a_wrong_gain_and_a_wrong_value() {
    let broken = |gain, value| {
        let function = WrongGrowth {
            gain,
            value,
            forgets: false,
        };
        laws::growth(&function, 1e-9).map(|v| v.law)
    };
    assert_eq!(broken(0.0, 0.0), None);
    assert_eq!(broken(0.5, 0.0), Some("growth"));
    assert_eq!(broken(-0.5, 0.0), Some("growth"));
    assert_eq!(broken(0.0, 0.5), Some("growth"));
}

#[test]
fn growth_names_an_insertion_that_is_forgotten() {
    let function = WrongGrowth {
        forgets: true,
        ..WrongGrowth::default()
    };
    assert_eq!(laws::growth(&function, 1e-9).map(|v| v.law), Some("growth"));
}

#[test]
fn not_a_number_keeps_no_law() {
    let function = OfSize(|_| f64::NAN);
    assert!(laws::submodularity(&function, 1e-9).is_some());
    assert!(laws::monotonicity(&function, 1e-9).is_some());
    assert!(laws::normalisation(&function, 1e-9).is_some());
    assert!(laws::growth(&function, 1e-9).is_some());
}

#[test]
#[should_panic(expected = "law: \"growth\"")]
fn assert_submodular_fails_on_a_wrong_gain() {
    let function = WrongGrowth {
        gain: 0.5,
        ..WrongGrowth::default()
    };
    assert_submodular!(&function);
}

#[test]
#[should_panic(expected = "law: \"submodularity\"")]
fn assert_submodular_fails_on_a_supermodular_function() {
    assert_submodular!(&OfSize(|k| k * k));
}

#[test]
#[should_panic(expected = "law: \"submodularity\"")]
fn assert_jointly_submodular_fails_on_a_supermodular_function() {
    assert_jointly_submodular!(&Split::new(OfSize(|k| k * k), 2));
}

#[test]
#[should_panic(expected = "law: \"monotonicity\"")]
fn assert_monotone_fails_on_a_falling_function() {
    assert_monotone!(&OfSize(|k| -k));
}

#[test]
#[should_panic(expected = "law: \"normalisation\"")]
fn assert_normalised_fails_on_an_offset() {
    assert_normalised!(&OfSize(|k| k + 1.0));
}
