//! From a map to ranked exits in one call.

use crate::config::{ExitConfig, Rule};
use crate::error::ExitError;
use crate::exit::ExitReport;
use crate::plane::AffinePlane;
use crate::points::PointLike;
use crate::profile::RangeProfile;
use crate::rule::{SecondLook, exits_of_cleaned, exits_of_profile, looked_at_twice};
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
    let (profile, kept) = looks(points, agent, plane, view, config)?;
    match kept {
        Some(kept) => exits_of_cleaned(profile, &kept, view, config),
        None => exits_of_profile(profile, view, config),
    }
}

/// All stretches of walls that may be openings in a map that was cleaned by its observations (`view.rays` and `view.doubtful` are
/// given), with the cues of the second look at them; what [`find_exits`] chooses from. Empty for other maps, and for Algorithm 2.
///
/// # Errors
/// As [`find_exits`].
pub fn candidates_of_cleaned<P: PointLike>(
    points: &[P],
    agent: [f64; 3],
    plane: &AffinePlane,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<Vec<SecondLook>, ExitError> {
    let (profile, kept) = looks(points, agent, plane, view, config)?;
    match kept {
        Some(kept) => looked_at_twice(&profile, &kept, view, config),
        None => Ok(Vec::new()),
    }
}

/// The profile of all points, doubtful ones as well, and, where the cleaning knew who saw what, that of the kept ones alone.
fn looks<P: PointLike>(
    points: &[P],
    agent: [f64; 3],
    plane: &AffinePlane,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Result<(RangeProfile, Option<RangeProfile>), ExitError> {
    let closing = view.virtual_points;
    let all = RangeProfile::of_cleaned(points, view.doubtful, closing, agent, plane, config)?;
    let is_paper = matches!(config.rule, Rule::Paper(_));
    if is_paper || view.rays.is_empty() || view.doubtful.is_empty() {
        return Ok((all, None));
    }
    match RangeProfile::of_points(points, closing, agent, plane, config) {
        Ok(kept) => Ok((all, Some(kept))),
        // Hardly anything was kept: there is one look.
        Err(ExitError::InsufficientMap { .. }) => Ok((all, None)),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Ray;

    #[test]
    fn a_map_cleaned_by_observations_is_looked_at_twice() {
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
        let given = |kept: &[[f64; 3]], doubtful: &[[f64; 3]], rays: &[Ray], config| {
            let view = ExitView {
                doubtful,
                rays,
                ..ExitView::default()
            };
            let (all, alone) = looks(kept, [0.0; 3], &plane, &view, config).unwrap();
            (all.counts.given, alone.map(|profile| profile.counts.given))
        };
        let default = ExitConfig::default();
        assert_eq!(given(&kept, &doubtful, &[ray], &default), (1001, Some(870)));
        // Without observations the cleaning knew little; Algorithm 2 knows no doubt; of a few points no profile is made.
        assert_eq!(given(&kept, &doubtful, &[], &default), (1001, None));
        assert_eq!(given(&kept, &[], &[ray], &default), (870, None));
        assert_eq!(given(&kept[..20], &doubtful, &[ray], &default), (151, None));
        assert_eq!(
            given(&kept, &doubtful, &[ray], &ExitConfig::paper()),
            (1001, None)
        );
    }
}
