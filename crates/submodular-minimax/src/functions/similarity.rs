//! s(u, v) ≥ 0: how well facility u serves client v, dense, sparse (CSR) or computed from points.

use super::error::{FunctionError, non_negative};
use crate::points::{Cloud, PointLike, squared_distance};

/// A matrix of non-negative similarities, facilities by clients. It need not be symmetric.
pub trait Similarity {
    /// How many facilities there are.
    fn row_count(&self) -> usize;

    /// How many clients there are.
    fn column_count(&self) -> usize;

    /// Calls `visit(v, s(u, v))` for every client v with s(u, v) > 0, v ascending.
    fn for_each(&self, u: usize, visit: &mut dyn FnMut(usize, f64));

    /// s(u, v).
    fn at(&self, u: usize, v: usize) -> f64 {
        let mut found = 0.0;
        self.for_each(u, &mut |column, s| {
            if column == v {
                found = s;
            }
        });
        found
    }

    /// Σ_v weight(v) max(0, min(s(u, v), cap(v)) − served(v)), the gain of facility location.
    ///
    /// The terms are added in ascending order of v for sparse rows, in eight interleaved lanes for
    /// dense ones: a fixed order, so the bits are the same everywhere.
    fn gain(&self, u: usize, served: &[f64], caps: Option<&[f64]>, weights: Option<&[f64]>) -> f64 {
        let mut sum = 0.0;
        self.for_each(u, &mut |v, s| {
            let capped = caps.map_or(s, |caps| s.min(caps[v]));
            let more = (capped - served[v]).max(0.0);
            sum += weights.map_or(more, |weights| weights[v] * more);
        });
        sum
    }
}

/// A dense row-major matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
}

impl Dense {
    /// `values[u * columns + v]` = s(u, v).
    ///
    /// # Errors
    /// A length other than rows · columns, an entry that is negative or not finite.
    pub fn new(rows: usize, columns: usize, values: Vec<f64>) -> Result<Self, FunctionError> {
        non_negative("values", &values, rows.saturating_mul(columns))?;
        Ok(Self {
            columns,
            rows,
            values,
        })
    }

    /// Computes every entry.
    ///
    /// # Errors
    /// An entry that is negative or not finite.
    pub fn from_fn(
        rows: usize,
        columns: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Result<Self, FunctionError> {
        let entry = &entry;
        let values = (0..rows)
            .flat_map(|u| (0..columns).map(move |v| entry(u, v)))
            .collect();
        Self::new(rows, columns, values)
    }
}

impl Similarity for Dense {
    fn row_count(&self) -> usize {
        self.rows
    }

    fn column_count(&self) -> usize {
        self.columns
    }

    fn for_each(&self, u: usize, visit: &mut dyn FnMut(usize, f64)) {
        let row = &self.values[u * self.columns..(u + 1) * self.columns];
        for (v, &s) in row.iter().enumerate().filter(|entry| *entry.1 > 0.0) {
            visit(v, s);
        }
    }

    fn at(&self, u: usize, v: usize) -> f64 {
        self.values[u * self.columns + v]
    }

    fn gain(&self, u: usize, served: &[f64], caps: Option<&[f64]>, weights: Option<&[f64]>) -> f64 {
        let row = &self.values[u * self.columns..(u + 1) * self.columns];
        if caps.is_none() && weights.is_none() {
            return lanes(row.len(), |v| (row[v] - served[v]).max(0.0));
        }
        lanes(row.len(), |v| {
            let capped = caps.map_or(row[v], |caps| row[v].min(caps[v]));
            let more = (capped - served[v]).max(0.0);
            weights.map_or(more, |weights| weights[v] * more)
        })
    }
}

/// A compressed-sparse-row matrix: entries that are not stored are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Sparse {
    columns: usize,
    offsets: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl Sparse {
    /// `rows[u]` = (v, s(u, v)) in any order; a column named twice keeps its larger entry.
    ///
    /// # Errors
    /// A column out of range, an entry that is negative or not finite.
    pub fn new(rows: Vec<Vec<(usize, f64)>>, columns: usize) -> Result<Self, FunctionError> {
        let mut sparse = Self {
            columns,
            offsets: vec![0],
            entries: Vec::new(),
        };
        for (index, mut row) in rows.into_iter().enumerate() {
            if let Some(&(element, _)) = row.iter().find(|entry| entry.0 >= columns) {
                let (what, size) = ("rows", columns);
                return Err(FunctionError::OutOfRange {
                    what,
                    index,
                    element,
                    size,
                });
            }
            if let Some(&(_, value)) = row.iter().find(|e| !(e.1.is_finite() && e.1 >= 0.0)) {
                return Err(FunctionError::Entry {
                    what: "rows",
                    index,
                    value,
                });
            }
            row.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            row.dedup_by_key(|entry| entry.0);
            sparse
                .entries
                .extend(row.into_iter().map(|(v, s)| (v as u32, s)));
            sparse.offsets.push(sparse.entries.len());
        }
        Ok(sparse)
    }

    /// The n x n matrix whose column v has the entries `column(v)` = (u, s(u, v)), by counting.
    pub(crate) fn transposed<I: Iterator<Item = (usize, f64)>>(
        n: usize,
        column: impl Fn(usize) -> I,
    ) -> Self {
        let mut offsets = vec![0; n + 1];
        for v in 0..n {
            column(v).for_each(|(u, _)| offsets[u + 1] += 1);
        }
        for u in 0..n {
            offsets[u + 1] += offsets[u];
        }
        let mut next = offsets.clone();
        let mut entries = vec![(0, 0.0); offsets[n]];
        for v in 0..n {
            for (u, s) in column(v) {
                entries[next[u]] = (v as u32, s);
                next[u] += 1;
            }
        }
        Self {
            columns: n,
            offsets,
            entries,
        }
    }

    /// The stored entries of row u, columns ascending.
    pub fn row(&self, u: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let entries = &self.entries[self.offsets[u]..self.offsets[u + 1]];
        entries.iter().map(|&(v, s)| (v as usize, s))
    }
}

impl Similarity for Sparse {
    fn row_count(&self) -> usize {
        self.offsets.len() - 1
    }

    fn column_count(&self) -> usize {
        self.columns
    }

    fn for_each(&self, u: usize, visit: &mut dyn FnMut(usize, f64)) {
        self.row(u)
            .filter(|entry| entry.1 > 0.0)
            .for_each(|(v, s)| visit(v, s));
    }

    fn at(&self, u: usize, v: usize) -> f64 {
        let entries = &self.entries[self.offsets[u]..self.offsets[u + 1]];
        let found = entries.binary_search_by_key(&(v as u32), |entry| entry.0);
        found.map_or(0.0, |at| entries[at].1)
    }
}

/// How similarity falls with distance d. All lie in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kernel {
    /// (1 − d / reach)₊; with the largest distance as reach what apricot makes of Euclidean distances.
    Linear {
        /// Where it reaches 0, in the unit of the points, above 0.
        reach: f64,
    },
    /// 1 / (1 + d / scale), what submodlib makes of Euclidean distances at scale 1.
    Reciprocal {
        /// Where it is one half, in the unit of the points, above 0.
        scale: f64,
    },
    /// 1 / (1 + (d / scale)²).
    Rational {
        /// Where it is one half, in the unit of the points, above 0.
        scale: f64,
    },
}

/// Similarities computed from points on demand: memory stays linear in n.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) z: Vec<f64>,
    pub(super) kernel: Kernel,
}

impl Points {
    /// Every point is facility and client; `kernel` lengths are in the unit of the points.
    ///
    /// # Errors
    /// A point that is not finite, a kernel length that is not finite and above 0.
    pub fn new<P: PointLike>(points: &[P], kernel: Kernel) -> Result<Self, FunctionError> {
        let what = "points";
        let cloud = Cloud::new(points).map_err(|at| FunctionError::Entry {
            what,
            index: at.0,
            value: f64::NAN,
        })?;
        let (Kernel::Linear { reach: length }
        | Kernel::Reciprocal { scale: length }
        | Kernel::Rational { scale: length }) = kernel;
        if !(length.is_finite() && length > 0.0) {
            return Err(FunctionError::Entry {
                what: "kernel",
                index: 0,
                value: length,
            });
        }
        let kernel = match kernel {
            Kernel::Linear { reach } => Kernel::Linear {
                reach: reach / cloud.unit,
            },
            Kernel::Reciprocal { scale } => Kernel::Reciprocal {
                scale: scale / cloud.unit,
            },
            Kernel::Rational { scale } => Kernel::Rational {
                scale: scale / cloud.unit,
            },
        };
        let axis = |a: usize| cloud.points.iter().map(|p| p[a]).collect();
        Ok(Self {
            x: axis(0),
            y: axis(1),
            z: axis(2),
            kernel,
        })
    }

    pub(super) fn point(&self, u: usize) -> [f64; 3] {
        [self.x[u], self.y[u], self.z[u]]
    }

    /// The kernel of a squared distance.
    pub(super) fn evaluate(&self, squared: f64) -> f64 {
        match self.kernel {
            Kernel::Linear { reach } => (1.0 - squared.sqrt() / reach).max(0.0),
            Kernel::Reciprocal { scale } => 1.0 / (1.0 + squared.sqrt() / scale),
            Kernel::Rational { scale } => 1.0 / (1.0 + squared / (scale * scale)),
        }
    }
}

impl Similarity for Points {
    fn row_count(&self) -> usize {
        self.x.len()
    }

    fn column_count(&self) -> usize {
        self.x.len()
    }

    fn for_each(&self, u: usize, visit: &mut dyn FnMut(usize, f64)) {
        for v in 0..self.x.len() {
            let s = self.at(u, v);
            if s > 0.0 {
                visit(v, s);
            }
        }
    }

    fn at(&self, u: usize, v: usize) -> f64 {
        self.evaluate(squared_distance(self.point(u), self.point(v)))
    }

    fn gain(&self, u: usize, served: &[f64], caps: Option<&[f64]>, weights: Option<&[f64]>) -> f64 {
        let center = self.point(u);
        let squared = |v: usize| squared_distance(center, self.point(v));
        if caps.is_some() || weights.is_some() {
            return lanes(self.x.len(), |v| {
                let s = self.evaluate(squared(v));
                let capped = caps.map_or(s, |caps| s.min(caps[v]));
                let more = (capped - served[v]).max(0.0);
                weights.map_or(more, |weights| weights[v] * more)
            });
        }
        pulp::Arch::new().dispatch(PlainGain {
            points: self,
            center,
            served,
        })
    }
}

/// The gain without caps and weights, compiled for the widest vectors; nothing is fused, so the bits
/// do not depend on their width.
struct PlainGain<'a> {
    points: &'a Points,
    center: [f64; 3],
    served: &'a [f64],
}

impl pulp::WithSimd for PlainGain<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> f64 {
        let (points, center) = (self.points, self.center);
        let (x, y, z) = (&points.x[..], &points.y[..], &points.z[..]);
        let n = x.len().min(y.len()).min(z.len()).min(self.served.len());
        let (x, y, z, served) = (&x[..n], &y[..n], &z[..n], &self.served[..n]);
        let squared = |v: usize| {
            let (a, b, c) = (center[0] - x[v], center[1] - y[v], center[2] - z[v]);
            a * a + b * b + c * c
        };
        match points.kernel {
            Kernel::Linear { reach } => lanes(n, |v| {
                ((1.0 - squared(v).sqrt() / reach).max(0.0) - served[v]).max(0.0)
            }),
            Kernel::Reciprocal { scale } => lanes(n, |v| {
                (1.0 / (1.0 + squared(v).sqrt() / scale) - served[v]).max(0.0)
            }),
            Kernel::Rational { scale } => {
                let area = scale * scale;
                lanes(n, |v| {
                    (1.0 / (1.0 + squared(v) / area) - served[v]).max(0.0)
                })
            }
        }
    }
}

/// Σ term(v) in eight interleaved lanes, added up in order: vectorises, same bits on every machine.
#[inline(always)]
fn lanes(n: usize, term: impl Fn(usize) -> f64) -> f64 {
    let mut sums = [0.0; 8];
    let whole = n - n % 8;
    for start in (0..whole).step_by(8) {
        for (lane, sum) in sums.iter_mut().enumerate() {
            *sum += term(start + lane);
        }
    }
    for v in whole..n {
        sums[v - whole] += term(v);
    }
    sums.iter().sum()
}
