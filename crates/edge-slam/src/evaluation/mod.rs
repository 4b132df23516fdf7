//! How far an estimated trajectory or map is from a reference: association, alignment, APE, RPE, map accuracy.
//!
//! Definitions follow the TUM RGB-D benchmark (Sturm et al., IROS 2012) in the form the `evo` tool made
//! customary, so that figures can be compared with published ones.

mod align;
mod align_poses;
mod ape;
mod associate;
mod error;
mod map_accuracy;
mod rpe;
mod statistics;

pub(crate) use align::rotation_between;
pub use align::{AlignBy, Alignment, Similarity, align_points};
pub use align_poses::align_poses;
pub use ape::{AbsolutePoseError, ApeConfig, absolute_pose_error};
pub use associate::associate;
pub use error::EvaluationError;
pub use map_accuracy::{MapAccuracy, map_accuracy};
pub use rpe::{RelativePoseError, RpeConfig, RpeInterval, relative_pose_error};
pub use slam_bridge::TimedPose;
pub use statistics::ErrorStatistics;
