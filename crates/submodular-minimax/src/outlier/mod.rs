//! Outlier removal for point clouds as a minimax problem over a jointly submodular function.
//!
//! X is the set of points that join the inliers, Y a set of representatives chosen against it:
//!
//! ```text
//! f(X ∪ Y) = Σ_{v ∉ X} max_{u ∈ Y} s(u, v) − 1/n Σ_{v ∈ Y} Σ_{u ∈ Y} s(u, v) + Σ_{v ∈ X} λ(v)
//! ```

mod config;
mod cues;
mod depth_agreement;
mod error;
mod kernel_reading;
mod origin;
mod outline;
mod passing_rays;
mod planes;
mod problem;
mod ranged_reading;
mod removal;
mod sight;
mod solve;

pub use config::{OutlierConfig, RayConfig, Reading, Solver};
pub use cues::{AmongCameras, Cues, DepthSource, ImageNeighbours, Tolerance};
pub use error::OutlierError;
pub use removal::OutlierRemoval;

use crate::minimax::StopReason;
use crate::neighbours::RangeTree;
use crate::points::{Cloud, PointLike};
use crate::views::Views;
use sight::Sight;
use std::cell::LazyCell;

/// Splits the points into inliers and outliers.
///
/// Points and camera positions share one frame and one unit, whatever it is. Without `views` the
/// default asks whether the cloud thins out away from the origin, as maps do whose frame is that of
/// their first camera, and then takes it as seen from there; pass [`Views::from_position`] where you
/// know where the agent was. The result does not depend on the order of the points (but for exact ties), on a common scale or on the number of
/// threads. No points, fewer than five points and points without spacing (more than half of them
/// identical) are all kept. Cost: O(n log n) time, O(n) memory; with observations also one search per
/// tested camera and point.
///
/// ```
/// use submodular_minimax::{OutlierConfig, remove_outliers};
/// let mut points: Vec<[f64; 3]> =
///     (0..400).map(|i| [f64::from(i % 20) * 0.1, f64::from(i / 20) * 0.1, 0.0]).collect();
/// points.push([1.0, 1.0, 5.0]);
/// let cleaned = remove_outliers(&points, None, &OutlierConfig::default())?;
/// assert_eq!(cleaned.removed, [400]);
/// # Ok::<(), submodular_minimax::OutlierError>(())
/// ```
///
/// # Errors
/// Points that are not finite, observations of another number of points, a camera beyond 1e100 times the cloud's
/// size that sees points, settings out of range.
pub fn remove_outliers<P: PointLike>(
    points: &[P],
    views: Option<&Views>,
    config: &OutlierConfig,
) -> Result<OutlierRemoval, OutlierError> {
    config.validate()?;
    let cloud = Cloud::new(points)?;
    let n = cloud.len();
    if let Some(views) = views.filter(|views| views.points() != n) {
        return Err(OutlierError::ViewsMismatch {
            points: n,
            views: views.points(),
        });
    }
    if config.reading == Reading::Literal {
        return Ok(OutlierRemoval::keep_all(n, StopReason::Converged));
    }
    let tree = LazyCell::new(|| RangeTree::new(&cloud.points, &[]));
    let assumed = (views.is_none() && config.reading == Reading::Ranged)
        .then(|| origin::view(&cloud, &tree))
        .flatten();
    let sight = views
        .or(assumed.as_ref())
        .map(|views| Sight::new(&cloud, views))
        .transpose()?
        .flatten();
    let problem = match (&sight, config.reading) {
        (Some(sight), Reading::Ranged) => ranged_reading::problem(&cloud, sight, config),
        (sight, _) => kernel_reading::problem(&cloud, &tree, sight.as_ref(), config),
    };
    match problem {
        Some(problem) => solve::solve(&problem, config),
        None => Ok(OutlierRemoval::keep_all(n, StopReason::NoSpacing)),
    }
}
