//! From a map to ranked exits in one call.

use crate::config::{ExitConfig, Rule};
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
    let doubtful = believable(points.len(), view, config);
    let closing = view.virtual_points;
    let profile = RangeProfile::of_cleaned(points, doubtful, closing, agent, plane, config)?;
    exits_of_profile(profile, view, config)
}

/// The doubtful points, or none where they are too many to be mostly right. A cleaning that does not know who saw what takes out right
/// points in any number.
fn believable<'a>(kept: usize, view: &ExitView<'a>, config: &ExitConfig) -> &'a [[f64; 3]] {
    let most = match &config.rule {
        Rule::RangeAware(rule) if !view.rays.is_empty() => rule.max_doubtful,
        _ => 1.0,
    };
    let doubtful = view.doubtful;
    let share = doubtful.len() as f64 / (kept + doubtful.len()).max(1) as f64;
    if share <= most { doubtful } else { &[] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Ray;

    #[test]
    fn too_many_doubtful_points_are_left_out() {
        let on_circle = |k: u32| {
            let (sin, cos) = f64::from(k).sin_cos();
            [2.0 * cos, 2.0 * sin, 0.0]
        };
        let kept: Vec<[f64; 3]> = (0..870).map(on_circle).collect();
        let doubtful: Vec<[f64; 3]> = (870..1001).map(on_circle).collect();
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let ray = Ray {
            origin: [0.0; 3],
            end: kept[0],
        };
        let given = |doubtful: &[[f64; 3]], rays: &[Ray], config: &ExitConfig| {
            let view = ExitView {
                doubtful,
                rays,
                ..ExitView::default()
            };
            let report = find_exits(&kept, [0.0; 3], &plane, &view, config).unwrap();
            report.profile.counts.given
        };
        // Of a thousand points 130 are the most by default.
        let default = ExitConfig::default();
        assert_eq!(given(&doubtful[..130], &[ray], &default), 1000);
        assert_eq!(given(&doubtful, &[ray], &default), 870);
        // Without observations the cleaning knew little; Algorithm 2 knows no doubt.
        assert_eq!(given(&doubtful, &[], &default), 1001);
        assert_eq!(given(&doubtful, &[ray], &ExitConfig::paper()), 1001);
    }
}
