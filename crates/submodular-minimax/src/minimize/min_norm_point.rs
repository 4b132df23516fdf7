//! Fujishige-Wolfe: the point of least norm in the base polytope tells the minimiser.
//!
//! Method: 1. the base polytope of f − f(∅) is optimised over by Edmonds' greedy algorithm; 2. Wolfe's
//! method keeps a corral of bases, moves to the point of least norm in its affine hull, and drops
//! bases when that point leaves the convex hull; 3. of the level sets of the final point x the one of
//! least value is returned. Duality: f(S) ≥ f(∅) + Σ min(xₑ, 0) for every S and every base point x.
//! Cost an iteration: n gains and O(m³) for m ≤ n + 1 bases in the corral.
//!
//! References: Fujishige, Isotani, "A submodular function minimization algorithm based on the
//! minimum-norm base", Pacific J. Optimization 2011; Wolfe, "Finding the nearest point in a
//! polytope", Mathematical Programming 1976.

use super::{MinimizeError, MinimizeStop, Minimizer, Minimum};
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Exact minimisation of any submodular function, with a duality gap.
///
/// ```
/// use submodular_minimax::functions::{GraphCut, Modular, Sparse, WeightedSum};
/// use submodular_minimax::minimize::{MinNormPoint, Minimizer};
/// let edges = vec![vec![(1, 1.0)], vec![(0, 1.0), (2, 4.0)], vec![(1, 4.0)]];
/// let cut = GraphCut::new(Sparse::new(edges, 3)?)?;
/// let worth = Modular { constant: 0.0, weights: vec![0.5, -3.0, 1.0] };
/// let energy = WeightedSum::new(vec![(1.0, Box::new(&cut)), (1.0, Box::new(&worth))])?;
/// let least = MinNormPoint::default().minimize(&energy)?;
/// assert_eq!(least.set.iter().collect::<Vec<_>>(), [0, 1, 2]);
/// assert!(least.gap() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MinNormPoint {
    /// Stops when the gap is at most this times the largest gain of an element met so far, above 0; 1e-9.
    pub tolerance: f64,
    /// Major cycles at most, at least 1; 10,000.
    pub max_iterations: usize,
}

impl Default for MinNormPoint {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            max_iterations: 10_000,
        }
    }
}

impl MinNormPoint {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), MinimizeError> {
        let (value, range) = (self.tolerance, "finite and above 0");
        if !(value.is_finite() && value > 0.0) {
            return Err(MinimizeError::Setting {
                field: "tolerance",
                value,
                range,
            });
        }
        if self.max_iterations == 0 {
            let (field, range) = ("max_iterations", "at least 1");
            return Err(MinimizeError::Setting {
                field,
                value: 0.0,
                range,
            });
        }
        Ok(())
    }
}

impl Minimizer for MinNormPoint {
    fn minimize(&self, function: &dyn SetFunction) -> Result<Minimum, MinimizeError> {
        self.validate()?;
        let n = function.ground_size();
        let empty = function.value(&Subset::empty(n));
        let mut base = Base::least(function, &vec![0.0; n], empty)?;
        let mut corral = Corral {
            bases: vec![base.point.clone()],
            weights: vec![1.0],
        };
        let mut x = base.point.clone();
        // Every inner product is taken in this unit, so that squares neither overflow nor vanish.
        let mut unit = largest(&base.point);
        let mut best = Minimum {
            set: base.set.clone(),
            value: base.value,
            lower_bound: f64::NEG_INFINITY,
            iterations: 0,
            stop: MinimizeStop::IterationLimit,
        };
        while best.iterations < self.max_iterations {
            best.iterations += 1;
            base = Base::least(function, &x, empty)?;
            let bound = empty + x.iter().map(|xe| xe.min(0.0)).sum::<f64>();
            best.lower_bound = best.lower_bound.max(bound);
            if base.value < best.value
                || (base.value == best.value && base.set.len() < best.set.len())
            {
                (best.value, best.set) = (base.value, base.set.clone());
            }
            unit = unit.max(largest(&base.point));
            let [square, descent] = [&x, &base.point].map(|to| dot(&x, to, unit));
            let scale = square.max(dot(&base.point, &base.point, unit));
            let stuck = square - descent <= ROUNDING * scale;
            if best.gap() <= self.tolerance * unit || stuck {
                best.stop = MinimizeStop::Optimal;
                break;
            }
            corral.bases.push(base.point);
            corral.weights.push(0.0);
            x = corral.nearest(n, unit);
        }
        Ok(best)
    }
}

/// A vertex of the base polytope and the best of the prefixes it was made from.
struct Base {
    point: Vec<f64>,
    set: Subset,
    value: f64,
}

impl Base {
    /// Edmonds' greedy: the vertex of least inner product with `direction`.
    fn least(
        function: &dyn SetFunction,
        direction: &[f64],
        empty: f64,
    ) -> Result<Self, MinimizeError> {
        let n = direction.len();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| direction[a].total_cmp(&direction[b]).then(a.cmp(&b)));
        let mut base = Self {
            point: vec![0.0; n],
            set: Subset::empty(n),
            value: empty,
        };
        let mut growth = function.grow(&Subset::empty(n));
        let mut before = empty;
        for (size, &e) in order.iter().enumerate() {
            growth.insert(e);
            let value = growth.value();
            if !value.is_finite() {
                return Err(MinimizeError::NonFinite {
                    value,
                    elements: size + 1,
                });
            }
            base.point[e] = value - before;
            if value < base.value {
                base.value = value;
                base.set = growth.members().clone();
            }
            before = value;
        }
        Ok(base)
    }
}

/// Affinely independent bases and the convex weights of the current point.
struct Corral {
    bases: Vec<Vec<f64>>,
    weights: Vec<f64>,
}

impl Corral {
    /// Wolfe's minor cycles: the point of least norm in the convex hull, dropping idle bases.
    fn nearest(&mut self, n: usize, unit: f64) -> Vec<f64> {
        loop {
            let Some(affine) = self.affine_weights(unit) else {
                self.drop_at(self.bases.len() - 1);
                return self.point(n);
            };
            if affine.iter().all(|&a| a > IDLE) {
                self.weights = affine;
                return self.point(n);
            }
            let mut step = 1.0_f64;
            for (&w, &a) in self.weights.iter().zip(&affine) {
                if a <= IDLE && w - a > 0.0 {
                    step = step.min(w / (w - a));
                }
            }
            for (w, &a) in self.weights.iter_mut().zip(&affine) {
                *w += step * (a - *w);
            }
            let least = |best: usize, i: usize| {
                if self.weights[i] < self.weights[best] {
                    i
                } else {
                    best
                }
            };
            let idle = (0..self.weights.len()).fold(0, least);
            self.drop_at(idle);
            for i in (0..self.weights.len()).rev() {
                if self.weights[i] <= IDLE && self.weights.len() > 1 {
                    self.drop_at(i);
                }
            }
            let total: f64 = self.weights.iter().sum();
            self.weights.iter_mut().for_each(|w| *w /= total);
        }
    }

    fn drop_at(&mut self, i: usize) {
        self.bases.remove(i);
        self.weights.remove(i);
    }

    fn point(&self, n: usize) -> Vec<f64> {
        let mut x = vec![0.0; n];
        for (base, weight) in self.bases.iter().zip(&self.weights) {
            x.iter_mut().zip(base).for_each(|(x, b)| *x += weight * b);
        }
        x
    }

    /// Weights of the point of least norm in the affine hull; `None` if the bases are dependent.
    fn affine_weights(&self, unit: f64) -> Option<Vec<f64>> {
        let m = self.bases.len();
        let squares = self.bases.iter().map(|b| dot(b, b, unit));
        let scale = squares.fold(f64::MIN_POSITIVE, f64::max);
        let mut rows: Vec<Vec<f64>> = (0..m)
            .map(|i| {
                let entry = |j: usize| dot(&self.bases[i], &self.bases[j], unit) / scale + 1.0;
                (0..m).map(entry).chain([1.0]).collect()
            })
            .collect();
        let solution = solve(&mut rows)?;
        let total: f64 = solution.iter().sum();
        (total.abs() > f64::MIN_POSITIVE).then(|| solution.iter().map(|s| s / total).collect())
    }
}

/// Gauss with partial pivoting on rows [A | b].
fn solve(rows: &mut [Vec<f64>]) -> Option<Vec<f64>> {
    let m = rows.len();
    for column in 0..m {
        let larger = |a: usize, b: usize| {
            if rows[b][column].abs() > rows[a][column].abs() {
                b
            } else {
                a
            }
        };
        let pivot = (column + 1..m).fold(column, larger);
        if rows[pivot][column].abs() < DEPENDENT {
            return None;
        }
        rows.swap(column, pivot);
        let (above, below) = rows.split_at_mut(column + 1);
        let head = &above[column];
        for row in below {
            let factor = row[column] / head[column];
            row.iter_mut()
                .zip(head)
                .skip(column)
                .for_each(|(r, h)| *r -= factor * h);
        }
    }
    let mut x = vec![0.0; m];
    for i in (0..m).rev() {
        let known: f64 = (i + 1..m).map(|j| rows[i][j] * x[j]).sum();
        x[i] = (rows[i][m] - known) / rows[i][i];
    }
    Some(x)
}

/// Inner product in units of `unit`, which is not below any entry; 0 where all entries are.
fn dot(a: &[f64], b: &[f64], unit: f64) -> f64 {
    let unit = unit.max(f64::MIN_POSITIVE);
    a.iter().zip(b).map(|(a, b)| (a / unit) * (b / unit)).sum()
}

fn largest(point: &[f64]) -> f64 {
    point.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

/// A convex weight below which a base is dropped.
const IDLE: f64 = 1e-12;
/// A pivot of the bases' inner products below this is rounding: the bases are dependent.
const DEPENDENT: f64 = 1e-13;
/// A descent below this part of the squares is rounding.
const ROUNDING: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::{GraphCut, Modular, Sparse, WeightedSum};
    use crate::minimize::BruteForce;

    #[test]
    fn values_of_any_size_are_minimised_alike() {
        let edges = |w: f64| vec![vec![(1, w), (2, w)], vec![(0, w)], vec![(0, w)]];
        for size in [1e-200, 1e-9, 1.0, 1e150, 1e200, 1e300] {
            let cut = GraphCut::new(Sparse::new(edges(2.0 * size), 3).unwrap()).unwrap();
            let weights = [-3.0, 1.0, -1.5].map(|weight| weight * size).to_vec();
            let modular = Modular {
                constant: 0.0,
                weights,
            };
            let sum: WeightedSum<'_> =
                WeightedSum::new(vec![(1.0, Box::new(&cut)), (1.0, Box::new(&modular))]).unwrap();
            let found = MinNormPoint::default().minimize(&sum).unwrap();
            let exact = BruteForce.minimize(&sum).unwrap();
            assert_eq!(found.set, exact.set, "{size:e}");
            assert!(found.lower_bound <= exact.value, "{size:e} {found:?}");
            assert!(found.gap() <= 1e-8 * size, "{size:e} {found:?}");
        }
    }
}
