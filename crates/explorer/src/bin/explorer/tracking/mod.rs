//! Tracking a recorded sequence: frame after frame through the odometry, edges of keyframes into space,
//! poses through the filter where the flight's telemetry was recorded.

mod caption;
mod depth;
mod depth_picture;
mod epoch;
mod flight;
mod fusing;
mod pictures;
mod run;

pub(crate) use depth::{DepthReport, Depths};
pub(crate) use epoch::Epoch;
pub(crate) use flight::Flight;
pub(crate) use fusing::{Fusing, FusionReport};
pub(crate) use pictures::{FrameName, draw_frame, remove_old};
pub(crate) use run::{Tracking, camera_of, track, unreadable};
