//! The rules that tell an opening from a wall, on the finished profile.

mod company;
mod contour;
mod cues;
mod forest;
mod line;
mod openings;
mod paper;
mod range_aware;
mod ranking;
mod score;
mod second_forest;
mod second_look;
mod sight;
mod smoothing;
mod unseen;
mod wall;

pub use cues::{CUE_NAMES, CUES};
pub(crate) use line::Line;
pub use openings::Opening;
pub use score::ScoreParts;
pub use second_look::{SECOND_CUES, SecondLook};

use crate::config::{ExitConfig, Rule};
use crate::error::ExitError;
use crate::exit::ExitReport;
use crate::profile::RangeProfile;
use crate::view::ExitView;

/// Looks for exits on a profile that exists already, kept up to date by
/// a caller. O(bins · window).
///
/// `view.virtual_points` and `view.doubtful` are not used here: they are part of the profile.
///
/// # Errors
/// [`ExitError::Config`].
pub fn exits_of_profile(
    profile: RangeProfile,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<ExitReport, ExitError> {
    config.validate()?;
    let mut report = match &config.rule {
        Rule::Paper(reading) => paper::exits(profile, reading, config),
        Rule::RangeAware(rule) => range_aware::exits(profile, rule, view, config),
    };
    ranking::rank(&mut report, view);
    Ok(report)
}

/// The same on two profiles of a map that a cleaning took points out of: of all points, and of those that were kept.
pub(crate) fn exits_of_cleaned(
    all: RangeProfile,
    kept: &RangeProfile,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<ExitReport, ExitError> {
    let Rule::RangeAware(rule) = &config.rule else {
        return exits_of_profile(all, view, config);
    };
    let mut report = range_aware::exits_of_cleaned(all, kept, rule, view, config);
    ranking::rank(&mut report, view);
    Ok(report)
}

/// The candidates of both profiles, with the cues of the second look.
pub(crate) fn looked_at_twice(
    all: &RangeProfile,
    kept: &RangeProfile,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<Vec<SecondLook>, ExitError> {
    config.validate()?;
    Ok(match &config.rule {
        Rule::Paper(_) => Vec::new(),
        Rule::RangeAware(rule) => range_aware::candidates_of_cleaned(all, kept, rule, view, config),
    })
}

/// All stretches of walls that may be openings, with their cues and whatever their probability: what the range-aware rule
/// chooses from, for a look at a decision or for fitting the score to other rooms. Empty for other rules.
///
/// # Errors
/// [`ExitError::Config`].
pub fn candidates_of_profile(
    profile: &RangeProfile,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<Vec<Opening>, ExitError> {
    config.validate()?;
    Ok(match &config.rule {
        Rule::Paper(_) => Vec::new(),
        Rule::RangeAware(rule) => range_aware::candidates(profile, rule, view, config),
    })
}
