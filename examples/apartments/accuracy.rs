//! How near to something solid a ball may come that free space lets through, beside what it was asked for.

use std::fmt;

use indoor_sim::World;
use rand::RngExt;
use rand_pcg::Pcg64;

use crate::scan::Place;

/// Longest motion, metres.
const LONGEST: f64 = 1.0;

/// What a motion check accepted, judged by the truth.
#[derive(Clone, Debug, Default)]
pub(crate) struct Accuracy {
    /// How much nearer to something solid than its radius the ball came, metres; negative where it kept away.
    deficits: Vec<f64>,
    /// How many of them pass through something solid.
    crossing: usize,
    tried: usize,
    /// Volume in which the motions started, cubic metres.
    volume: f64,
}

impl Accuracy {
    /// Tries places, and as many motions, all over the world.
    pub(crate) fn measure(
        world: &World,
        free: &impl Fn(Place, Place) -> bool,
        radius: f64,
        count: usize,
        rng: &mut Pcg64,
    ) -> Self {
        let (low, high) = world.bounds();
        let mut accuracy = Accuracy {
            volume: (0..3).map(|i| high[i] - low[i]).product(),
            tried: count,
            ..Accuracy::default()
        };
        for number in 0..count {
            let a: Place =
                core::array::from_fn(|i| low[i] + (high[i] - low[i]) * rng.random::<f64>());
            let b = core::array::from_fn(|i| a[i] + LONGEST * (rng.random::<f64>() - 0.5));
            let b = if number % 2 == 0 { a } else { b };
            if free(a, b) {
                let clearance = world.segment_clearance(a, b);
                accuracy.deficits.push(radius - clearance);
                accuracy.crossing += usize::from(clearance <= 0.0);
            }
        }
        accuracy
    }

    pub(crate) fn add(&mut self, other: Self) {
        self.deficits.extend(other.deficits);
        self.crossing += other.crossing;
        self.tried += other.tried;
        self.volume += other.volume;
    }

    /// The deficit that this share of the accepted motions exceeds; the greatest for 0.
    fn exceeded_by(&self, share: f64) -> f64 {
        let mut sorted = self.deficits.clone();
        sorted.sort_by(|a, b| b.total_cmp(a));
        let rank = (share * sorted.len() as f64) as usize;
        sorted.get(rank).copied().unwrap_or(f64::NEG_INFINITY)
    }

    /// Volume in which motions start, cubic metres.
    fn volume(&self) -> f64 {
        self.volume * self.deficits.len() as f64 / self.tried.max(1) as f64
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [worst, ten_thousandth, thousandth, hundredth] =
            [0.0, 1e-4, 1e-3, 1e-2].map(|share| self.exceeded_by(share));
        write!(
            out,
            "motions free in {:.1} m³, {} of {} through something solid, nearer than the radius by {worst:.3} m at worst, {ten_thousandth:.3} / {thousandth:.3} / {hundredth:.3} m in one of 10,000 / 1,000 / 100",
            self.volume(),
            self.crossing,
            self.deficits.len()
        )
    }
}
