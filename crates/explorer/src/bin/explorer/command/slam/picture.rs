//! The trajectory as it is drawn: what was tracked, what telemetry alone says, and what nobody saw.

use slam_bridge::TimedPose;

use super::Found;
use crate::plot::{AxisPair, Figure, Layer, Shape, color, trajectory};

/// A step between two poses that follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// Both ends are tracked.
    Tracked,
    /// An end is by telemetry alone.
    Reckoned,
    /// Frames between them have no pose.
    Gap,
}

/// The kind of each step of `poses`; `times` are those of all frames, in order, `reckoned` says which poses are by telemetry alone.
fn steps(times: &[f64], poses: &[TimedPose], reckoned: &[bool]) -> Vec<Step> {
    let mut frames = times.iter().enumerate();
    let mut places = Vec::with_capacity(poses.len());
    for pose in poses {
        let same = |(_, time): &(usize, &f64)| time.total_cmp(&pose.time).is_eq();
        places.push(frames.find(same).map(|(index, _)| index));
    }
    let is_reckoned = |k: usize| reckoned.get(k).copied().unwrap_or(false);
    let step = |k: usize| match (places[k], places[k + 1]) {
        (Some(a), Some(b)) if b > a + 1 => Step::Gap,
        _ if is_reckoned(k) || is_reckoned(k + 1) => Step::Reckoned,
        _ => Step::Tracked,
    };
    (0..poses.len().saturating_sub(1)).map(step).collect()
}

impl Found {
    /// Title, and what the line under it says of epochs, when there are several.
    fn epochs_text(&self) -> (String, String) {
        let [number, count] = self.shown_epoch;
        let others = self.tracked_in_all_epochs - self.tracked;
        let title = "Trajectory and map";
        match (count, others) {
            (0 | 1, _) => (title.to_owned(), String::new()),
            (_, 0) => (
                format!("{title}, points of epoch {number} of {count}"),
                String::new(),
            ),
            _ => (
                format!("{title} of epoch {number} of {count}, the longest"),
                format!("; {others} poses of the others, in other units, not shown"),
            ),
        }
    }

    /// The camera's way and the map; `headline` first in the line under the title.
    pub(super) fn map_figure(&self, headline: &str) -> Figure {
        // The camera's first frame: x to the right, z ahead, seen from above.
        let axes = AxisPair::FROM_ABOVE;
        let (title, others) = self.epochs_text();
        let subtitle = format!("{headline}{others}");
        let mut figure = trajectory::figure(&title, &subtitle, self.unit(), axes, &[]);
        let dots = |label: &str, points: &[[f64; 3]], tint, radius| {
            let at = points.iter().map(|point| axes.project(point)).collect();
            let label = format!("{label} ({})", points.len());
            Layer::new(label, tint, Shape::Dots { at, radius })
                .opacity(0.5)
                .may_leave_frame()
        };
        let sparse = self.epoch.map.positions();
        figure.layers = vec![
            dots("edge points", &self.edges, color::FREE, 0.6),
            dots("map points", &sparse, color::POINT, 1.1),
        ];
        figure.layers.extend(self.way(axes));
        figure
    }

    /// The steps by kind, and marks at both ends.
    fn way(&self, axes: AxisPair) -> Vec<Layer> {
        let at: Vec<[f64; 2]> = self
            .poses
            .iter()
            .map(|pose| axes.project(&pose.pose.translation.vector.into()))
            .collect();
        let steps = steps(&self.times, &self.poses, &self.reckoned);
        let of = |kind: Step, label: String, tint, width| {
            let ends = (0..steps.len()).filter(|&k| steps[k] == kind);
            let ends = ends.map(|k| [at[k], at[k + 1]]).collect();
            Layer::new(label, tint, Shape::Segments { ends, width })
        };
        let gaps = steps.iter().filter(|&&step| step == Step::Gap).count();
        let alone = self.reckoned.iter().filter(|&&alone| alone).count();
        let seen = self.poses.len() - alone;
        let mark = |point: Option<&[f64; 2]>| point.copied().into_iter().collect::<Vec<_>>();
        vec![
            of(
                Step::Gap,
                format!("no pose between: joined straight ({gaps})"),
                color::WALL,
                1.0,
            ),
            of(
                Step::Reckoned,
                format!("by telemetry alone ({alone} poses)"),
                color::RAW_PATH,
                2.4,
            ),
            of(
                Step::Tracked,
                format!("camera, tracked ({seen} poses)"),
                color::PATH,
                2.4,
            ),
            Layer::new(
                "start",
                color::SPOKE,
                Shape::Dots {
                    at: mark(at.first()),
                    radius: 5.0,
                },
            ),
            Layer::new(
                "end",
                color::AGENT,
                Shape::Crosses {
                    at: mark(at.last()),
                    arm: 5.0,
                    width: 2.4,
                },
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slam_bridge::nalgebra::Isometry3;

    fn poses(times: &[f64]) -> Vec<TimedPose> {
        let pose = |&time: &f64| TimedPose {
            time,
            pose: Isometry3::identity(),
        };
        times.iter().map(pose).collect()
    }

    #[test]
    fn gaps_and_telemetry_are_told_from_tracking() {
        use Step::{Gap, Reckoned, Tracked};
        let times = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
        let seen = poses(&[0.0, 0.1, 0.3, 0.4, 0.5, 0.6]);
        let reckoned = [false, false, false, true, false, false];
        let found = steps(&times, &seen, &reckoned);
        assert_eq!(found, [Tracked, Gap, Reckoned, Reckoned, Tracked]);
        assert_eq!(steps(&times, &seen[..3], &[]), [Tracked, Gap]);
        assert!(steps(&times, &[], &[]).is_empty() && steps(&[], &seen[..1], &[]).is_empty());
    }
}
