//! What was tracked without interruption: poses and map share one frame and, without metric depth, one unit.

use edge_slam::depth::{DepthFit, fit_depth};
use slam_bridge::nalgebra::{Isometry3, Point3, Similarity3};
use slam_bridge::{Map, Scale, TimedPose};

/// One epoch of the odometry.
#[derive(Debug, Clone, Default)]
pub(crate) struct Epoch {
    pub(crate) poses: Vec<TimedPose>,
    /// Takes poses and map to the filter's world, in metres; none without telemetry.
    pub(crate) placed: Option<Similarity3<f64>>,
    pub(crate) keyframes: usize,
    pub(crate) map: Map,
    /// Edge points in the frame of their keyframe's camera, with its pose.
    pub(crate) edges: Vec<(Isometry3<f64>, Vec<Point3<f64>>)>,
    /// Depths that a network predicted, and those that the map has in the same places.
    pub(crate) predicted: Vec<f64>,
    pub(crate) triangulated: Vec<f64>,
}

/// Edge points nearer to each other than this share of the median depth are one.
const GRAIN: f64 = 0.01;

impl Epoch {
    /// How the network's depth fits the triangulated one; none without a network or with too few points.
    pub(crate) fn fit(&self) -> Option<DepthFit> {
        fit_depth(&self.predicted, &self.triangulated).ok()
    }

    /// Moves everything into a world whose unit is the metre. What edges look like from their cameras stays: sensor
    /// and network give metres.
    pub(crate) fn place(&mut self, world: &Similarity3<f64>) {
        let poses = self.poses.iter_mut().map(|pose| &mut pose.pose);
        let seen = self.edges.iter_mut().map(|(pose, _)| pose);
        for pose in poses.chain(seen) {
            let centre = world * Point3::from(pose.translation.vector);
            pose.rotation = world.isometry.rotation * pose.rotation;
            pose.translation = centre.coords.into();
        }
        self.map.transform(world);
        self.map.scale = Scale::MetersPerUnit(1.0);
    }

    /// All edge points in the world's frame, thinned to one a cell.
    pub(crate) fn edge_points(&self) -> Vec<[f64; 3]> {
        let mut depths: Vec<f64> = self
            .edges
            .iter()
            .flat_map(|(_, p)| p)
            .map(|p| p.z)
            .collect();
        depths.sort_by(f64::total_cmp);
        let Some(median) = depths.get(depths.len() / 2) else {
            return Vec::new();
        };
        let cell = GRAIN * median;
        let mut taken = std::collections::BTreeSet::new();
        let points = self.edges.iter();
        let points = points.flat_map(|(pose, points)| points.iter().map(move |p| pose * p));
        points
            .filter(|point| {
                taken.insert([point.x, point.y, point.z].map(|x| (x / cell).floor() as i64))
            })
            .map(Into::into)
            .collect()
    }
}
