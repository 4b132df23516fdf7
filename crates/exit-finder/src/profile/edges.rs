//! Which bin a direction falls into: exactly, and without an arc tangent.
//!
//! Bin k holds the directions from edge k on and before edge k + 1, counter-clockwise; an edge is a unit
//! vector and "before" is the sign of a cross product. A table over the ratio of the coordinates (with many bins a
//! polynomial, exact to 2·10⁻⁸ rad) guesses the bin, the cross products with its two edges correct the guess by at most one.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The edges of `n` bins on the circle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Edges {
    /// `n + 1` unit vectors, the last one equal to the first.
    directions: Vec<[f64; 2]>,
    bins_per_radian: f64,
    /// The least bin in each cell of each octant; empty where a cell is wider than half a bin.
    guesses: Vec<u16>,
}

/// Cells of the table in an octant. A cell spans less than 1 / CELLS radians.
const CELLS: usize = 256;

impl Edges {
    pub(crate) fn new(n: usize) -> Self {
        let edge = |k: usize| {
            // 7e-17 for the cosine of a right angle would put the axis into the bin before it.
            let axis = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
            let (sin, cos) = ((k % n) as f64 * (TAU / n as f64)).sin_cos();
            [axis(cos), axis(sin)]
        };
        let bins_per_radian = n as f64 / TAU;
        let cells = if 2.0 * bins_per_radian < CELLS as f64 {
            8 * (CELLS + 1)
        } else {
            0
        };
        let guess = |cell: usize| {
            let (octant, step) = (cell / (CELLS + 1), cell % (CELLS + 1));
            let bearing = |step: usize| place((step as f64 / CELLS as f64).atan(), octant);
            let least = bearing(step).min(bearing((step + 1).min(CELLS)));
            (least * bins_per_radian) as u16
        };
        Self {
            directions: (0..=n).map(edge).collect(),
            bins_per_radian,
            guesses: (0..cells).map(guess).collect(),
        }
    }

    /// Number of bins.
    pub(crate) fn n(&self) -> usize {
        self.directions.len() - 1
    }

    /// A bin next to the true one at most.
    #[inline]
    fn guess(&self, direction: [f64; 2]) -> usize {
        let last = self.directions.len() - 2;
        if self.guesses.is_empty() {
            return ((rough_bearing(direction) * self.bins_per_radian) as usize).min(last);
        }
        let [x, y] = direction;
        let (a, b) = (x.abs(), y.abs());
        let step = (a.min(b) / a.max(b) * CELLS as f64) as u32 as usize;
        let octant = usize::from(b > a) + 2 * usize::from(x < 0.0) + 4 * usize::from(y < 0.0);
        usize::from(self.guesses[octant * (CELLS + 1) + step.min(CELLS)]).min(last)
    }

    /// The bin of a direction of any length but zero. Without branches: whether a guess is right is a matter of chance, and a
    /// mispredicted branch costs more than both cross products.
    #[inline]
    pub(crate) fn bin_of(&self, direction: [f64; 2]) -> usize {
        let n = self.directions.len() - 1;
        let guess = self.guess(direction);
        let too_far = is_before(direction, self.directions[guess]);
        let far_enough = too_far | is_before(direction, self.directions[guess + 1]);
        let bin = guess + n - usize::from(too_far) + usize::from(!far_enough);
        let wrapped = if bin >= 2 * n { 2 * n } else { n };
        let below = if bin >= n { wrapped } else { 0 };
        bin - below
    }
}

/// Whether a direction lies less than half a turn clockwise of an edge.
#[inline]
fn is_before(direction: [f64; 2], edge: [f64; 2]) -> bool {
    edge[0] * direction[1] - edge[1] * direction[0] < 0.0
}

/// Bearing in `[0, 2π]` with an error below 2.1·10⁻⁸: Abramowitz and Stegun, 4.4.49, evaluated in pairs, and
/// without branches, which random directions would mispredict.
#[inline]
fn rough_bearing([x, y]: [f64; 2]) -> f64 {
    let (a, b) = (x.abs(), y.abs());
    let t = a.min(b) / a.max(b);
    let s = t * t;
    let (s2, [c0, c1, c2, c3, c4, c5, c6, c7, c8]) = (s * s, COEFFICIENTS);
    let low = (c0 + c1 * s) + (c2 + c3 * s) * s2;
    let high = (c4 + c5 * s) + (c6 + c7 * s) * s2;
    let arc = t * (low + (high + c8 * (s2 * s2)) * (s2 * s2));
    place(
        arc,
        usize::from(b > a) + 2 * usize::from(x < 0.0) + 4 * usize::from(y < 0.0),
    )
}

/// The bearing of an arc of the first octant in another one: bit 0 for |y| > |x|, bit 1 for x < 0, bit 2 for y < 0.
#[inline]
fn place(arc: f64, octant: usize) -> f64 {
    let mirrored = |bit: usize, whole: f64, angle: f64| {
        let flag = (octant >> bit & 1) as f64;
        whole * flag + (1.0 - 2.0 * flag) * angle
    };
    let first_quadrant = mirrored(0, FRAC_PI_2, arc);
    mirrored(2, TAU, mirrored(1, PI, first_quadrant))
}

const COEFFICIENTS: [f64; 9] = [
    1.0,
    -0.333_331_452_8,
    0.199_935_508_5,
    -0.142_088_994_4,
    0.106_562_639_3,
    -0.075_289_640_0,
    0.042_909_613_8,
    -0.016_165_736_7,
    0.002_866_225_7,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::wrap;

    #[test]
    fn the_rough_bearing_is_near_the_true_one() {
        for i in 0..100_000 {
            let bearing = f64::from(i) * TAU / 100_000.0;
            let (sin, cos) = bearing.sin_cos();
            let off = rough_bearing([3.0 * cos, 3.0 * sin]) - wrap(sin.atan2(cos));
            assert!(
                off.abs() < 3e-8 || off.abs() > TAU - 1e-6,
                "{bearing} {off}"
            );
        }
    }

    #[test]
    fn every_edge_belongs_to_the_bin_it_starts() {
        for n in [8, 9, 36, 360, 721, 803, 805, 1000, 12_345] {
            let edges = Edges::new(n);
            for k in 0..n {
                let bearing = k as f64 * TAU / n as f64;
                let place = |off: f64| [(bearing + off).cos(), (bearing + off).sin()];
                assert_eq!(edges.bin_of(edges.directions[k]), k, "{n}");
                assert_eq!(edges.bin_of(place(1e-12)), k, "{n}");
                assert_eq!(edges.bin_of(place(-1e-12)), (k + n - 1) % n, "{n}");
            }
        }
    }

    #[test]
    fn every_direction_lies_between_its_edges() {
        for n in [8, 100, 360, 803, 2000] {
            let edges = Edges::new(n);
            for i in 0..200_000u32 {
                let bearing = f64::from(i) * (TAU / 200_000.0) + 1e-9;
                let direction = [7.0 * bearing.cos(), 7.0 * bearing.sin()];
                let bin = edges.bin_of(direction);
                assert_eq!(bin, (bearing * n as f64 / TAU) as usize, "{n} {bearing}");
            }
        }
    }

    #[test]
    fn the_axes_start_their_quarters() {
        let edges = Edges::new(360);
        let axes = [[2.0, 0.0], [0.0, 2.0], [-2.0, 0.0], [0.0, -2.0]];
        assert_eq!(axes.map(|axis| edges.bin_of(axis)), [0, 90, 180, 270]);
        assert_eq!(edges.bin_of([2.0, -0.0]), 0);
        assert_eq!(edges.bin_of([1.0, -1e-300]), 359);
    }

    #[test]
    fn no_direction_is_out_of_range() {
        let edges = Edges::new(8);
        for x in [0.0, -0.0, 1e-300, -1e300, f64::MAX, f64::NAN] {
            for y in [0.0, -0.0, 1e-300, -1e300, f64::MIN, f64::INFINITY] {
                assert!(edges.bin_of([x, y]) < 8);
            }
        }
    }
}
