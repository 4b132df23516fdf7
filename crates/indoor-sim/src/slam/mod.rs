//! A stand-in for sparse monocular SLAM: it sees the true landmarks as a feature tracker would and builds a map from them
//! that is as sparse, as noisy and as wrong as a real one.

mod config;
mod culling;
mod detection;
mod drift;
mod export;
mod initialization;
mod mapping;
mod outlier;
mod tracking;
mod triangulation;

pub use config::SlamConfig;
pub use outlier::Outlier;

use core::time::Duration;
use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::{Isometry3, Similarity3};
use rand_pcg::Pcg64;
use slam_bridge::{Map, PointId, SlamSource, SlamUpdate, TrackingState};

use crate::camera::Camera;
use crate::random::{Purpose, stream, uniform};
use crate::world::World;
use detection::Detection;
use mapping::Mapping;

/// The stand-in. It is fed pictures by the simulator and read through [`SlamSource`].
#[derive(Debug, Clone)]
pub struct SyntheticSlam {
    world: Arc<World>,
    camera: Camera,
    config: SlamConfig,
    rng: Pcg64,
    state: TrackingState,
    epoch: u64,
    mapping: Mapping,
    /// Map units per metre.
    units: f64,
    reference: Option<Reference>,
    last: Option<LastFrame>,
    failing_since: Option<Duration>,
    updates: VecDeque<SlamUpdate>,
}

/// The picture that a map may begin with.
#[derive(Debug, Clone)]
struct Reference {
    time: Duration,
    pose: Isometry3<f64>,
    detections: Vec<Detection>,
}

/// What the next frame needs of the last one.
#[derive(Debug, Clone)]
struct LastFrame {
    keyframe_time: Duration,
    keyframe_pose: Isometry3<f64>,
    keyframe_tracked: usize,
    pose: Isometry3<f64>,
    drift: drift::Drift,
    slide: drift::Slide,
    jitter: nalgebra::Vector3<f64>,
}

/// The truth about a map point, for evaluation only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointTruth {
    /// Where the surface point truly is, metres in the world.
    pub position: [f64; 3],
    /// How the map point is wrong, if it is.
    pub outlier: Option<Outlier>,
}

impl SyntheticSlam {
    pub(crate) fn new(world: Arc<World>, camera: Camera, config: SlamConfig, seed: u64) -> Self {
        let mut rng = stream(seed, Purpose::Slam);
        let units = draw_units(&config, &mut rng);
        let mapping = Mapping::new(world.landmarks().len());
        Self {
            world,
            camera,
            config,
            rng,
            state: TrackingState::NotInitialized,
            epoch: 0,
            mapping,
            units,
            reference: None,
            last: None,
            failing_since: None,
            updates: VecDeque::new(),
        }
    }

    /// The state after the newest frame.
    #[must_use]
    pub fn state(&self) -> TrackingState {
        self.state
    }

    /// Forgets the map and begins a new epoch with another scale: the camera must be translated again.
    pub fn reset(&mut self) {
        self.epoch += 1;
        self.units = draw_units(&self.config, &mut self.rng);
        self.mapping = Mapping::new(self.world.landmarks().len());
        self.state = TrackingState::NotInitialized;
        self.reference = None;
        self.last = None;
        self.failing_since = None;
    }

    /// Map coordinates to the world's, for evaluation only; `None` before there is a map. Exact at the first keyframe; the
    /// map's drift is not in it, because that is the map's error.
    #[must_use]
    pub fn world_from_map(&self) -> Option<Similarity3<f64>> {
        let first = self.mapping.frames.first()?;
        Some(Similarity3::from_isometry(
            first.true_pose,
            1.0 / self.units,
        ))
    }

    /// The truth about a point of the current map, for evaluation only. Cost: a binary search.
    #[must_use]
    pub fn point_truth(&self, id: PointId) -> Option<PointTruth> {
        let points = &self.mapping.points;
        let index = points.binary_search_by_key(&id.0, |point| point.id).ok()?;
        let point = points.get(index)?;
        let position = self
            .world
            .landmarks()
            .get(point.landmark as usize)?
            .position;
        Some(PointTruth {
            position,
            outlier: point.outlier,
        })
    }
}

impl SlamSource for SyntheticSlam {
    fn poll(&mut self) -> Option<SlamUpdate> {
        self.updates.pop_front()
    }

    fn map(&self) -> Map {
        self.export()
    }
}

/// Map units per metre, evenly drawn in the logarithm.
fn draw_units(config: &SlamConfig, rng: &mut Pcg64) -> f64 {
    uniform(rng, config.scale.0.ln(), config.scale.1.ln()).exp()
}
