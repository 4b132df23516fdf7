#![doc = include_str!("../README.md")]

mod fields;
mod files;
mod keyframes;
mod lines;
mod map;
mod observations;
mod pcd;
mod ply;
mod read_error;
mod source;
mod tum;
mod xyz;

pub use files::{MOST_MAP_BYTES, MapFileError, read_map, read_map_folder, write_map_folder};
pub use keyframes::{read_keyframes, write_keyframes};
pub use map::{Frustum, KeyFrame, KeyFrameId, Map, MapPoint, PointId, Scale};
pub use nalgebra;
pub use observations::{Unmatched, read_observations, write_observations};
pub use pcd::read_pcd;
pub use ply::{read_ply, write_ply};
pub use read_error::{Fault, Place, ReadError};
pub use source::{SlamSource, SlamUpdate, TrackingState};
pub use tum::{TimedPose, read_tum, write_tum};
pub use xyz::read_xyz;
