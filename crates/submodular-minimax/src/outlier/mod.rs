//! Outlier removal for point clouds as a minimax problem over a jointly submodular function.
//!
//! X is the set of points that join the inliers, Y a set of representatives chosen against it:
//!
//! ```text
//! f(X ∪ Y) = Σ_{v ∉ X} max_{u ∈ Y} s(u, v) − 1/n Σ_{v ∈ Y} Σ_{u ∈ Y} s(u, v) + Σ_{v ∈ X} λ(v)
//! ```

mod affinity;
mod config;
mod error;
mod removal;

pub use config::{OutlierConfig, Reading, Solver};
pub use error::OutlierError;
pub use removal::OutlierRemoval;

use crate::minimax::{Certificate, StopReason};
use crate::points::{Cloud, PointLike};
use crate::views::Views;
use affinity::Affinity;

/// Splits the points into inliers and outliers.
///
/// Points and camera positions share one frame and one unit, whatever it is. The result does not
/// depend on the order of the points, on their scale or on the number of threads. No points, fewer
/// than five points and points without spacing (more than half of them identical) are all kept.
///
/// # Errors
/// Points that are not finite, observations of another number of points, settings out of range.
pub fn remove_outliers<P: PointLike>(
    points: &[P],
    views: Option<&Views>,
    config: &OutlierConfig,
) -> Result<OutlierRemoval, OutlierError> {
    config.validate()?;
    let cloud = Cloud::new(points)?;
    if let Some(views) = views.filter(|views| views.points() != cloud.len()) {
        return Err(OutlierError::ViewsMismatch {
            points: cloud.len(),
            views: views.points(),
        });
    }
    let n = cloud.len();
    let threshold = (1.0 + config.beta.value(n)) * config.lambda;
    if config.reading == Reading::Literal {
        return Ok(removal(vec![0.0; n], config.lambda));
    }
    let Some(affinity) = Affinity::new(&cloud, config) else {
        return Ok(removal(vec![0.0; n], config.lambda));
    };
    let scores = (0..n).map(|v| threshold - affinity.best(v)).collect();
    Ok(removal(scores, config.lambda))
}

fn removal(scores: Vec<f64>, lambda: f64) -> OutlierRemoval {
    let (removed, kept): (Vec<usize>, Vec<usize>) =
        (0..scores.len()).partition(|&v| scores[v] > 0.0);
    let upper_bound = lambda * kept.len() as f64;
    OutlierRemoval {
        kept,
        removed,
        scores,
        iterations: 1,
        certificate: Certificate {
            lower_bound: 0.0,
            upper_bound,
        },
        stop: StopReason::ClosedForm,
    }
}
