//! The rules that tell an opening from a wall, on the finished profile.

mod contour;
mod cues;
mod forest;
mod line;
mod openings;
mod paper;
mod range_aware;
mod ranking;
mod score;
mod sight;
mod smoothing;
mod unseen;
mod wall;

pub use cues::{CUE_NAMES, CUES};
pub(crate) use line::Line;
pub use openings::Opening;
pub use score::ScoreParts;

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
