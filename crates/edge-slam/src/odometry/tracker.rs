//! The odometry itself.
//!
//! 1. Features; matches with the keyframe (ORB), or its patches followed (KLT).
//! 2. Keyframe with points: pose by PnP from the last one; if that fails, again from the two-view rotation.
//!    Keyframe without points (monocular start): two-view pose once it is trusted; its median depth is the unit.
//! 3. Without measured depth, features of the keyframe that have no point, or one under a smaller angle, are triangulated with the
//!    frame. (Beside measured depth this was tried: points from a hand's tremble spoil the others.)
//! 4. Few inliers left: this frame becomes the keyframe; it inherits points, and gets new ones by depth or
//!    triangulation.
//! 5. Lost for too long: a new epoch begins at the last known pose.

use std::collections::VecDeque;

use core::time::Duration;

use nalgebra::Isometry3;
use rand::Rng;
use slam_bridge::{Map, SlamSource, SlamUpdate, TrackingState};

use super::front_end::FrontEnd;
use super::keyframe::Keyframe;
use super::map_builder::MapBuilder;
use super::sight::Sight;
use super::{OdometryConfig, OdometryError};
use crate::Frame;
use crate::camera::Camera;
use crate::depth::DepthImage;
use crate::feature::Match;
use crate::pnp::{PnpPose, refine_pose};
use crate::two_view::{Triangulated, TwoView, estimate_two_view};

/// What became of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracked {
    /// Whether the pose can be trusted.
    pub state: TrackingState,
    /// Camera-to-world, world = first camera of the epoch; `Some` exactly when tracking.
    pub world_from_camera: Option<Isometry3<f64>>,
    /// Points that support it.
    pub inliers: usize,
    /// Whether this frame became a keyframe.
    pub is_keyframe: bool,
}

/// Frame-to-keyframe odometry.
#[derive(Debug, Clone)]
pub struct Odometry {
    config: OdometryConfig,
    front_end: FrontEnd,
    keyframe: Option<Keyframe>,
    frame_from_keyframe: Isometry3<f64>,
    lost: usize,
    is_metric: bool,
    builder: MapBuilder,
    updates: VecDeque<SlamUpdate>,
}

impl Odometry {
    /// Odometry for one camera.
    ///
    /// # Errors
    /// [`OdometryError`] when a field is outside its range.
    pub fn new(camera: Camera, config: OdometryConfig) -> Result<Self, OdometryError> {
        config.validate()?;
        Ok(Self {
            config,
            front_end: FrontEnd::new(camera, &config)?,
            keyframe: None,
            frame_from_keyframe: Isometry3::identity(),
            lost: 0,
            is_metric: false,
            builder: MapBuilder::default(),
            updates: VecDeque::new(),
        })
    }

    /// Tracks one frame. `depth`, when given, is metric and registered (see [`crate::depth::DepthSource`]); give it
    /// from the first frame on or never. Any image is accepted; one without features is a lost frame. Depth of another size than the
    /// image is left out: it would be read in the wrong places.
    pub fn track(
        &mut self,
        frame: &Frame<'_>,
        depth: Option<&DepthImage>,
        rng: &mut impl Rng,
    ) -> Tracked {
        let size = [frame.image.width(), frame.image.height()];
        let depth = depth.filter(|depth| [depth.width(), depth.height()] == size);
        let frame = &Frame { depth, ..*frame };
        let tracked = match self.keyframe.take() {
            None => self.begin(Isometry3::identity(), frame),
            Some(mut keyframe) => {
                let (sight, matches) = self.front_end.follow(&mut keyframe, frame);
                if keyframe.known_points() == 0 {
                    self.initialise(&mut keyframe, &sight, &matches, rng);
                }
                self.follow(keyframe, sight, &matches, frame, rng)
            }
        };
        self.updates.push_back(SlamUpdate {
            time: Duration::try_from_secs_f64(frame.time).unwrap_or_default(),
            state: tracked.state,
            world_from_camera: tracked.world_from_camera,
            epoch: self.builder.map().epoch,
            tracked_points: tracked.inliers,
        });
        tracked
    }

    /// The map so far.
    #[must_use]
    pub fn current_map(&self) -> &Map {
        self.builder.map()
    }

    /// Pixels (of the image as it came) and depths of the points that the newest keyframe knows, in the map's unit:
    /// what a predicted depth image can be held against ([`crate::depth::fit_depth`]).
    pub fn reference_points(&self) -> impl Iterator<Item = ([f64; 2], f64)> {
        let sight = self.keyframe.as_ref().map(|keyframe| &keyframe.sight);
        sight.into_iter().flat_map(|sight| {
            let places = sight.features.keypoints.iter().zip(&sight.points);
            places.filter_map(|(k, point)| {
                Some(([f64::from(k.x), f64::from(k.y)], point.as_ref()?.z))
            })
        })
    }

    /// Whether coordinates are metres.
    #[must_use]
    pub fn is_metric(&self) -> bool {
        self.is_metric
    }

    /// Makes the first keyframe of an epoch.
    fn begin(&mut self, pose: Isometry3<f64>, frame: &Frame<'_>) -> Tracked {
        let sight = self.front_end.first_sight(frame);
        let mut keyframe = self.front_end.keyframe(sight, pose, frame);
        let points = keyframe.known_points();
        self.is_metric = points > 0;
        self.frame_from_keyframe = Isometry3::identity();
        self.lost = 0;
        self.builder.add(&mut keyframe, frame.time, self.is_metric);
        self.keyframe = Some(keyframe);
        let known = points >= self.config.pnp.min_inliers;
        Tracked {
            state: if known {
                TrackingState::Tracking
            } else {
                TrackingState::NotInitialized
            },
            world_from_camera: known.then_some(pose),
            inliers: points,
            is_keyframe: true,
        }
    }

    /// Gives a keyframe without depth its points, once the frame is far enough away.
    fn initialise(
        &mut self,
        keyframe: &mut Keyframe,
        sight: &Sight,
        matches: &[Match],
        rng: &mut impl Rng,
    ) {
        let (first, second, index) = keyframe.pixel_pairs(sight, matches);
        let camera = &self.front_end.camera.pinhole;
        let found = estimate_two_view(&first, &second, camera, &self.config.two_view, rng);
        let Some(found) = found.ok().filter(TwoView::is_confident) else {
            return;
        };
        let good = |(_, found): &(usize, Triangulated)| found.point.z > 0.0;
        let points: Vec<(usize, Triangulated)> = found
            .inliers
            .iter()
            .zip(&found.points)
            .filter_map(|(&i, point)| {
                let point = point.filter(|point| point.angle >= self.config.least_angle)?;
                Some((matches[index[i]].first, point))
            })
            .filter(good)
            .collect();
        let mut depths: Vec<f64> = points.iter().map(|(_, found)| found.point.z).collect();
        depths.sort_by(f64::total_cmp);
        let Some(&unit) = depths.get(depths.len() / 2) else {
            return;
        };
        for (slot, found) in points {
            keyframe.set_point(slot, found.point / unit, found.angle);
        }
        self.frame_from_keyframe = found.second_from_first;
        self.frame_from_keyframe.translation.vector /= unit;
        self.builder.complete(keyframe);
    }

    fn follow(
        &mut self,
        mut keyframe: Keyframe,
        sight: Sight,
        matches: &[Match],
        frame: &Frame<'_>,
        rng: &mut impl Rng,
    ) -> Tracked {
        let started = keyframe.known_points() > 0;
        let factor = self.config.orb.scale_factor;
        let (observations, index) = keyframe.observations(&sight, matches, factor);
        let camera = &self.front_end.camera.pinhole;
        let pnp = |guess: &Isometry3<f64>| {
            refine_pose(&observations, camera, guess, &self.config.pnp)
                .ok()
                .filter(is_plausible)
        };
        let enough = |pose: &PnpPose| 2 * pose.inliers.len() >= observations.len();
        let found = pnp(&self.frame_from_keyframe).filter(enough).or_else(|| {
            let (first, second, _) = keyframe.pixel_pairs(&sight, matches);
            let motion =
                estimate_two_view(&first, &second, camera, &self.config.two_view, rng).ok()?;
            let mut guess = self.frame_from_keyframe;
            guess.rotation = motion.second_from_first.rotation;
            pnp(&guess)
        });
        let Some(found) = found else {
            // Before the start, waiting for parallax is normal; but not for what is out of sight.
            let waits = !started && matches.len() >= self.config.two_view.min_inliers;
            return self.miss(keyframe, waits, frame);
        };
        self.lost = 0;
        self.frame_from_keyframe = found.camera_from_world;
        let pose = keyframe.world_from_camera * found.camera_from_world.inverse();
        let inliers = found.inliers.len();
        keyframe.most_inliers = keyframe.most_inliers.max(inliers);
        let least_angle = self.config.least_angle;
        if !self.is_metric {
            let pose = &self.frame_from_keyframe;
            keyframe.deepen(&sight, matches, pose, camera, least_angle);
        }
        let is_keyframe = self.wants_keyframe(&keyframe, inliers);
        if is_keyframe {
            self.builder.complete(&mut keyframe);
            let agreeing: Vec<usize> = found.inliers.iter().map(|&i| index[i]).collect();
            let mut next = self.front_end.keyframe(sight, pose, frame);
            keyframe.hand_over(&mut next, matches, &agreeing, camera, least_angle);
            self.frame_from_keyframe = Isometry3::identity();
            self.builder.add(&mut next, frame.time, self.is_metric);
            keyframe = next;
        }
        self.keyframe = Some(keyframe);
        let state = TrackingState::Tracking;
        Tracked {
            state,
            world_from_camera: Some(pose),
            inliers,
            is_keyframe,
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    fn wants_keyframe(&self, keyframe: &Keyframe, inliers: usize) -> bool {
        let share = inliers as f64 / keyframe.most_inliers.max(1) as f64;
        let would_gain = self.is_metric || share < LARGE_SHARE;
        let are_few = inliers < self.config.keyframe_inliers && would_gain;
        share < self.config.keyframe_share || are_few
    }

    /// A frame without a pose.
    fn miss(&mut self, keyframe: Keyframe, waits: bool, frame: &Frame<'_>) -> Tracked {
        self.lost += 1;
        let started = keyframe.known_points() > 0;
        let patience = if waits {
            20 * self.config.patience
        } else {
            self.config.patience
        };
        if self.lost > patience {
            let pose = keyframe.world_from_camera * self.frame_from_keyframe.inverse();
            self.builder.begin_epoch();
            let mut tracked = self.begin(pose, frame);
            tracked.is_keyframe = true;
            return tracked;
        }
        self.keyframe = Some(keyframe);
        let state = if started {
            TrackingState::Lost
        } else {
            TrackingState::NotInitialized
        };
        Tracked {
            state,
            world_from_camera: None,
            inliers: 0,
            is_keyframe: false,
        }
    }
}

/// Without measured depth, a successor of a keyframe of which a frame still shows so much would know hardly more.
const LARGE_SHARE: f64 = 0.85;

/// A pose far outside the room is a failure, whatever its residuals.
fn is_plausible(pose: &PnpPose) -> bool {
    pose.camera_from_world.translation.vector.norm() < 1e3
}

impl SlamSource for Odometry {
    fn poll(&mut self) -> Option<SlamUpdate> {
        self.updates.pop_front()
    }

    fn map(&self) -> Map {
        self.builder.map().clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PinholeCamera;
    use crate::feature::KltConfig;
    use crate::image::{GrayImage, gaussian_blur};
    use crate::odometry::Tracker;
    use rand::SeedableRng;

    /// A wall of blurred dots at z = 2, seen by a camera that moves sideways: an image shifted by whole pixels.
    fn wall(shift: usize) -> GrayImage {
        let mut state = 5_u64;
        let pixels: Vec<u8> = (0..400 * 200)
            .map(|_| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                if state >> 61 == 0 { 230 } else { 30 }
            })
            .collect();
        let rows = (0..200).flat_map(|y| pixels[y * 400 + shift..y * 400 + shift + 300].to_vec());
        let image = GrayImage::new(rows.collect(), 300, 200).unwrap();
        gaussian_blur(&image.view(), 1.2, 3)
    }

    fn odometry() -> Odometry {
        with(Tracker::Orb)
    }

    fn with(tracker: Tracker) -> Odometry {
        let pinhole = PinholeCamera::new(200.0, 200.0, 150.0, 100.0).unwrap();
        let config = OdometryConfig {
            tracker,
            ..OdometryConfig::default()
        };
        Odometry::new(Camera::ideal(pinhole), config).unwrap()
    }

    #[test]
    fn a_sideways_move_with_depth_is_metric() {
        for tracker in [Tracker::Orb, Tracker::Klt(KltConfig::default())] {
            moves_sideways(with(tracker));
        }
    }

    fn moves_sideways(mut odometry: Odometry) {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
        let depth = DepthImage::new(vec![2.0; 300 * 200], 300, 200).unwrap();
        for step in 0..20 {
            let image = wall(3 * step);
            let frame = Frame {
                time: step as f64,
                image: image.view(),
                depth: None,
            };
            let tracked = odometry.track(&frame, Some(&depth), rng);
            let pose = tracked.world_from_camera.unwrap();
            let expected = 3.0 * step as f64 * 2.0 / 200.0;
            assert!(
                (pose.translation.vector.x - expected).abs() < 0.02,
                "{step} {pose}"
            );
        }
        assert!(odometry.is_metric());
        let map = odometry.map();
        assert!(map.points.len() > 200 && map.has_observations());
        let poses =
            core::iter::from_fn(|| odometry.poll()).filter(|u| u.world_from_camera.is_some());
        assert_eq!(poses.count(), 20);
    }

    #[test]
    fn depth_of_another_size_is_as_good_as_none() {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
        let half = DepthImage::new(vec![2.0; 150 * 100], 150, 100).unwrap();
        let image = wall(0);
        let frame = Frame {
            time: 0.0,
            image: image.view(),
            depth: None,
        };
        let with_half = odometry().track(&frame, Some(&half), rng);
        assert_eq!(with_half, odometry().track(&frame, None, rng));
        assert_eq!(with_half.state, TrackingState::NotInitialized);
    }

    #[test]
    fn darkness_is_lost_and_then_a_new_epoch() {
        let mut odometry = odometry();
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
        let depth = DepthImage::new(vec![2.0; 300 * 200], 300, 200).unwrap();
        let (light, dark) = (wall(0), GrayImage::filled(300, 200, 0));
        let mut states = Vec::new();
        for time in 0..12 {
            let image = if (2..9).contains(&time) {
                &dark
            } else {
                &light
            };
            let frame = Frame {
                time: f64::from(time),
                image: image.view(),
                depth: None,
            };
            states.push(odometry.track(&frame, Some(&depth), rng).state);
        }
        assert_eq!(states[1], TrackingState::Tracking);
        assert_eq!(states[4], TrackingState::Lost);
        assert!(odometry.current_map().epoch >= 1);
    }

    #[test]
    fn tiny_images_are_never_tracked() {
        let mut odometry = odometry();
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
        let image = GrayImage::filled(1, 1, 255);
        for time in [0.0, 1.0, f64::NAN] {
            let frame = Frame {
                time,
                image: image.view(),
                depth: None,
            };
            let tracked = odometry.track(&frame, None, rng);
            assert_eq!(tracked.state, TrackingState::NotInitialized);
            assert_eq!(tracked.world_from_camera, None);
        }
    }
}
