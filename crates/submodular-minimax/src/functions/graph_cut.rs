//! The cut of an undirected weighted graph: submodular, symmetric, not monotone.

use super::error::FunctionError;
use super::similarity::{Similarity, Sparse};
use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;

/// f(S) = Σ of the weights of the edges between S and the rest. A gain costs the element's edges.
///
/// ```
/// use submodular_minimax::{SetFunction, Subset, functions::{GraphCut, Sparse}};
/// let edges = vec![vec![(1, 2.0)], vec![(0, 2.0), (2, 3.0)], vec![(1, 3.0)]];
/// let cut = GraphCut::new(Sparse::new(edges, 3)?)?;
/// assert_eq!(cut.value(&Subset::from_indices(3, [1])), 5.0);
/// # Ok::<(), submodular_minimax::functions::FunctionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GraphCut {
    weights: Sparse,
}

impl GraphCut {
    /// Takes a symmetric matrix of non-negative weights; the diagonal does not matter.
    ///
    /// # Errors
    /// A matrix that is not square or not symmetric.
    pub fn new(weights: Sparse) -> Result<Self, FunctionError> {
        let (rows, columns) = (weights.row_count(), weights.column_count());
        if rows != columns {
            let what = "weights (columns)";
            return Err(FunctionError::Length {
                what,
                found: columns,
                expected: rows,
            });
        }
        for row in 0..rows {
            for (column, value) in weights.row(row) {
                let mirrored = weights.at(column, row);
                if mirrored != value {
                    return Err(FunctionError::Asymmetric {
                        row,
                        column,
                        value,
                        mirrored,
                    });
                }
            }
        }
        Ok(Self { weights })
    }
}

impl SetFunction for GraphCut {
    fn ground_size(&self) -> usize {
        self.weights.row_count()
    }

    fn value(&self, set: &Subset) -> f64 {
        let outgoing = |e: usize| self.weights.row(e).filter(|&(u, _)| !set.contains(u));
        set.iter()
            .map(|e| outgoing(e).map(|(_, w)| w).sum::<f64>())
            .sum()
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        Box::new(Side {
            function: self,
            value: self.value(base),
            members: base.clone(),
        })
    }
}

struct Side<'a> {
    function: &'a GraphCut,
    value: f64,
    members: Subset,
}

impl Growth for Side<'_> {
    fn value(&self) -> f64 {
        self.value
    }

    fn gain(&self, element: usize) -> f64 {
        if self.members.contains(element) {
            return 0.0;
        }
        let signed = |(u, w): (usize, f64)| match () {
            () if u == element => 0.0,
            () if self.members.contains(u) => -w,
            () => w,
        };
        self.function.weights.row(element).map(signed).sum()
    }

    fn insert(&mut self, element: usize) {
        self.value += self.gain(element);
        self.members.insert(element);
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}
