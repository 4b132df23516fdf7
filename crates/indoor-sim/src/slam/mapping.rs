//! The map being built: keyframes, points and which keyframe saw which, in metres of the drifted space.

use nalgebra::{Isometry3, Point3, Vector3};
use rand::{Rng, RngExt};
use slam_bridge::KeyFrameId;

use super::config::SlamConfig;
use super::detection::Detection;
use super::drift::Drift;
use super::outlier::{Outlier, Outliers};
use super::triangulation::{Information, parallax};
use crate::random::{normal, normal3};
use crate::world::World;

/// One keyframe.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub(crate) time: f64,
    pub(crate) true_pose: Isometry3<f64>,
    pub(crate) estimate: Isometry3<f64>,
    pub(crate) drift: Drift,
    /// Points that it observes; a removed keyframe observes none.
    pub(super) points: Vec<u32>,
    /// Whether it is still part of the map.
    pub(crate) kept: bool,
}

impl Frame {
    pub(crate) fn new(
        time: f64,
        true_pose: Isometry3<f64>,
        estimate: Isometry3<f64>,
        drift: Drift,
    ) -> Self {
        Self {
            time,
            true_pose,
            estimate,
            drift,
            points: Vec::new(),
            kept: true,
        }
    }
}

/// One map point.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    pub(crate) id: u64,
    pub(crate) landmark: u32,
    pub(crate) outlier: Option<Outlier>,
    pub(crate) observers: Vec<KeyFrameId>,
    /// Where the map has it, metres of the drifted space.
    pub(crate) estimate: Vector3<f64>,
    pub(crate) information: Information,
    /// The keyframe whose drift it was made with.
    pub(crate) born: u32,
    /// Whether it is still part of the map.
    pub(crate) kept: bool,
    /// For a wrong point: where it would be without drift.
    wrong: Option<Vector3<f64>>,
    draw: Vector3<f64>,
    floor_draw: f64,
}

/// Keyframes, points, and what is known of each landmark.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mapping {
    pub(crate) frames: Vec<Frame>,
    pub(crate) points: Vec<Point>,
    /// The point of each landmark, or [`NONE`].
    pub(super) owner: Vec<u32>,
    sightings: Vec<Vec<u32>>,
    outliers: Outliers,
    next_id: u64,
}

/// No map point.
pub(super) const NONE: u32 = u32::MAX;

/// Keyframes that a landmark without a point is remembered from.
const MEMORY: usize = 8;

/// Focal length that turns pixel noise into bearing noise is the camera's; this is the growth per pyramid octave that
/// corners have on average: between 1 and 1.2⁷.
const OCTAVE_GROWTH: f64 = 1.5;

/// Corners differ in how well they are localised: the logarithm of a point's share of the noise has this deviation.
const QUALITY_SPREAD: f64 = 0.6;

impl Mapping {
    pub(crate) fn new(landmarks: usize) -> Self {
        Self {
            owner: vec![NONE; landmarks],
            sightings: vec![Vec::new(); landmarks],
            ..Self::default()
        }
    }

    /// Adds a keyframe: matched points get a view, other landmarks are remembered and triangulated where two keyframes
    /// see them with enough parallax.
    pub(crate) fn insert(
        &mut self,
        frame: Frame,
        detections: &[Detection],
        matched: &[u32],
        surroundings: &mut Surroundings<'_, impl Rng>,
    ) {
        let number = self.frames.len() as u32;
        self.frames.push(frame);
        for &index in matched {
            self.add_view(index as usize, number, surroundings);
        }
        for detection in detections {
            let landmark = detection.landmark as usize;
            if self.owner[landmark] == NONE {
                self.try_triangulate(detection.landmark, number, surroundings);
                if self.sightings[landmark].len() == MEMORY {
                    self.sightings[landmark].remove(0);
                }
                self.sightings[landmark].push(number);
            }
        }
        self.cull_points(number);
        self.cull_frames(number);
    }

    fn add_view(&mut self, index: usize, frame: u32, surroundings: &Surroundings<'_, impl Rng>) {
        let center = self.frames[frame as usize].true_pose.translation.vector;
        let point = &mut self.points[index];
        let place = Vector3::from(surroundings.world.landmarks()[point.landmark as usize].position);
        point.observers.push(KeyFrameId(u64::from(frame)));
        self.frames[frame as usize].points.push(index as u32);
        point
            .information
            .add_view(place - center, surroundings.bearing_noise());
        self.settle(index, surroundings);
    }

    /// Puts a point where its information says.
    fn settle(&mut self, index: usize, surroundings: &Surroundings<'_, impl Rng>) {
        let drift = self.frames[self.points[index].born as usize].drift;
        let point = &mut self.points[index];
        let place = Vector3::from(surroundings.world.landmarks()[point.landmark as usize].position);
        let error = point.information.error(
            point.draw,
            point.floor_draw,
            surroundings.config.depth_floor,
        );
        let undrifted = point.wrong.unwrap_or(place) + error;
        point.estimate = (drift * Point3::from(undrifted)).coords;
    }

    fn try_triangulate(
        &mut self,
        landmark: u32,
        frame: u32,
        surroundings: &mut Surroundings<'_, impl Rng>,
    ) {
        let place = Vector3::from(surroundings.world.landmarks()[landmark as usize].position);
        let center = self.frames[frame as usize].true_pose.translation.vector;
        let frames = &self.frames;
        self.sightings[landmark as usize].retain(|&other| frames[other as usize].kept);
        let wide = |&other: &u32| {
            let from = frames[other as usize].true_pose.translation.vector;
            parallax(place, from, center) >= surroundings.config.least_parallax
        };
        if !self.sightings[landmark as usize].iter().any(wide) {
            return;
        }
        if surroundings.rng.random::<f64>() >= surroundings.config.triangulation_chance {
            return;
        }
        self.create(landmark, frame, surroundings);
    }

    /// Makes a point of a landmark that the newest keyframe and remembered ones see.
    fn create(&mut self, landmark: u32, frame: u32, surroundings: &mut Surroundings<'_, impl Rng>) {
        let place = Vector3::from(surroundings.world.landmarks()[landmark as usize].position);
        let center = self.frames[frame as usize].true_pose.translation.vector;
        let rate = surroundings.config.outlier_rate;
        let wrong = self
            .outliers
            .draw(place - center, center, rate, surroundings.rng);
        let mut observers = core::mem::take(&mut self.sightings[landmark as usize]);
        observers.push(frame);
        if wrong.is_some() {
            // A wrong match is wrong in one pair of pictures, seldom in more.
            let most = surroundings.rng.random_range(2..=3_usize);
            observers.drain(..observers.len().saturating_sub(most));
        }
        let mut information = Information::default();
        for &observer in &observers {
            let from = self.frames[observer as usize].true_pose.translation.vector;
            information.add_view(place - from, surroundings.bearing_noise());
        }
        let quality = (QUALITY_SPREAD * normal(surroundings.rng)).exp();
        let index = self.points.len() as u32;
        self.owner[landmark as usize] = index;
        for &observer in &observers {
            self.frames[observer as usize].points.push(index);
        }
        self.points.push(Point {
            id: self.next_id,
            landmark,
            outlier: wrong.map(|(_, kind)| kind),
            observers: observers
                .iter()
                .map(|&o| KeyFrameId(u64::from(o)))
                .collect(),
            estimate: Vector3::zeros(),
            information,
            born: frame,
            kept: true,
            wrong: wrong.map(|(ray, _)| center + ray),
            draw: normal3(surroundings.rng) * quality,
            floor_draw: normal(surroundings.rng) * quality,
        });
        self.next_id += 1;
        self.settle(self.points.len() - 1, surroundings);
    }

    /// Begins the map with two keyframes: every landmark that both see with half the usual parallax becomes a point.
    pub(crate) fn begin(
        &mut self,
        first: (Frame, &[Detection]),
        second: (Frame, &[Detection]),
        surroundings: &mut Surroundings<'_, impl Rng>,
    ) {
        let centers = [first.0.true_pose, second.0.true_pose].map(|pose| pose.translation.vector);
        self.frames = vec![first.0, second.0];
        for detection in first.1 {
            self.sightings[detection.landmark as usize].push(0);
        }
        for detection in second.1 {
            let landmark = detection.landmark as usize;
            let place = Vector3::from(surroundings.world.landmarks()[landmark].position);
            let wide =
                parallax(place, centers[0], centers[1]) >= 0.5 * surroundings.config.least_parallax;
            let matched = surroundings.rng.random::<f64>() < surroundings.config.match_chance;
            if !self.sightings[landmark].is_empty() && wide && matched {
                self.create(detection.landmark, 1, surroundings);
            } else {
                self.sightings[landmark].push(1);
            }
        }
    }

    /// Index of the point of a landmark.
    pub(crate) fn index_of(&self, landmark: u32) -> Option<u32> {
        self.owner
            .get(landmark as usize)
            .copied()
            .filter(|&owner| owner != NONE)
    }
}

/// What mapping needs besides the map.
pub(crate) struct Surroundings<'a, R> {
    pub(crate) world: &'a World,
    pub(crate) config: &'a SlamConfig,
    pub(crate) focal: f64,
    pub(crate) rng: &'a mut R,
}

impl<R> Surroundings<'_, R> {
    fn bearing_noise(&self) -> f64 {
        OCTAVE_GROWTH * self.config.pixel_noise / self.focal
    }
}
