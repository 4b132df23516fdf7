//! What the mission knows from its inputs: time, pose, tracking, battery, scale, and where it has been.

use core::time::Duration;

use nalgebra::{Isometry3, Point3, Vector3};
use slam_bridge::{Map, SlamUpdate, TrackingState};
use tello_sdk::Telemetry;

use super::trail::{Trail, TrailPose};
use crate::calibration::Calibration;
use crate::heading::LevelPose;

/// The latest of everything.
#[derive(Debug, Clone, Default)]
pub(super) struct Knowledge {
    now: Duration,
    telemetry: Telemetry,
    tracking: TrackingState,
    camera: Option<Isometry3<f64>>,
    epoch: u64,
    untracked_since: Option<Duration>,
    calibration: Calibration,
    trail: Trail,
}

impl Knowledge {
    pub(super) fn observe(
        &mut self,
        now: Duration,
        telemetry: &Telemetry,
        slam: Option<&SlamUpdate>,
    ) {
        self.now = self.now.max(now);
        self.telemetry = *telemetry;
        if let Some(update) = slam {
            self.observe_slam(update);
        }
    }

    fn observe_slam(&mut self, update: &SlamUpdate) {
        if update.epoch != self.epoch {
            // A new map has a new frame and a new unit: nothing measured before holds.
            self.calibration = Calibration::default();
            self.epoch = update.epoch;
        }
        self.tracking = update.state;
        self.camera = update
            .world_from_camera
            .filter(|_| update.state == TrackingState::Tracking);
        match self.camera {
            Some(world_from_camera) => {
                self.untracked_since = None;
                self.trail.push(TrailPose {
                    time: update.time,
                    epoch: update.epoch,
                    world_from_camera,
                });
            }
            None => {
                self.untracked_since.get_or_insert(update.time);
            }
        }
    }

    pub(super) fn now(&self) -> Duration {
        self.now
    }

    /// Height above the ground, metres, where the drone tells it: by the distance sensor, since the other height misses 0.1 to 0.35 m
    /// that are drawn anew with each take-off.
    pub(super) fn height_m(&self) -> Option<f64> {
        let told = [
            self.telemetry.tof_m.as_ref(),
            self.telemetry.height_m.as_ref(),
        ];
        let mut valid = told.into_iter().flatten().filter(|reading| reading.valid);
        valid.next().map(|reading| reading.value)
    }

    /// Heading as the drone tells it, radians, clockwise, from wherever it was switched on.
    pub(super) fn heading(&self) -> Option<f64> {
        let attitude = self.telemetry.attitude.as_ref();
        attitude
            .filter(|reading| reading.valid)
            .map(|reading| reading.value.yaw_deg.to_radians())
    }

    /// Charge in percent, where the drone tells it.
    pub(super) fn battery_percent(&self) -> Option<u8> {
        self.telemetry
            .battery
            .as_ref()
            .map(|reading| reading.value.percent())
    }

    pub(super) fn epoch(&self) -> u64 {
        self.epoch
    }

    pub(super) fn is_tracking(&self) -> bool {
        self.tracking == TrackingState::Tracking
    }

    /// How long the pose has been unknown; zero while tracking.
    pub(super) fn untracked_for(&self) -> Duration {
        self.untracked_since
            .map_or(Duration::ZERO, |since| self.now.saturating_sub(since))
    }

    pub(super) fn tracked_position(&self) -> Option<(u64, Point3<f64>)> {
        self.camera
            .map(|camera| (self.epoch, Point3::from(camera.translation.vector)))
    }

    /// The drone's pose, level, if it is tracked.
    pub(super) fn pose(&self) -> Option<LevelPose> {
        LevelPose::from_camera(&self.camera?, self.up())
    }

    pub(super) fn up(&self) -> Vector3<f64> {
        self.calibration.up()
    }

    pub(super) fn meters_per_unit(&self) -> Option<f64> {
        self.calibration.meters_per_unit()
    }

    pub(super) fn calibrate(&mut self, commanded: Vector3<f64>, measured: Vector3<f64>) {
        self.calibration.add(commanded, measured);
    }

    pub(super) fn trail(&self) -> &Trail {
        &self.trail
    }

    /// Moves the flown path to where the map's keyframes are now.
    pub(super) fn follow_map(&mut self, map: &Map) {
        self.trail.follow_map(map);
    }
}
