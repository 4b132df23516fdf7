//! Two views: relative pose from matched pixels, triangulation, and telling when there is no pose to be had.

mod config;
mod essential;
mod estimate;
mod five_point;
mod homography;
mod matches;
mod minima;
mod polynomial;
mod ransac;
mod refine;
mod rotation;
mod sampson;
mod triangulation;
mod uncertainty;
mod verdict;

pub use config::{TwoViewConfig, TwoViewError};
pub use essential::{candidate_poses, essential_of};
pub use estimate::{Geometry, TwoView, estimate_two_view};
pub use five_point::essential_from_five;
pub use homography::homography_from_points;
pub use refine::refine_relative_pose;
pub use rotation::fit_rotation;
pub use sampson::sampson;
pub use triangulation::{Triangulated, triangulate};
pub use uncertainty::direction_deviation;
