//! The odometry's poses through the Kalman filter, together with the telemetry of a recorded flight.

use edge_slam::nalgebra::{Isometry3, Similarity3, Vector3};
use edge_slam::odometry::{FusedPose, TelemetryFusion, Tracked};
use serde::Serialize;
use slam_bridge::TrackingState;

use super::Flight;
use crate::failure::Failure;

/// What the command says about the filter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct FusionReport {
    /// telemetry, or none: then poses are the odometry's own.
    pub(crate) source: &'static str,
    /// The recording.
    pub(crate) file: Option<String>,
    /// State lines that moved the filter, and those without a velocity.
    pub(crate) samples: usize,
    pub(crate) unusable_samples: usize,
    /// Bytes at the recording's end that are torn or damaged.
    pub(crate) damaged_bytes: usize,
    /// Visual poses that the filter took, and that its gate refused.
    pub(crate) accepted: usize,
    pub(crate) rejected: usize,
    /// Poses by telemetry alone: tracking was lost or the unit not known yet.
    pub(crate) dead_reckoned: usize,
    /// Frames before the first sample or long after the last, which have no pose.
    pub(crate) outside: usize,
    /// Metres per unit of the written map's odometry, by the filter.
    pub(crate) meters_per_unit: Option<f64>,
}

impl FusionReport {
    pub(crate) fn none() -> Self {
        Self {
            source: "none",
            file: None,
            samples: 0,
            unusable_samples: 0,
            damaged_bytes: 0,
            accepted: 0,
            rejected: 0,
            dead_reckoned: 0,
            outside: 0,
            meters_per_unit: None,
        }
    }
}

/// The filter, on its way through a flight.
#[derive(Debug)]
pub(crate) struct Fusing {
    flight: Flight,
    filter: TelemetryFusion,
    /// The world that is written: the camera at the filter's start, as without telemetry.
    written_from_filter: Isometry3<f64>,
    next: usize,
    end: f64,
    pub(crate) report: FusionReport,
}

/// How long the last velocity is believed, seconds.
const LONGEST_GAP: f64 = 1.0;

impl Fusing {
    /// Begins at the first sample. `frames` are the times of the first and the last frame.
    pub(crate) fn new(flight: Flight, frames: [f64; 2]) -> Result<Self, Failure> {
        let [begin, end] = flight.span().unwrap_or_default();
        if !(begin <= frames[1] && end >= frames[0]) {
            let reason = format!(
                "{}: telemetry from {begin:.3} to {end:.3} s, but frames from {:.3} to {:.3} s",
                flight.path.display(),
                frames[0],
                frames[1]
            );
            let advice = "say with --telemetry-start when, on the frames' clock, the recording began, or use --telemetry none";
            return Err(Failure::new(reason, advice));
        }
        let mut config = TelemetryFusion::turning();
        config.velocity_frame = flight.velocity_frame;
        let attitude = flight.samples.iter().find_map(|(_, attitude)| *attitude);
        let attitude = attitude.map_or_else(Vector3::zeros, |sample| sample.angles);
        let camera = TelemetryFusion::looking_ahead();
        let filter =
            TelemetryFusion::new(config, camera, begin, attitude).map_err(|error| steep(&error))?;
        let report = FusionReport {
            source: "telemetry",
            file: Some(flight.path.display().to_string()),
            unusable_samples: flight.unusable,
            damaged_bytes: flight.damaged_bytes,
            ..FusionReport::none()
        };
        Ok(Self {
            written_from_filter: filter.world_from_camera().inverse(),
            flight,
            filter,
            next: 0,
            end: end + LONGEST_GAP,
            report,
        })
    }

    /// The frame's pose by the filter, and whether it took a visual one; `None` outside of the telemetry.
    pub(crate) fn observe(
        &mut self,
        time: f64,
        tracked: &Tracked,
        epoch: u64,
        is_metric: bool,
    ) -> Result<Option<(Isometry3<f64>, bool)>, Failure> {
        self.feed(time)?;
        if self.next == 0 || time > self.end {
            self.report.outside += 1;
            return Ok(None);
        }
        let fused = match self.filter.observe(time, tracked, epoch, is_metric) {
            Ok(fused) => fused,
            Err(error) if time < self.filter.ekf().time() => {
                let advice = "sort the sequence's frames by time, or use --telemetry none";
                return Err(Failure::new(error, advice));
            }
            // A camera that looks straight up or down has no Euler angles: the filter goes on without this pose.
            Err(_) => self.reckon(time, epoch, is_metric)?,
        };
        self.count(&fused);
        let is_seen = fused.outcome.is_some_and(|outcome| outcome.accepted);
        Ok(Some((
            self.written_from_filter * fused.world_from_camera,
            is_seen,
        )))
    }

    /// Takes the odometry of the present epoch to the written world, once its unit is known.
    pub(crate) fn placed(&self) -> Option<Similarity3<f64>> {
        let placed = self.filter.world_from_odometry()?;
        Some(self.written_from_filter * placed)
    }

    /// All samples up to the frame.
    fn feed(&mut self, time: f64) -> Result<(), Failure> {
        while let Some((sample, attitude)) = self.flight.samples.get(self.next) {
            if sample.time > time {
                break;
            }
            let steep_one = self.filter.telemetry(sample, attitude.as_ref());
            if steep_one.is_err() {
                self.filter
                    .telemetry(sample, None)
                    .map_err(|error| steep(&error))?;
            }
            self.report.samples += 1;
            self.next += 1;
        }
        Ok(())
    }

    fn reckon(&mut self, time: f64, epoch: u64, is_metric: bool) -> Result<FusedPose, Failure> {
        let lost = Tracked {
            state: TrackingState::Lost,
            world_from_camera: None,
            inliers: 0,
            is_keyframe: false,
        };
        let fused = self.filter.observe(time, &lost, epoch, is_metric);
        fused.map_err(|error| steep(&error))
    }

    fn count(&mut self, fused: &FusedPose) {
        match fused.outcome {
            Some(outcome) if outcome.accepted => self.report.accepted += 1,
            Some(_) => self.report.rejected += 1,
            None => self.report.dead_reckoned += 1,
        }
    }
}

fn steep(error: &edge_slam::fusion::FusionError) -> Failure {
    Failure::new(
        format!("the telemetry cannot be fused: {error}"),
        "use --telemetry none",
    )
}
