//! What can be wrong with the input of proven free space.

use thiserror::Error;

/// Why a [`FreeSpace`](crate::FreeSpace) could not be built or extended.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FreeSpaceError {
    /// A field of the configuration is out of its range.
    #[error("{name} is {value:?}: it must be {range}")]
    OutOfRange {
        /// The field.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What is accepted.
        range: &'static str,
    },
    /// A ray has an end that is not finite.
    #[error("ray {index} has a coordinate that is not finite: remove it")]
    RayNotFinite {
        /// Index into the rays.
        index: usize,
    },
    /// A surface point is not finite.
    #[error("surface point {index} has a coordinate that is not finite: remove it")]
    PointNotFinite {
        /// Index into the points.
        index: usize,
    },
    /// A ball that is no ball.
    #[error(
        "a ball of radius {radius:?} is not usable: centre and radius must be finite, the radius at least 0"
    )]
    Ball {
        /// The radius given.
        radius: f64,
    },
    /// The grid would be too large.
    #[error(
        "an extent of {extent:?} at a resolution of {resolution:?} needs {voxels:.2e} voxels, more than \
         max_voxels = {max_voxels}: use a coarser resolution, a smaller max_range, or remove far points"
    )]
    TooManyVoxels {
        /// Extent of what was to be stored, map units.
        extent: [f64; 3],
        /// Edge length of a voxel.
        resolution: f64,
        /// Voxels needed.
        voxels: f64,
        /// Voxels allowed.
        max_voxels: usize,
    },
    /// More keyframes than can be told apart.
    #[error("more than {max} keyframes: build from fewer")]
    TooManyKeyframes {
        /// Most that are accepted.
        max: usize,
    },
}
