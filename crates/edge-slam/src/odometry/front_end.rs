//! Which features of the keyframe a frame shows, and where: by matching descriptors or by following patches.
//!
//! KLT compares every frame with the keyframe's own patches, beginning where they were seen last, so that places do not
//! drift from frame to frame; a patch that turned or grew too much is lost. New features are sought only for keyframes.

use nalgebra::Isometry3;

use super::keyframe::Keyframe;
use super::sight::Sight;
use super::{OdometryConfig, OdometryError, Tracker};
use crate::Frame;
use crate::camera::Camera;
use crate::feature::{
    AlignConfig, Features, KltConfig, Match, OrbExtractor, align_matches, klt_pyramid,
    match_descriptors, track_points,
};
use crate::image::GrayImage;

/// Finds features, and finds them again.
#[derive(Debug, Clone)]
pub(super) struct FrontEnd {
    pub(super) camera: Camera,
    extractor: OrbExtractor,
    config: OdometryConfig,
}

/// A new feature this near to one that is followed already would be the same, pixels.
const SAME: f32 = 8.0;

impl FrontEnd {
    pub(super) fn new(camera: Camera, config: &OdometryConfig) -> Result<Self, OdometryError> {
        Ok(Self {
            camera,
            extractor: OrbExtractor::new(config.orb)?,
            config: *config,
        })
    }

    /// A frame that nothing is known of yet.
    pub(super) fn first_sight(&self, frame: &Frame<'_>) -> Sight {
        self.sight(frame, self.extractor.extract(&frame.image))
    }

    /// What the frame shows of the keyframe. By KLT nothing else.
    pub(super) fn follow(&self, keyframe: &mut Keyframe, frame: &Frame<'_>) -> (Sight, Vec<Match>) {
        match self.config.tracker {
            Tracker::Orb => {
                let mut features = self.extractor.extract(&frame.image);
                let before = &keyframe.sight.features.descriptors;
                let matches =
                    match_descriptors(before, &features.descriptors, &self.config.matching);
                self.align(keyframe, frame, &matches, &mut features);
                (self.sight(frame, features), matches)
            }
            Tracker::Klt(config) => self.trace(keyframe, frame, &config),
        }
    }

    /// The frame as a keyframe.
    pub(super) fn keyframe(
        &self,
        mut sight: Sight,
        pose: Isometry3<f64>,
        frame: &Frame<'_>,
    ) -> Keyframe {
        let Tracker::Klt(_) = self.config.tracker else {
            let mut keyframe = Keyframe::new(sight, pose);
            keyframe.image = self.config.align.map(|_| GrayImage::from(frame.image));
            return keyframe;
        };
        if sight.features.keypoints.len() < self.config.orb.features {
            self.fill(&mut sight, frame);
        }
        let mut keyframe = Keyframe::new(sight, pose);
        keyframe.pyramid = Some(klt_pyramid(&frame.image));
        keyframe.seen_at = places(&keyframe.sight.features);
        keyframe
    }

    /// Moves the features of the frame to where they show the same as those of the keyframe. Their pyramid level stays what it was, and with
    /// it how far their places are trusted: what a large patch shows changes more between views.
    fn align(
        &self,
        keyframe: &Keyframe,
        frame: &Frame<'_>,
        matches: &[Match],
        features: &mut Features,
    ) {
        let (Some(config), Some(image)) = (&self.config.align, &keyframe.image) else {
            return;
        };
        let config = AlignConfig {
            scale_factor: self.config.orb.scale_factor,
            ..*config
        };
        let images = [&image.view(), &frame.image];
        let keypoints = [&keyframe.sight.features.keypoints, &features.keypoints];
        let found = align_matches(images, keypoints.map(Vec::as_slice), matches, &config);
        for (Match { second, .. }, place) in matches.iter().zip(found) {
            let keypoint = &mut features.keypoints[*second];
            #[expect(clippy::cast_possible_truncation, reason = "pixels")]
            let [x, y] = place.second.map(|pixel| pixel as f32);
            (keypoint.x, keypoint.y) = (x, y);
        }
    }

    fn sight(&self, frame: &Frame<'_>, features: Features) -> Sight {
        Sight::new(features, frame.depth, &self.camera, self.config.farthest)
    }

    fn trace(
        &self,
        keyframe: &mut Keyframe,
        frame: &Frame<'_>,
        config: &KltConfig,
    ) -> (Sight, Vec<Match>) {
        let Some(pyramid) = &keyframe.pyramid else {
            return (self.sight(frame, Features::default()), Vec::new());
        };
        let old = &keyframe.sight.features;
        let now = klt_pyramid(&frame.image);
        let found = track_points(pyramid, &now, &places(old), &keyframe.seen_at, config);
        let (mut features, mut matches) = (Features::default(), Vec::new());
        for (first, place) in found.iter().enumerate() {
            let Some([x, y]) = *place else { continue };
            keyframe.seen_at[first] = [x, y];
            let mut keypoint = old.keypoints[first];
            #[expect(clippy::cast_possible_truncation, reason = "pixels")]
            let place = (x as f32, y as f32);
            (keypoint.x, keypoint.y) = place;
            // The patch is found to less than a pixel, whatever the level on which the corner was.
            keypoint.octave = 0;
            matches.push(Match {
                first,
                second: features.keypoints.len(),
                distance: 0,
            });
            features.keypoints.push(keypoint);
            features.descriptors.push(old.descriptors[first]);
        }
        (self.sight(frame, features), matches)
    }

    /// Adds features where none is followed, behind those that are.
    fn fill(&self, sight: &mut Sight, frame: &Frame<'_>) {
        let fresh = self.extractor.extract(&frame.image);
        let taken = sight.features.keypoints.clone();
        let free = |x: f32, y: f32| {
            taken
                .iter()
                .all(|k| (k.x - x).abs().max((k.y - y).abs()) > SAME)
        };
        let mut room = self.config.orb.features - taken.len();
        let mut new = Features::default();
        for (keypoint, descriptor) in fresh.keypoints.iter().zip(&fresh.descriptors) {
            if room > 0 && free(keypoint.x, keypoint.y) {
                room -= 1;
                new.keypoints.push(*keypoint);
                new.descriptors.push(*descriptor);
            }
        }
        sight.append(self.sight(frame, new));
    }
}

fn places(features: &Features) -> Vec<[f64; 2]> {
    let place = |k: &crate::feature::Keypoint| [f64::from(k.x), f64::from(k.y)];
    features.keypoints.iter().map(place).collect()
}
