//! Every constant of the search, with unit, range and source.

use std::f64::consts::FRAC_PI_2;

use crate::error::ExitError;

/// How exits are looked for. `Default` is the range-aware rule, [`ExitConfig::paper`] Algorithm 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExitConfig {
    /// Number of angular bins, at least 8. Paper: 360.
    pub bins: usize,
    /// Points a bin needs to count as occupied, at least 1. Paper, line 14: `|B_i| > 1`, so 2.
    pub min_count: usize,
    /// Usable points below which the map is called insufficient. Not in the paper; 30.
    pub min_points: usize,
    /// Which heights about the agent count.
    pub band: HeightBand,
    /// Smallest passable width in map units, `2 (radius + margin)` of the drone; `None` while the
    /// scale of the map is unknown, then only relative widths decide.
    pub min_width: Option<f64>,
    /// The low quantile that the profile keeps beside minimum and median, in `[0, 1]`; 0.25.
    pub quantile: f64,
    /// The rule that tells an opening from a wall.
    pub rule: Rule,
}

/// Points outside the band are not part of the profile: floor and ceiling would fill the doorway.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeightBand {
    /// All heights (the paper).
    Off,
    /// `|height − agent's height| ≤ f ×` median range of all points, `f > 0`. Needs no scale.
    Relative(f64),
    /// As `Relative`, but the band follows the strip that the camera saw (see [`crate::Strip`]): its
    /// middle leans with the bearing. For maps whose up direction is only roughly known.
    Strip(f64),
    /// Heights above the agent between the two bounds, map units along the plane's normal.
    Absolute {
        /// Lower bound, usually negative.
        from: f64,
        /// Upper bound.
        to: f64,
    },
}

/// The two readings of "where does the profile open".
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// Empty runs and runs whose range jumps above their surroundings (default).
    RangeAware(RangeAware),
    /// The longest run of empty bins.
    Paper(PaperReading),
}

/// Constants of the range-aware rule. All are ratios or angles, so the rule needs no scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeAware {
    /// Half width of the smoothing window, radians in `[0, π/4]`; 5 degrees.
    pub window: f64,
    /// Width of the piece of wall beside an edge that stands for the wall, radians; 8 degrees.
    pub side: f64,
    /// Standard deviation of an inverse range in units of the inverse median range: a share of the inverse range, and a
    /// constant, both 0 or more. Depths from parallax: 0.006 and 0.02 (a pixel or two at a base line of a tenth of the range).
    pub noise: [f64; 2],
    /// Straight walls that are looked for, at most; 28.
    pub max_walls: usize,
    /// Bins that a wall shows in, at least; 4.
    pub min_wall: usize,
    /// Nearer than this to an unseen sector no opening is judged, radians in `[0, π/2]`; 20 degrees. Half an opening at
    /// the border of a scan looks like anything.
    pub margin: f64,
    /// Smallest probability of an exit ([`crate::ScoreParts`]), in `[0, 1]`. Less finds more doors and more that
    /// are none.
    pub min_probability: f64,
    /// Smallest width between the jambs as a share of the median range; rules where the scale is
    /// unknown.
    pub min_relative_width: f64,
    /// Largest width between the jambs as a share of the median range: what is wider is a hole in the
    /// map of the room rather than a way out.
    pub max_relative_width: f64,
    /// Points that an empty run would hold were it a wall like its surroundings, at least.
    pub min_expected: f64,
    /// The same, as a share of what such a run holds on average, in `[0, 1]`: where texture is patchy,
    /// a blank piece of wall looks like a dark doorway, and an empty run proves nothing.
    pub min_evenness: f64,
    /// Empty runs wider than this were never looked at, radians; a quarter turn, because an opening
    /// that subtends more than that holds the agent.
    pub unseen: f64,
    /// How far behind the jambs the exit point lies, as a share of their range, in `[0, 1]`; 0.2.
    pub beyond: f64,
}

/// Where the text of Algorithm 2 is ambiguous, the choice made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PaperReading {
    /// What `r` is measured from.
    pub range_from: RangeFrom,
    /// Which bin numbers exist.
    pub numbering: Numbering,
    /// Whether a gap may cross 0 degrees.
    pub gap: GapTopology,
}

/// The exit's distance `r` (lines 10 to 12).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RangeFrom {
    /// Mean of `‖p‖` in plane coordinates: distances from the plane's origin, as printed.
    PlaneOrigin,
    /// Mean of `‖p − x'‖`: distances from the agent. The same when the agent is the origin.
    Agent,
}

/// The bins `[i°, (i + 1)°)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Numbering {
    /// `i = 1..=n` as printed: the first degree belongs to no bin and bin n is always empty.
    FromOne,
    /// `i = 0..n`: every bearing has its bin.
    FromZero,
}

/// The largest empty segment "in [0, 2π]".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GapTopology {
    /// A segment of the line, as printed: a gap across 0 is cut in two.
    Linear,
    /// A run on the circle.
    Circular,
}

impl Default for ExitConfig {
    fn default() -> Self {
        Self {
            bins: 360,
            min_count: 2,
            min_points: 30,
            band: HeightBand::Strip(0.25),
            min_width: None,
            quantile: 0.25,
            rule: Rule::RangeAware(RangeAware::default()),
        }
    }
}

impl Default for RangeAware {
    fn default() -> Self {
        Self {
            window: 5f64.to_radians(),
            side: 8f64.to_radians(),
            noise: [0.006, 0.02],
            max_walls: 28,
            min_wall: 4,
            margin: 20f64.to_radians(),
            min_probability: 0.8,
            min_relative_width: 0.15,
            max_relative_width: 2.0,
            min_expected: 8.0,
            min_evenness: 0.85,
            unseen: FRAC_PI_2,
            beyond: 0.2,
        }
    }
}

impl ExitConfig {
    /// Algorithm 2 as printed: 360 bins numbered from one, more than one point fills a bin, all
    /// heights, the longest run on the line `[0, 2π]`, `r` measured from the plane's origin.
    ///
    /// Bearings are taken about the agent: "the angle between x' and p" read as the angle of two
    /// vectors is undefined for an agent at the origin and never exceeds half a turn.
    pub fn paper() -> Self {
        Self::with_reading(PaperReading {
            range_from: RangeFrom::PlaneOrigin,
            numbering: Numbering::FromOne,
            gap: GapTopology::Linear,
        })
    }

    /// Algorithm 2 with its slips repaired: bins from zero, circular runs, `r` about the agent.
    pub fn paper_repaired() -> Self {
        Self::with_reading(PaperReading {
            range_from: RangeFrom::Agent,
            numbering: Numbering::FromZero,
            gap: GapTopology::Circular,
        })
    }

    fn with_reading(reading: PaperReading) -> Self {
        Self {
            band: HeightBand::Off,
            rule: Rule::Paper(reading),
            ..Self::default()
        }
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// [`ExitError::Config`] with the first field that is outside.
    pub fn validate(&self) -> Result<(), ExitError> {
        within("bins", self.bins as f64, 8.0, 1e6, "8..=1000000")?;
        within("min_count", self.min_count as f64, 1.0, 1e9, "1.. points")?;
        within("quantile", self.quantile, 0.0, 1.0, "[0, 1]")?;
        if let Some(width) = self.min_width {
            within("min_width", width, 0.0, f64::MAX, "[0, ∞) map units")?;
        }
        match self.band {
            HeightBand::Off => {}
            HeightBand::Relative(f) | HeightBand::Strip(f) => {
                within(
                    "band",
                    f,
                    f64::MIN_POSITIVE,
                    f64::MAX,
                    "(0, ∞) of the median range",
                )?;
            }
            HeightBand::Absolute { from, to } => {
                within("band.from", from, -f64::MAX, to, "(-∞, band.to]")?;
                within("band.to", to, from, f64::MAX, "[band.from, ∞)")?;
            }
        }
        match &self.rule {
            Rule::Paper(_) => Ok(()),
            Rule::RangeAware(rule) => rule.validate(),
        }
    }
}

impl RangeAware {
    fn validate(&self) -> Result<(), ExitError> {
        use std::f64::consts::{FRAC_PI_4, TAU};
        within("window", self.window, 0.0, FRAC_PI_4, "[0, π/4] rad")?;
        let fields = [
            (
                "side",
                self.side,
                f64::MIN_POSITIVE,
                FRAC_PI_4,
                "(0, π/4] rad",
            ),
            ("noise", self.noise[0], 0.0, 1.0, "[0, 1]"),
            ("noise", self.noise[1], f64::MIN_POSITIVE, 1.0, "(0, 1]"),
            ("max_walls", self.max_walls as f64, 0.0, 1e3, "0..=1000"),
            ("min_wall", self.min_wall as f64, 1.0, 1e9, "1.. bins"),
            ("margin", self.margin, 0.0, FRAC_PI_2, "[0, π/2] rad"),
            ("min_probability", self.min_probability, 0.0, 1.0, "[0, 1]"),
            (
                "min_relative_width",
                self.min_relative_width,
                0.0,
                f64::MAX,
                "[0, ∞)",
            ),
            (
                "max_relative_width",
                self.max_relative_width,
                0.0,
                f64::MAX,
                "[0, ∞)",
            ),
            (
                "min_expected",
                self.min_expected,
                0.0,
                f64::MAX,
                "[0, ∞) points",
            ),
            ("min_evenness", self.min_evenness, 0.0, 1.0, "[0, 1]"),
        ];
        for (field, value, low, high, range) in fields {
            within(field, value, low, high, range)?;
        }
        within("unseen", self.unseen, f64::MIN_POSITIVE, TAU, "(0, 2π] rad")?;
        within("beyond", self.beyond, 0.0, 1.0, "[0, 1]")
    }
}

fn within(
    field: &'static str,
    value: f64,
    low: f64,
    high: f64,
    range: &'static str,
) -> Result<(), ExitError> {
    // A NaN fails both comparisons and is therefore outside.
    if value >= low && value <= high {
        Ok(())
    } else {
        Err(ExitError::Config {
            field,
            value,
            range,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_each_bad_field_is_named() {
        assert_eq!(ExitConfig::default().validate(), Ok(()));
        assert_eq!(ExitConfig::paper().validate(), Ok(()));
        let config = ExitConfig {
            bins: 7,
            ..Default::default()
        };
        assert!(matches!(
            config.validate(),
            Err(ExitError::Config { field: "bins", .. })
        ));
        let config = ExitConfig {
            quantile: f64::NAN,
            ..Default::default()
        };
        assert!(matches!(
            config.validate(),
            Err(ExitError::Config {
                field: "quantile",
                ..
            })
        ));
        let rule = RangeAware {
            margin: -0.9,
            ..Default::default()
        };
        let config = ExitConfig {
            rule: Rule::RangeAware(rule),
            ..Default::default()
        };
        assert!(matches!(
            config.validate(),
            Err(ExitError::Config {
                field: "margin",
                ..
            })
        ));
        let config = ExitConfig {
            band: HeightBand::Absolute { from: 1.0, to: 0.0 },
            ..Default::default()
        };
        assert!(matches!(
            config.validate(),
            Err(ExitError::Config {
                field: "band.from",
                ..
            })
        ));
    }
}
