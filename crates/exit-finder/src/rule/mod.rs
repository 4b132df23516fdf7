//! The rules that tell an opening from a wall, on the finished profile.

mod contour;
mod evidence;
pub use evidence::ScoreParts;
mod line;
pub(crate) use line::Line;
mod matched;
mod paper;
mod range_aware;
mod ranking;
mod smoothing;
mod unseen;

use crate::config::{ExitConfig, Rule};
use crate::error::ExitError;
use crate::exit::ExitReport;
use crate::profile::RangeProfile;
use crate::view::ExitView;

/// Looks for exits on a profile that exists already, kept up to date by
/// a caller. O(bins · window).
///
/// `view.virtual_points` is not used here: they are part of the profile.
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
