//! Tracking a recorded sequence: frame after frame through the odometry, edges of keyframes into space.

mod depth;
mod epoch;
mod pictures;
mod run;

pub(crate) use depth::{DepthReport, Depths};
pub(crate) use epoch::Epoch;
pub(crate) use pictures::draw_frame;
pub(crate) use run::{Tracking, camera_of, track, unreadable};
