//! Essential matrices from five matched rays (Nistér, "An Efficient Solution to the Five-Point Relative Pose
//! Problem", PAMI 2004).
//!
//! 1. E = x X + y Y + z Z + W, the null space of the five equations x₂ᵀ E x₁ = 0.
//! 2. det E = 0 and 2 E Eᵀ E − tr(E Eᵀ) E = 0 are ten cubics in x, y, z.
//! 3. Elimination leaves a 3x3 matrix of polynomials in z whose determinant has degree ten.
//! 4. Each real root z gives x and y linearly, so up to ten matrices.

use nalgebra::{Matrix3, Vector3};

use super::polynomial::real_roots;

/// All real E with x₂ᵀ E x₁ = 0 for five pairs of rays, at most 10, each of Frobenius norm √2.
///
/// Rays need not have unit length. Degenerate samples (repeated pairs, numbers that are not finite) may give
/// none. Cost: some ten microseconds.
#[must_use]
pub fn essential_from_five(
    first: &[Vector3<f64>; 5],
    second: &[Vector3<f64>; 5],
) -> Vec<Matrix3<f64>> {
    let Some(basis) = null_space(first, second) else {
        return Vec::new();
    };
    let Some(rows) = eliminate(constraints(&basis)) else {
        return Vec::new();
    };
    let matrix = [
        subtract(&rows[4], &rows[5]),
        subtract(&rows[6], &rows[7]),
        subtract(&rows[8], &rows[9]),
    ];
    let solve = |z: f64| {
        let (x, y) = back_substitute(&matrix, z)?;
        let mut essential = Matrix3::zeros();
        for (k, weight) in [x, y, z, 1.0].into_iter().enumerate() {
            essential += Matrix3::from_row_slice(&basis[k]) * weight;
        }
        let norm = essential.norm();
        (norm > 0.0 && norm.is_finite()).then(|| essential * (core::f64::consts::SQRT_2 / norm))
    };
    real_roots(&determinant(&matrix), 1e3)
        .into_iter()
        .filter_map(solve)
        .collect()
}

type Row9 = [f64; 9];

/// Four orthonormal vectors at a right angle to the five equations, by elimination with full pivoting.
fn null_space(first: &[Vector3<f64>; 5], second: &[Vector3<f64>; 5]) -> Option<[Row9; 4]> {
    let mut rows: [Row9; 5] =
        core::array::from_fn(|k| core::array::from_fn(|i| second[k][i / 3] * first[k][i % 3]));
    let mut order: [usize; 9] = core::array::from_fn(|i| i);
    for step in 0..5 {
        let (mut best, mut pivot) = (0.0, (step, step));
        for (r, row) in rows.iter().enumerate().skip(step) {
            for (c, &column) in order.iter().enumerate().skip(step) {
                if row[column].abs() > best {
                    (best, pivot) = (row[column].abs(), (r, c));
                }
            }
        }
        if !(best > 1e-12 && best.is_finite()) {
            return None;
        }
        rows.swap(step, pivot.0);
        order.swap(step, pivot.1);
        let lead = rows[step];
        let lead = lead.map(|value| value / lead[order[step]]);
        rows[step] = lead;
        for (r, row) in rows.iter_mut().enumerate() {
            let factor = row[order[step]];
            if r != step {
                row.iter_mut()
                    .zip(&lead)
                    .for_each(|(value, l)| *value -= factor * l);
            }
        }
    }
    let mut basis = [[0.0; 9]; 4];
    for (k, vector) in basis.iter_mut().enumerate() {
        vector[order[5 + k]] = 1.0;
        for (r, row) in rows.iter().enumerate() {
            vector[order[r]] = -row[order[5 + k]];
        }
    }
    orthonormalise(&mut basis);
    Some(basis)
}

fn orthonormalise(basis: &mut [Row9; 4]) {
    for k in 0..4 {
        for j in 0..k {
            let dot: f64 = basis[k].iter().zip(&basis[j]).map(|(a, b)| a * b).sum();
            let other = basis[j];
            basis[k]
                .iter_mut()
                .zip(&other)
                .for_each(|(value, o)| *value -= dot * o);
        }
        let norm = basis[k].iter().map(|v| v * v).sum::<f64>().sqrt();
        basis[k].iter_mut().for_each(|value| *value /= norm);
    }
}

// Monomials by their exponents (x, y, z), in the order of the paper's elimination table.
const LINEAR: [[u8; 3]; 4] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]];
const QUADRATIC: [[u8; 3]; 10] = [
    [2, 0, 0],
    [1, 1, 0],
    [1, 0, 1],
    [1, 0, 0],
    [0, 2, 0],
    [0, 1, 1],
    [0, 1, 0],
    [0, 0, 2],
    [0, 0, 1],
    [0, 0, 0],
];
const CUBIC: [[u8; 3]; 20] = [
    [3, 0, 0],
    [0, 3, 0],
    [2, 1, 0],
    [1, 2, 0],
    [2, 0, 1],
    [2, 0, 0],
    [0, 2, 1],
    [0, 2, 0],
    [1, 1, 1],
    [1, 1, 0],
    [1, 0, 2],
    [1, 0, 1],
    [1, 0, 0],
    [0, 1, 2],
    [0, 1, 1],
    [0, 1, 0],
    [0, 0, 3],
    [0, 0, 2],
    [0, 0, 1],
    [0, 0, 0],
];

/// Where the product of two monomials lies in a list.
const fn product_table<const A: usize, const C: usize>(
    left: &[[u8; 3]; A],
    list: &[[u8; 3]; C],
) -> [[usize; 4]; A] {
    let mut table = [[0; 4]; A];
    let mut a = 0;
    while a < A {
        let mut b = 0;
        while b < 4 {
            let mut c = 0;
            while c < C {
                let same = left[a][0] + LINEAR[b][0] == list[c][0]
                    && left[a][1] + LINEAR[b][1] == list[c][1]
                    && left[a][2] + LINEAR[b][2] == list[c][2];
                if same {
                    table[a][b] = c;
                }
                c += 1;
            }
            b += 1;
        }
        a += 1;
    }
    table
}

const LINEAR_TIMES_LINEAR: [[usize; 4]; 4] = product_table(&LINEAR, &QUADRATIC);
const QUADRATIC_TIMES_LINEAR: [[usize; 4]; 10] = product_table(&QUADRATIC, &CUBIC);

type Linear = [f64; 4];
type Quadratic = [f64; 10];
type Cubic = [f64; 20];

fn add_product(sum: &mut Quadratic, a: &Linear, b: &Linear, sign: f64) {
    for (i, &left) in a.iter().enumerate() {
        for (j, &right) in b.iter().enumerate() {
            sum[LINEAR_TIMES_LINEAR[i][j]] += sign * left * right;
        }
    }
}

fn add_cubic(sum: &mut Cubic, a: &Quadratic, b: &Linear) {
    for (i, &left) in a.iter().enumerate() {
        for (j, &right) in b.iter().enumerate() {
            sum[QUADRATIC_TIMES_LINEAR[i][j]] += left * right;
        }
    }
}

/// The ten cubics: nine of the trace constraint, then the determinant.
fn constraints(basis: &[Row9; 4]) -> [Cubic; 10] {
    let entry = |i: usize, j: usize| -> Linear { core::array::from_fn(|k| basis[k][3 * i + j]) };
    let e: [[Linear; 3]; 3] = core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
    let mut square = [[[0.0; 10]; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            (0..3).for_each(|k| add_product(&mut square[i][j], &e[i][k], &e[j][k], 1.0));
        }
    }
    let half_trace: Quadratic =
        core::array::from_fn(|m| 0.5 * (square[0][0][m] + square[1][1][m] + square[2][2][m]));
    for (i, row) in square.iter_mut().enumerate() {
        row[i]
            .iter_mut()
            .zip(&half_trace)
            .for_each(|(value, t)| *value -= t);
    }
    let mut cubics = [[0.0; 20]; 10];
    for i in 0..3 {
        for j in 0..3 {
            (0..3).for_each(|k| add_cubic(&mut cubics[3 * i + j], &square[i][k], &e[k][j]));
        }
    }
    for j in 0..3 {
        let (a, b) = ((j + 1) % 3, (j + 2) % 3);
        let mut minor = [0.0; 10];
        add_product(&mut minor, &e[1][a], &e[2][b], 1.0);
        add_product(&mut minor, &e[1][b], &e[2][a], -1.0);
        add_cubic(&mut cubics[9], &minor, &e[0][j]);
    }
    cubics
}

/// Gauss-Jordan with partial pivoting on the first ten columns.
fn eliminate(mut rows: [Cubic; 10]) -> Option<[Cubic; 10]> {
    for step in 0..10 {
        let pivot =
            (step..10).max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs()))?;
        rows.swap(step, pivot);
        let lead = rows[step];
        if !(lead[step].abs() > 1e-13) {
            return None;
        }
        let lead = lead.map(|value| value / lead[step]);
        rows[step] = lead;
        for (r, row) in rows.iter_mut().enumerate() {
            let factor = row[step];
            if r != step {
                for (value, l) in row[step..].iter_mut().zip(&lead[step..]) {
                    *value -= factor * l;
                }
            }
        }
    }
    Some(rows)
}

/// A row of the 3x3 matrix in z: the factors of x, of y and of 1, lowest power first.
type ZRow = [[f64; 5]; 3];

/// a − z b, where both rows keep only the last ten monomials.
fn subtract(a: &Cubic, b: &Cubic) -> ZRow {
    let powers = |row: &Cubic, from: usize, count: usize| {
        let mut lowest_first = [0.0; 5];
        (0..count).for_each(|k| lowest_first[k] = row[from + count - 1 - k]);
        lowest_first
    };
    core::array::from_fn(|part| {
        let (from, count) = [(10, 3), (13, 3), (16, 4)][part];
        let (minuend, other) = (powers(a, from, count), powers(b, from, count));
        core::array::from_fn(|k| minuend[k] - if k > 0 { other[k - 1] } else { 0.0 })
    })
}

fn determinant(matrix: &[ZRow; 3]) -> [f64; 11] {
    let mut sum = [0.0; 11];
    for (column, sign) in [([0, 1, 2], 1.0), ([1, 2, 0], 1.0), ([2, 0, 1], 1.0)]
        .into_iter()
        .chain([([0, 2, 1], -1.0), ([2, 1, 0], -1.0), ([1, 0, 2], -1.0)])
    {
        let [a, b, c]: [&[f64; 5]; 3] = core::array::from_fn(|r| &matrix[r][column[r]]);
        for (i, &x) in a.iter().enumerate() {
            for (j, &y) in b.iter().enumerate() {
                for (k, &z) in c.iter().enumerate().take(11 - i - j) {
                    sum[i + j + k] += sign * x * y * z;
                }
            }
        }
    }
    sum
}

/// x and y for a root z: the direction at a right angle to the two most different rows.
fn back_substitute(matrix: &[ZRow; 3], z: f64) -> Option<(f64, f64)> {
    let at = |row: &ZRow| {
        let value = |p: &[f64; 5]| p.iter().rev().fold(0.0, |sum, &c| sum * z + c);
        Vector3::new(value(&row[0]), value(&row[1]), value(&row[2]))
    };
    let rows = [at(&matrix[0]), at(&matrix[1]), at(&matrix[2])];
    let crosses = [
        rows[0].cross(&rows[1]),
        rows[1].cross(&rows[2]),
        rows[2].cross(&rows[0]),
    ];
    let best = crosses
        .iter()
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    let (x, y) = (best.x / best.z, best.y / best.z);
    (x.is_finite() && y.is_finite()).then_some((x, y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::two_view::essential_of;
    use nalgebra::{Isometry3, Point3};
    use rand::{RngExt, SeedableRng};

    #[test]
    fn no_product_falls_outside_the_tables() {
        for (a, row) in QUADRATIC_TIMES_LINEAR.iter().enumerate() {
            for (b, &c) in row.iter().enumerate() {
                for k in 0..3 {
                    assert_eq!(QUADRATIC[a][k] + LINEAR[b][k], CUBIC[c][k]);
                }
            }
        }
    }

    /// Random scenes; a few of them are nearly critical, where two solutions merge.
    #[test]
    fn the_true_matrix_is_among_the_solutions() {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(3);
        let mut misses = 0;
        for _ in 0..500 {
            let mut unit = || rng.random::<f64>() * 2.0 - 1.0;
            let shift = Vector3::new(unit(), unit(), unit());
            let motion = Isometry3::new(shift, Vector3::new(unit(), unit(), unit()) * 0.4);
            let first = [(); 5].map(|()| Vector3::new(unit(), unit(), unit() + 4.0));
            let second = first.map(|p| (motion * Point3::from(p)).coords);
            let solutions = essential_from_five(&first, &second);
            let truth = essential_of(&motion);
            let truth = truth * (core::f64::consts::SQRT_2 / truth.norm());
            let distance = |e: &Matrix3<f64>| (e - truth).norm().min((e + truth).norm());
            misses += usize::from(!solutions.iter().any(|e| distance(e) < 1e-6));
            for e in &solutions {
                for k in 0..5 {
                    assert!((second[k].transpose() * e * first[k])[0].abs() < 1e-6);
                }
            }
        }
        assert!(misses <= 15, "{misses} of 500");
    }

    #[test]
    fn degenerate_samples_give_nothing() {
        let same = [Vector3::new(0.1, 0.2, 1.0); 5];
        assert!(essential_from_five(&same, &same).is_empty());
        let nan = [Vector3::new(f64::NAN, 0.2, 1.0); 5];
        assert!(essential_from_five(&nan, &nan).is_empty());
    }
}
