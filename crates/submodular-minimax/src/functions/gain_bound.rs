//! One function that bounds the gains of all facilities in a small box from above, in f32 lanes.
//!
//! Let c be the centre of the box, h its half sides, δ = u − c, d = v − c for client v, and φ(u) the
//! excess (s(u, v) − served(v))₊. With E = Σ |dᵢ| hᵢ ≥ |d · δ|:
//!
//! ```text
//! linear, reciprocal:  ‖u − v‖ ≥ ρ(δ) = ‖d‖ − d · δ / ‖d‖, within ± E / ‖d‖ of ‖d‖
//! rational:            ‖u − v‖² = q(δ) = ‖d‖² − 2 d · δ + ‖δ‖², within [‖d‖² − 2E, ‖d‖² + 2E + ‖h‖²]
//! ```
//!
//! The kernels fall and are convex in ρ or q, so φ is convex there too and lies below its chord over
//! that range, which is affine in δ and ‖δ‖². Such functions add up over the clients; the sum errs by
//! the second order of the side of the box. All rounding is covered by [`Kernel32::slack`] per client
//! whose excess is not certainly 0 and by [`SUM_SLACK`].

use super::similarity::Kernel;

/// Clients that are handled together; a multiple of every vector width.
pub(super) const BLOCK: usize = 64;

/// Places on the grid of [`on_grid`], what they weigh, and how well they are served less the slack
/// that does not depend on the box.
#[derive(Clone)]
pub(super) struct Block {
    pub(super) place: [[f32; BLOCK]; 3],
    pub(super) weight: [f32; BLOCK],
    pub(super) served: [f32; BLOCK],
}

/// constant + slope · δ + curve ‖δ‖².
#[derive(Clone, Copy, Default)]
pub(super) struct GainBound {
    pub(super) center: [f64; 3],
    constant: f64,
    slope: [f64; 3],
    curve: f64,
}

/// A box of facilities: its centre on the grid and half sides that reach all of it.
#[derive(Clone, Copy)]
pub(super) struct FacilityBox {
    center: [f32; 3],
    half: [f32; 3],
}

impl FacilityBox {
    /// The corners lie in [-2, 2].
    pub(super) fn new(low: [f64; 3], high: [f64; 3]) -> Self {
        let center = [0, 1, 2].map(|axis| on_grid(0.5 * (low[axis] + high[axis])));
        let half = [0, 1, 2].map(|axis| {
            let middle = f64::from(center[axis]);
            let half = (high[axis] - middle).max(middle - low[axis]);
            half as f32 * (1.0 + 2.0 * f32::EPSILON) + f32::MIN_POSITIVE
        });
        Self { center, half }
    }
}

/// The nearest multiple of 2⁻²³, exact in f32 for values in [-2, 2]; so is the difference of two within 2
/// of each other, and any other errs by one such cell at most.
pub(super) fn on_grid(value: f64) -> f32 {
    const CELLS: f64 = 8_388_608.0;
    ((value * CELLS).round() / CELLS) as f32
}

impl GainBound {
    /// The bound for the facility at `place`, a point of the box.
    pub(super) fn at(&self, place: [f64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - self.center[axis]);
        let tilt = self.slope[0] * x + self.slope[1] * y + self.slope[2] * z;
        let value = self.constant + tilt + self.curve * (x * x + y * y + z * z);
        value + SUM_SLACK * self.constant
    }

    /// The bound with all weights `factor` times as large.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            center: self.center,
            constant: self.constant * factor,
            slope: self.slope.map(|slope| slope * factor),
            curve: self.curve * factor,
        }
    }

    fn add(&mut self, sums: &Sums) {
        let total = |lanes: &[f32; BLOCK]| lanes.iter().map(|&lane| f64::from(lane)).sum::<f64>();
        self.constant += total(&sums.constant);
        for (sum, lanes) in self.slope.iter_mut().zip(&sums.slope) {
            *sum += total(lanes);
        }
        self.curve -= total(&sums.curve);
    }
}

struct Sums {
    constant: [f32; BLOCK],
    slope: [[f32; BLOCK]; 3],
    /// Negated.
    curve: [f32; BLOCK],
}

impl Sums {
    const ZERO: Self = Self {
        constant: [0.0; BLOCK],
        slope: [[0.0; BLOCK]; 3],
        curve: [0.0; BLOCK],
    };
}

/// A kernel in f32, never below the true one by more than the slack.
#[derive(Clone, Copy)]
pub(super) struct Kernel32 {
    kind: Kernel,
    /// 1 / reach or 1 / scale.
    inverse: f32,
}

impl Kernel32 {
    pub(super) fn new(kind: Kernel) -> Self {
        let (Kernel::Linear { reach: length }
        | Kernel::Reciprocal { scale: length }
        | Kernel::Rational { scale: length }) = kind;
        let inverse = (1.0 / length).min(STEEPEST) as f32;
        Self { kind, inverse }
    }

    /// What rounding may take from one client's bound: s ≤ 1 and |d s'(d)| ≤ 1 near its threshold, so
    /// relative errors of some ulp cost as many ulp; places are off by half a cell of the grid and
    /// differences by one, times the slope of the kernel, at most `inverse`; E errs by some ulp of the half sides.
    pub(super) fn slack(&self, half: [f32; 3]) -> f32 {
        let side = half[0] + half[1] + half[2];
        f32::EPSILON * (16.0 + self.inverse * (4.0 + 16.0 * side))
    }

    /// The bound of the gains of the facilities in `bounds` from `blocks`.
    #[inline(always)]
    pub(super) fn bound(&self, bounds: FacilityBox, blocks: &[Block], busy: &[usize]) -> GainBound {
        let inverse = self.inverse;
        match self.kind {
            Kernel::Linear { .. } => {
                let kernel = |near: f32, far: f32| (1.0 - near * inverse, 1.0 - far * inverse);
                self.collect(bounds, blocks, busy, by_distance(kernel))
            }
            Kernel::Reciprocal { .. } => {
                let kernel = |near: f32, far: f32| {
                    (1.0 / (1.0 + near * inverse), 1.0 / (1.0 + far * inverse))
                };
                self.collect(bounds, blocks, busy, by_distance(kernel))
            }
            Kernel::Rational { .. } => {
                let square = bounds.half.iter().map(|h| h * h).sum::<f32>();
                self.collect(bounds, blocks, busy, by_square(inverse * inverse, square))
            }
        }
    }

    #[inline(always)]
    fn collect(
        &self,
        bounds: FacilityBox,
        blocks: &[Block],
        busy: &[usize],
        chord: impl Fn(f32, f32, f32, f32) -> Chord + Copy,
    ) -> GainBound {
        let mut bound = GainBound {
            center: bounds.center.map(f64::from),
            ..GainBound::default()
        };
        let slack = self.slack(bounds.half);
        let mut sums = Sums::ZERO;
        for (at, &block) in busy.iter().enumerate() {
            if at % FLUSH == FLUSH - 1 {
                bound.add(&sums);
                sums = Sums::ZERO;
            }
            add_block(&mut sums, &blocks[block], bounds, slack, chord);
        }
        bound.add(&sums);
        bound
    }
}

/// The chord of one client: its value at the centre, and what multiplies d · δ and −‖δ‖².
struct Chord {
    constant: f32,
    along: f32,
    curve: f32,
}

#[inline(always)]
fn add_block(
    sums: &mut Sums,
    block: &Block,
    bounds: FacilityBox,
    slack: f32,
    chord: impl Fn(f32, f32, f32, f32) -> Chord,
) {
    let ([cx, cy, cz], [hx, hy, hz]) = (bounds.center, bounds.half);
    let [px, py, pz] = &block.place;
    let [sx, sy, sz] = &mut sums.slope;
    for i in 0..BLOCK {
        let (x, y, z) = (px[i] - cx, py[i] - cy, pz[i] - cz);
        let square = x * x + y * y + z * z;
        let range = x.abs() * hx + y.abs() * hy + z.abs() * hz;
        let chord = chord(square, range, block.served[i] - slack, block.weight[i]);
        sums.constant[i] += chord.constant;
        sx[i] += chord.along * x;
        sy[i] += chord.along * y;
        sz[i] += chord.along * z;
        sums.curve[i] += chord.curve;
    }
}

/// The chord in the distance; where the box may hold the client itself, its excess at no distance.
#[inline(always)]
fn by_distance(
    kernel: impl Fn(f32, f32) -> (f32, f32) + Copy,
) -> impl Fn(f32, f32, f32, f32) -> Chord + Copy {
    move |square, range, served, weight| {
        let distance = square.sqrt();
        let reach = range / distance.max(TINY);
        let near = distance - reach;
        let far = if near < 0.0 { 0.0 } else { distance + reach };
        let (near, far) = kernel(near.max(0.0), far);
        let near = (near - served).max(0.0) * weight;
        let far = (far - served).max(0.0) * weight;
        Chord {
            constant: 0.5 * (near + far),
            along: 0.5 * (near - far) / range.max(TINY),
            curve: 0.0,
        }
    }
}

/// The chord in the squared distance.
#[inline(always)]
fn by_square(inverse_area: f32, half_square: f32) -> impl Fn(f32, f32, f32, f32) -> Chord + Copy {
    move |square, range, served, weight| {
        let before = square.min(2.0 * range);
        let after = 2.0 * range + half_square;
        let near = 1.0 / (1.0 + (square - before) * inverse_area);
        let far = 1.0 / (1.0 + (square + after) * inverse_area);
        let near = (near - served).max(0.0) * weight;
        let far = (far - served).max(0.0) * weight;
        let fall = (near - far) / (before + after).max(TINY);
        Chord {
            constant: near - fall * before,
            along: 2.0 * fall,
            curve: fall,
        }
    }
}

/// Blocks whose f32 sums are added up before they go to f64.
const FLUSH: usize = 16;
/// What a sum may lose by rounding, relative to its constant part: the terms are at most thrice that.
const SUM_SLACK: f64 = 4.0 * (FLUSH as f64 + 16.0) * f32::EPSILON as f64;
/// Kernels that fall more steeply are replaced by one that does not and lies above.
const STEEPEST: f64 = 1e12;
/// Below the square of a cell of the grid.
const TINY: f32 = 1e-30;
