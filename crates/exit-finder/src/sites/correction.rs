//! Map corrections: sites and portals move with the keyframes they hang on.

use super::anchor::{Anchor, KeyframePose};
use super::error::SiteError;
use super::graph::SiteGraph;
use crate::plane::AffinePlane;
use crate::vector::{add, sub};

impl SiteGraph {
    /// Moves everything with its keyframe after a correction of the map; returns how many sites and
    /// portals stayed where they were because their keyframe is gone. SLAM systems cull keyframes all
    /// the time: those sites and portals hang on the keyframe nearest to them from then on. Cheap
    /// enough to call with every new map: O((sites + portals) · keyframes).
    ///
    /// # Errors
    /// [`SiteError::Pose`]; nothing has moved then.
    pub fn reanchor(&mut self, keyframes: &[KeyframePose]) -> Result<usize, SiteError> {
        check_poses(keyframes)?;
        let resolve = |anchors: &[Anchor; 3]| {
            let [a, b, c] = anchors.map(|anchor| anchor.resolve(keyframes));
            Some([a?, b?, c?])
        };
        let mut lost = 0;
        for site in &mut self.sites {
            match resolve(&site.anchors) {
                Some([position, first, second]) => {
                    let axes = [sub(first, position), sub(second, position)];
                    site.position = position;
                    // A rigid motion keeps the axes orthonormal up to rounding.
                    site.plane = AffinePlane::from_basis(position, axes).unwrap_or(site.plane);
                }
                None => {
                    lost += 1;
                    rehang(
                        &mut site.anchors,
                        site_marks(site.position, &site.plane),
                        keyframes,
                    );
                }
            }
        }
        for portal in &mut self.portals {
            match resolve(&portal.anchors) {
                Some([a, b, exit]) => (portal.jambs, portal.exit) = ([a, b], exit),
                None => {
                    lost += 1;
                    let [a, b] = portal.jambs;
                    rehang(&mut portal.anchors, [a, b, portal.exit], keyframes);
                }
            }
        }
        Ok(lost)
    }
}

/// The points that carry a site's pose: its position, and the ends of the plane's axes from there.
pub(super) fn site_marks(position: [f64; 3], plane: &AffinePlane) -> [[f64; 3]; 3] {
    let [first, second] = plane.axes().map(|axis| add(position, axis));
    [position, first, second]
}

/// Hangs points on one keyframe, the nearest to the first of them, so that they move rigidly.
pub(super) fn hang(marks: [[f64; 3]; 3], keyframes: &[KeyframePose]) -> [Anchor; 3] {
    let nearest: Vec<KeyframePose> = Anchor::new(marks[0], keyframes)
        .keyframe
        .and_then(|id| keyframes.iter().find(|pose| pose.id == id).copied())
        .into_iter()
        .collect();
    marks.map(|mark| Anchor::new(mark, &nearest))
}

/// Without any keyframe the old anchors stay: theirs may come back.
fn rehang(anchors: &mut [Anchor; 3], marks: [[f64; 3]; 3], keyframes: &[KeyframePose]) {
    if !keyframes.is_empty() {
        *anchors = hang(marks, keyframes);
    }
}

pub(super) fn check_poses(keyframes: &[KeyframePose]) -> Result<(), SiteError> {
    match keyframes.iter().find(|pose| !pose.is_rigid()) {
        Some(pose) => Err(SiteError::Pose { keyframe: pose.id }),
        None => Ok(()),
    }
}
