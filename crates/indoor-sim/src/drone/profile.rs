//! How far a move has come after a time: speed up, cruise, slow down.

/// A trapezoid of speed over time; a triangle when the way is too short for the cruising speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Profile {
    length: f64,
    acceleration: f64,
    peak: f64,
}

impl Profile {
    /// A move over `length` ≥ 0 with at most `speed` > 0 and `acceleration` > 0, in units that belong together.
    pub(crate) fn new(length: f64, speed: f64, acceleration: f64) -> Self {
        let peak = speed.min((length * acceleration).sqrt());
        Self {
            length,
            acceleration,
            peak,
        }
    }

    /// Seconds until it stands still.
    pub(crate) fn duration(&self) -> f64 {
        if self.peak <= 0.0 {
            return 0.0;
        }
        self.length / self.peak + self.peak / self.acceleration
    }

    /// Way done after `time` seconds, 0 to the whole length.
    pub(crate) fn position(&self, time: f64) -> f64 {
        let duration = self.duration();
        if time <= 0.0 {
            return 0.0;
        }
        if time >= duration {
            return self.length;
        }
        let ramp = self.peak / self.acceleration;
        if time < ramp {
            0.5 * self.acceleration * time * time
        } else if time > duration - ramp {
            self.length - 0.5 * self.acceleration * (duration - time) * (duration - time)
        } else {
            self.peak * (time - 0.5 * ramp)
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Profile;

    proptest! {
        #[test]
        fn the_way_grows_steadily_to_its_length_within_speed_and_acceleration(
            length in 0.0..6.0_f64, speed in 0.1..1.0_f64, acceleration in 0.2..5.0_f64
        ) {
            let profile = Profile::new(length, speed, acceleration);
            let step = profile.duration() / 500.0;
            let ways: Vec<f64> = (0..=500).map(|i| profile.position(f64::from(i) * step)).collect();
            prop_assert_eq!(ways[0], 0.0);
            prop_assert!((ways[500] - length).abs() < 1e-9);
            for pair in ways.windows(2) {
                prop_assert!(pair[1] >= pair[0] - 1e-12);
                prop_assert!(pair[1] - pair[0] <= speed * step + 1e-9);
            }
        }
    }
}
