//! What a running SLAM system tells: a pose per frame, whether to trust it, and the map on request.

use core::time::Duration;

use nalgebra::Isometry3;

use crate::Map;

/// Whether the newest pose can be trusted. Only [`TrackingState::Tracking`] can.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TrackingState {
    /// No map yet: a monocular system needs translation first.
    #[default]
    NotInitialized,
    /// The pose is measured against the map.
    Tracking,
    /// The pose is unknown until the system recognises a place again.
    Lost,
}

/// The news of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SlamUpdate {
    /// When the frame was taken, on the caller's clock.
    pub time: Duration,
    /// Whether the pose can be trusted.
    pub state: TrackingState,
    /// Camera-to-world in map units; `Some` exactly when tracking.
    pub world_from_camera: Option<Isometry3<f64>>,
    /// The map's epoch (see [`Map::epoch`]) that the pose belongs to.
    pub epoch: u64,
    /// How many map points this frame was measured against.
    pub tracked_points: usize,
}

/// A running SLAM system, seen from outside.
pub trait SlamSource {
    /// The next update not yet handed out, oldest first; `None` when there is no news.
    fn poll(&mut self) -> Option<SlamUpdate>;

    /// The whole map as it is now. Costs a copy of the map.
    fn map(&self) -> Map;
}
