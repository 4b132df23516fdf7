//! From a map to ranked exits in one call.

use crate::config::ExitConfig;
use crate::error::ExitError;
use crate::exit::ExitReport;
use crate::plane::AffinePlane;
use crate::points::PointLike;
use crate::profile::RangeProfile;
use crate::rule::exits_of_profile;
use crate::view::ExitView;

/// Where does the range profile around `agent` open?
///
/// `points`, `agent` and `plane` share one frame and one unit (any scale). Points with a NaN or
/// infinite coordinate, points at the agent and points outside the height band are skipped and
/// counted in `report.profile.counts`. No exit at all is the result "enclosed", not an error.
///
/// Cost: O(n log(n / bins) + bins · window).
///
/// # Errors
/// [`ExitError::Config`], [`ExitError::Agent`], [`ExitError::InsufficientMap`].
///
/// # Example
/// ```
/// use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};
///
/// // A round room of radius 3 with a door of 20 degrees towards +x.
/// let wall: Vec<[f64; 3]> = (0..720)
///     .map(|i| f64::from(i) * 0.5)
///     .filter(|degrees| *degrees > 10.0 && *degrees < 350.0)
///     .map(|degrees| [3.0 * degrees.to_radians().cos(), 3.0 * degrees.to_radians().sin(), 1.0])
///     .collect();
/// let agent = [0.0, 0.0, 1.0];
/// let plane = AffinePlane::from_up([0.0, 0.0, 1.0], agent)?;
/// let report = find_exits(&wall, agent, &plane, &ExitView::default(), &ExitConfig::default())?;
/// let best = report.best().ok_or("no exit")?;
/// assert!(best.direction[0] > 0.99);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn find_exits<P: PointLike>(
    points: &[P],
    agent: [f64; 3],
    plane: &AffinePlane,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<ExitReport, ExitError> {
    let (doubtful, closing) = (view.doubtful, view.virtual_points);
    let profile = RangeProfile::of_cleaned(points, doubtful, closing, agent, plane, config)?;
    exits_of_profile(profile, view, config)
}
