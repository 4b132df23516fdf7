//! Seeded random streams and the normal distribution.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// What a stream of random numbers is for. Each purpose draws from its own stream, so that a change in one part of the
/// simulator leaves the others' numbers alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    Layout = 1,
    Texture = 2,
    Motion = 3,
    Slam = 4,
}

/// The stream of a seed for a purpose.
pub(crate) fn stream(seed: u64, purpose: Purpose) -> Pcg64 {
    let mixed = mix(seed ^ mix(purpose as u64));
    Pcg64::seed_from_u64(mixed)
}

/// SplitMix64's finaliser: neighbouring inputs give unrelated outputs.
pub(crate) fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// One standard normal number (Box and Muller 1958).
pub(crate) fn normal(rng: &mut impl Rng) -> f64 {
    let u: f64 = 1.0 - rng.random::<f64>();
    let angle = core::f64::consts::TAU * rng.random::<f64>();
    (-2.0 * u.ln()).sqrt() * angle.cos()
}

/// Three independent standard normal numbers.
pub(crate) fn normal3(rng: &mut impl Rng) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::new(normal(rng), normal(rng), normal(rng))
}

/// Uniform in `[low, high)`; `low` when the interval is empty.
pub(crate) fn uniform(rng: &mut impl Rng, low: f64, high: f64) -> f64 {
    low + (high - low).max(0.0) * rng.random::<f64>()
}

#[cfg(test)]
mod tests {
    use super::{Purpose, normal, stream};

    #[test]
    fn normal_numbers_have_zero_mean_and_unit_variance() {
        let mut rng = stream(5, Purpose::Motion);
        let draws: Vec<f64> = (0..20_000).map(|_| normal(&mut rng)).collect();
        let mean = draws.iter().sum::<f64>() / 20_000.0;
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 20_000.0;
        assert!(
            mean.abs() < 0.03 && (variance - 1.0).abs() < 0.05,
            "{mean} {variance}"
        );
    }
}
