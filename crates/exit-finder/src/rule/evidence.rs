//! How likely a sector is an opening: a logistic score of what was seen in it.
//!
//! Each part answers one question, and none needs a scale:
//!
//! ```text
//! contrast   how much farther one sees here than in the surroundings of ±50 degrees
//! share      which share of what was seen lies behind the wall a convex room would have here
//! support    how many votes that is
//! depth      how deep behind the line between the jambs, in units of their distance
//! width      how wide, against the median range
//! spread     whether it is spread over the sector, or one clump behind a blank piece of wall
//! convexity  which share lies behind the walls on BOTH sides, continued: a corridor's end lies before one of them
//! angle      how wide the sector is: wide ones hold some far points by chance
//! ```
//!
//! Weights: logistic regression on 3,500 candidates in 400 generated rooms at outlier rates of 0, 10 and 20 %, before and after
//! cleaning (seeds from 60000; the figures in the README are of other seeds). Real scans had no part in the weights.

/// What was seen in a sector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Evidence {
    pub(super) contrast: f64,
    pub(super) share: f64,
    pub(super) votes: f64,
    pub(super) depth: f64,
    pub(super) relative_width: f64,
    pub(super) spread: f64,
    pub(super) convexity: f64,
    pub(super) angle: f64,
}

/// Where a score comes from: parts of its log odds. All zero for exits of Algorithm 2; an exit of kind
/// [`crate::ExitKind::Empty`] has `support` only.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ScoreParts {
    /// How much farther one sees than in the surroundings.
    pub contrast: f64,
    /// Which share of the points lies beyond the wall.
    pub share: f64,
    /// How many points that is; for an empty sector, how many a wall would have shown.
    pub support: f64,
    /// How deep behind the jambs they lie.
    pub depth: f64,
    /// How wide the opening is.
    pub width: f64,
    /// How evenly they fill the sector.
    pub spread: f64,
    /// How many lie behind the walls on both sides, continued.
    pub convexity: f64,
    /// Width of the sector, against it.
    pub angle: f64,
}

impl Evidence {
    /// The parts of the log odds.
    pub(super) fn parts(&self) -> ScoreParts {
        ScoreParts {
            contrast: CONTRAST * self.contrast.clamp(0.5, 4.0).ln(),
            share: 4.96 * (self.share - 1.0),
            support: 0.48 * (self.votes / 25.0).ln(),
            depth: 0.91 * (self.depth.clamp(0.0, 2.0) - 1.0),
            width: 0.69 * self.relative_width.clamp(0.1, 2.0).ln(),
            spread: 2.19 * (self.spread.clamp(0.0, 1.0) - 1.0),
            convexity: 2.38 * (self.convexity - 1.0),
            angle: -0.43 * self.angle.ln(),
        }
    }
}

impl ScoreParts {
    /// Probability of a way out, in rooms like those that the weights were fitted on; the logistic function of
    /// the parts' sum.
    pub fn probability(&self) -> f64 {
        let odds = [
            self.contrast,
            self.share,
            self.support,
            self.depth,
            self.width,
            self.spread,
            self.convexity,
            self.angle,
        ];
        1.0 / (1.0 + (-odds.iter().sum::<f64>() - BIAS).exp())
    }

    /// The rank: the probability, times how much farther one sees than around. On real maps, which are dirtier than any
    /// generated one, the second factor tells doors from clutter.
    pub(super) fn score(&self) -> f64 {
        let nearer = (-self.contrast / CONTRAST).exp();
        self.probability() * (1.0 - nearer).max(0.0)
    }

    /// The parts of an exit whose probability has one source.
    pub(super) fn of_support(probability: f64) -> Self {
        Self {
            support: (probability / (1.0 - probability)).ln() - BIAS,
            ..Self::default()
        }
    }
}

const CONTRAST: f64 = 2.15;
/// Log odds of a sector whose parts are all zero: twenty-five votes, all behind every wall, evenly spread, as
/// deep as the opening is wide.
const BIAS: f64 = -11.37 + 4.96 + 0.48 * 3.218_875_824_868_201 + 0.91 + 2.19 + 2.38;

#[cfg(test)]
mod tests {
    use super::*;

    fn plain() -> Evidence {
        Evidence {
            contrast: 2.0,
            share: 0.95,
            votes: 30.0,
            depth: 1.5,
            relative_width: 0.5,
            spread: 0.9,
            convexity: 0.9,
            angle: 0.3,
        }
    }

    #[test]
    fn a_plain_door_is_likely_and_every_lack_makes_it_less_so() {
        let score = |evidence: Evidence| evidence.parts().probability();
        let door = score(plain());
        assert!(door > 0.8 && door < 1.0, "{door}");
        let worse = [
            Evidence {
                contrast: 1.0,
                ..plain()
            },
            Evidence {
                share: 0.5,
                ..plain()
            },
            Evidence {
                votes: 4.0,
                ..plain()
            },
            Evidence {
                depth: 0.4,
                ..plain()
            },
            Evidence {
                relative_width: 0.15,
                ..plain()
            },
            Evidence {
                spread: 0.2,
                ..plain()
            },
            Evidence {
                convexity: 0.0,
                ..plain()
            },
            Evidence {
                angle: 1.0,
                ..plain()
            },
        ];
        for evidence in worse {
            assert!(score(evidence) < door, "{evidence:?}");
        }
    }

    #[test]
    fn one_source_gives_its_probability_back() {
        for given in [0.1, 0.5, 0.99] {
            let parts = ScoreParts::of_support(given);
            assert!((parts.probability() - given).abs() < 1e-9);
        }
    }
}
