//! Two views: relative pose from matched pixels, triangulation, and telling when there is no pose to be had.

mod essential;
mod estimate;
mod five_point;
mod homography;
mod polynomial;
mod ransac;
mod refine;
mod rotation;
mod sampson;
mod triangulation;

pub use essential::{candidate_poses, essential_of};
pub use estimate::{Geometry, TwoView, TwoViewConfig, TwoViewError, estimate_two_view};
pub use five_point::essential_from_five;
pub use homography::homography_from_points;
pub use refine::refine_relative_pose;
pub use rotation::fit_rotation;
pub use sampson::sampson;
pub use triangulation::{Triangulated, triangulate};
