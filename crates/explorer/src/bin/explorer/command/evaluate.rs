//! `explorer evaluate`: how far a trajectory, and a map, are from the true ones.

mod map_error;
mod surface;

use std::ops::Range;
use std::path::Path;

use edge_slam::evaluation::{
    AbsolutePoseError, AlignBy, Alignment, ApeConfig, ErrorStatistics, EvaluationError, RpeConfig,
    RpeInterval, TimedPose, absolute_pose_error, relative_pose_error,
};
use edge_slam::sequence::read_at_most;
use serde::Serialize;
use slam_bridge::read_tum;

use crate::args::{AlignByChoice, AlignChoice, Evaluate, Output};
use crate::failure::Failure;
use crate::output::deliver;
use crate::plot::{AxisPair, Figure, Layer, Shape, Track, color, trajectory};
use map_error::{MapError, MapReport};

/// The command's JSON object: the translation part of the absolute pose error, then everything else.
#[derive(Debug, Clone, Serialize)]
struct EvaluateReport {
    #[serde(flatten)]
    translation: Summary,
    /// Poses compared.
    pairs: usize,
    /// What the estimate's lengths were multiplied by.
    scale: f64,
    /// sim3, se3 or none.
    align: &'static str,
    /// What fixed the rotation of that: positions, poses or nothing.
    align_by: &'static str,
    /// Poses in the estimate's file, and in the reference's.
    poses: [usize; 2],
    /// Absolute rotation error, degrees.
    rotation_deg: Summary,
    /// ‖E − I‖ over 4x4 matrices, which mixes metres and rotation; only for comparison.
    frobenius: Summary,
    /// Drift from one compared pose to the next (evo's default), and over a second.
    rpe_frame: Option<Drift>,
    rpe_second: Option<Drift>,
    /// With --map.
    map: Option<MapReport>,
}

/// Statistics as evo names them.
#[derive(Debug, Clone, Copy, Serialize)]
struct Summary {
    rmse: f64,
    mean: f64,
    median: f64,
    std: f64,
    min: f64,
    max: f64,
}

impl Summary {
    fn of(errors: &ErrorStatistics, unit: f64) -> Self {
        let ErrorStatistics {
            rmse,
            mean,
            median,
            std,
            min,
            max,
        } = *errors;
        let [rmse, mean, median, std, min, max] =
            [rmse, mean, median, std, min, max].map(|value| value * unit);
        Self {
            rmse,
            mean,
            median,
            std,
            min,
            max,
        }
    }
}

/// Relative pose error over an interval.
#[derive(Debug, Clone, Copy, Serialize)]
struct Drift {
    translation: Summary,
    rotation_deg: Summary,
    pairs: usize,
}

pub(crate) fn run(arguments: &Evaluate, output: &Output) -> Result<(), Failure> {
    let estimate = read(&arguments.estimate)?;
    let reference = read(&arguments.reference)?;
    let config = ApeConfig {
        alignment: match arguments.align {
            AlignChoice::Sim3 => Alignment::Sim3,
            AlignChoice::Se3 => Alignment::Se3,
            AlignChoice::None => Alignment::None,
        },
        align_by: by(arguments, AlignBy::Positions),
        max_difference: arguments.max_difference,
    };
    let error = |config| absolute_pose_error(&estimate, &reference, &config).map_err(failure);
    let ape = error(config)?;
    let map = match arguments.map {
        Some(_) => {
            let align_by = by(arguments, AlignBy::Poses);
            let aligned = error(ApeConfig { align_by, ..config })?;
            let map = MapError::measure(arguments, &aligned, align_by, &reference)?;
            map.map(|map| (map, aligned))
        }
        None => None,
    };
    let drift = |interval| drift(&estimate, &reference, interval, &config, &ape);
    let report = EvaluateReport {
        translation: Summary::of(&ape.translation, 1.0),
        pairs: ape.pairs.len(),
        scale: ape.alignment.scale,
        align: match arguments.align {
            AlignChoice::Sim3 => "sim3",
            AlignChoice::Se3 => "se3",
            AlignChoice::None => "none",
        },
        align_by: name(arguments, config.align_by),
        poses: [estimate.len(), reference.len()],
        rotation_deg: Summary::of(&ape.rotation, 1_f64.to_degrees()),
        frobenius: Summary::of(&ape.frobenius, 1.0),
        rpe_frame: drift(RpeInterval::Frames(1)),
        rpe_second: drift(RpeInterval::Seconds(1.0)),
        map: map.as_ref().map(|(map, _)| map.report.clone()),
    };
    let tracks = |ape| tracks(ape, &estimate, &reference);
    deliver(output, &report, &text(&report), || {
        Ok(match &map {
            Some((map, aligned)) => map.figure(&tracks(aligned)),
            None => figure(&report, &ape, &tracks(&ape)),
        })
    })
}

/// What was asked for, else what is usual for the purpose.
fn by(arguments: &Evaluate, usual: AlignBy) -> AlignBy {
    match arguments.align_by {
        Some(AlignByChoice::Positions) => AlignBy::Positions,
        Some(AlignByChoice::Poses) => AlignBy::Poses,
        None => usual,
    }
}

/// What fixes the rotation.
fn name(arguments: &Evaluate, by: AlignBy) -> &'static str {
    match (&arguments.align, by) {
        (AlignChoice::None, _) => "nothing",
        (_, AlignBy::Positions) => "positions",
        (_, AlignBy::Poses) => "poses",
    }
}

/// The alignment in words.
fn alignment(report: &EvaluateReport) -> String {
    match report.align {
        "none" => "not aligned".to_owned(),
        kind => format!(
            "{kind} alignment by {}, scale {:.6}",
            report.align_by, report.scale
        ),
    }
}

/// A day at 30 poses a second.
const MOST_TRAJECTORY_BYTES: u64 = 1 << 28;

fn read(path: &Path) -> Result<Vec<TimedPose>, Failure> {
    let named = |error: &dyn core::fmt::Display| format!("{}: {error}", path.display());
    let bytes = read_at_most(path, MOST_TRAJECTORY_BYTES);
    let bytes = bytes.map_err(|error| Failure::new(named(&error), "check the path"))?;
    let poses = read_tum(bytes.as_slice()).map_err(|error| {
        let advice = "a trajectory has lines of 'time tx ty tz qx qy qz qw'";
        Failure::new(named(&error), advice)
    })?;
    if poses.is_empty() {
        let advice = "record or export the trajectory again";
        return Err(Failure::new(named(&"there is no pose in it"), advice));
    }
    Ok(poses)
}

/// An error's own text says what to do; where it does not, this does.
fn failure(error: EvaluationError) -> Failure {
    let advice = match error {
        EvaluationError::TooFewPairs { .. } => {
            "--max-difference allows stamps that are farther apart"
        }
        EvaluationError::Degenerate { .. } => {
            "use --align-by poses, --align none, or a trajectory with a bend"
        }
        EvaluationError::Scale { .. } => "use --align-by positions",
        _ => "correct the trajectories",
    };
    Failure::new(error, advice)
}

/// None when the trajectories are too short for the interval.
fn drift(
    estimate: &[TimedPose],
    reference: &[TimedPose],
    interval: RpeInterval,
    ape: &ApeConfig,
    aligned: &AbsolutePoseError,
) -> Option<Drift> {
    let config = RpeConfig {
        interval,
        all_pairs: matches!(interval, RpeInterval::Seconds(_)),
        max_difference: ape.max_difference,
        scale: aligned.alignment.scale,
    };
    let rpe = relative_pose_error(estimate, reference, &config).ok()?;
    Some(Drift {
        translation: Summary::of(&rpe.translation, 1.0),
        rotation_deg: Summary::of(&rpe.rotation, 1_f64.to_degrees()),
        pairs: rpe.pairs,
    })
}

fn text(report: &EvaluateReport) -> String {
    let error = &report.translation;
    let mut text = format!(
        "ATE rmse {:.6} m over {} pairs ({})\n\
         mean {:.6}, median {:.6}, std {:.6}, min {:.6}, max {:.6} m; rotation rmse {:.3} degrees",
        error.rmse,
        report.pairs,
        alignment(report),
        error.mean,
        error.median,
        error.std,
        error.min,
        error.max,
        report.rotation_deg.rmse,
    );
    for (name, drift) in [("frame", &report.rpe_frame), ("second", &report.rpe_second)] {
        if let Some(drift) = drift {
            text.push_str(&format!(
                "\nRPE rmse {:.6} m and {:.3} degrees a {name} ({} pairs)",
                drift.translation.rmse, drift.rotation_deg.rmse, drift.pairs
            ));
        }
    }
    if let Some(map) = &report.map {
        text.push('\n');
        text.push_str(&map.text());
    }
    text
}

fn place(pose: &TimedPose) -> [f64; 3] {
    pose.pose.translation.vector.into()
}

/// The poses of the reference from the first compared one to the last: nobody estimated the others, and drawn they would look missed.
fn compared(ape: &AbsolutePoseError) -> Range<usize> {
    let places = || ape.pairs.iter().map(|&(_, j)| j);
    places().min().unwrap_or(0)..places().max().map_or(0, |last| last + 1)
}

/// Both trajectories in the frame of the true one.
fn tracks(ape: &AbsolutePoseError, estimate: &[TimedPose], reference: &[TimedPose]) -> [Track; 2] {
    let moved = |pose: &TimedPose| ape.alignment.apply(&place(pose).into()).into();
    let truth = reference.get(compared(ape)).unwrap_or(reference);
    let label = match truth.len() == reference.len() {
        true => format!("reference ({})", reference.len()),
        false => format!("reference ({} of {})", truth.len(), reference.len()),
    };
    [
        Track {
            label,
            color: color::WALL,
            dashed: true,
            through: truth.iter().map(place).collect(),
        },
        Track {
            label: format!("estimate ({})", estimate.len()),
            color: color::PATH,
            dashed: false,
            through: estimate.iter().map(moved).collect(),
        },
    ]
}

/// Both trajectories, and a stroke from each compared pose to where it should be.
fn figure(report: &EvaluateReport, ape: &AbsolutePoseError, tracks: &[Track; 2]) -> Figure {
    let [truth, found] = tracks;
    let axes = AxisPair::widest(tracks.iter().flat_map(|track| &track.through));
    let first = compared(ape).start;
    let stroke = |&(i, j): &(usize, usize)| {
        let (from, to) = (found.through.get(i)?, truth.through.get(j - first)?);
        Some([axes.project(from), axes.project(to)])
    };
    let ends = ape.pairs.iter().filter_map(stroke).collect();
    let title = "Estimated and true trajectory";
    let subtitle = format!(
        "ATE rmse {:.4} m, {} pairs, {}",
        report.translation.rmse,
        report.pairs,
        alignment(report)
    );
    let mut figure = trajectory::figure(title, &subtitle, "m", axes, tracks);
    let errors = Layer::new(
        "error",
        color::REMOVED,
        Shape::Segments { ends, width: 1.0 },
    );
    figure.layers.insert(1, errors.opacity(0.6));
    figure
}
