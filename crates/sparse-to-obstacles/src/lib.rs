#![doc = include_str!("../README.md")]

mod berth;
mod free_space;
mod hull;
mod kmeans;
mod obstacle;
mod point;
mod space;
mod vector;

pub use berth::Berth;
pub use free_space::{FreeSpace, FreeSpaceConfig, FreeSpaceError, Ray, VoxelState};
pub use hull::{Hull, HullKind};
pub use kmeans::{
    Clustering, KMeansConfig, KMeansError, KMeansMethod, KMeansSeeding, KMeansStop, kmeans,
    kmeans_from,
};
pub use obstacle::{FirstContact, ObstacleConfig, ObstacleError, ObstacleSet, ObstacleUpdate};
pub use point::PointLike;
pub use space::Space;
