//! `explorer slam`: a recorded sequence to a trajectory, a map and pictures.

mod picture;

use std::fs;
use std::path::Path;

use edge_slam::sequence::ImageSequence;
use serde::Serialize;
use slam_bridge::nalgebra::Similarity3;
use slam_bridge::{Map, Scale, TimedPose, write_map_folder, write_ply, write_tum};

use crate::args::{Output, Slam};
use crate::failure::Failure;
use crate::output::{deliver, write_file};
use crate::plot;
use crate::progress::Progress;
use crate::stopwatch::percentile;
use crate::tracking::{self, DepthReport, Depths, Epoch, FrameName, FusionReport, Tracking};

/// The command's JSON object.
#[derive(Debug, Serialize)]
struct SlamReport {
    /// Frames read.
    frames: usize,
    /// Frames that the camera tracked, of those in trajectory.txt.
    tracked: usize,
    /// Poses in trajectory.txt: with telemetry also of frames that were not tracked.
    poses: usize,
    /// Poses of all epochs: without metric depth only the longest epoch is written, for each has its own unit.
    tracked_in_all_epochs: usize,
    keyframes: usize,
    ms_median: f64,
    ms_p95: f64,
    epochs: usize,
    /// Whether the unit is the metre.
    metric: bool,
    points: usize,
    edge_points: usize,
    depth: DepthReport,
    /// The filter, and what it was given.
    fusion: FusionReport,
    /// What was written into the folder.
    files: Vec<String>,
}

pub(crate) fn run(arguments: &Slam, output: &Output) -> Result<(), Failure> {
    let progress = Progress::begin("opening the sequence");
    let sequence = ImageSequence::open(&arguments.sequence).map_err(tracking::unreadable)?;
    if sequence.is_empty() {
        let reason = format!("{} lists no frame", arguments.sequence.display());
        return Err(Failure::new(reason, "give a sequence with images"));
    }
    let camera = tracking::camera_of(arguments, &sequence)?;
    let mut depths = Depths::open(arguments.depth.as_ref(), &sequence)?;
    let sequence = if depths.is_metric() {
        sequence
    } else {
        sequence.without_depth()
    };
    let folder = arguments.output.as_path();
    fs::create_dir_all(folder).map_err(|error| Failure::write(folder, &error))?;
    let result = tracking::track(
        arguments,
        &sequence,
        camera,
        &mut depths,
        output.seed,
        &progress,
    )?;
    progress.step("writing the map and the pictures");
    let found = Found::new(&result, &depths)?;
    let mut files = found.write(folder)?;
    files.extend(found.pictures(folder, &sequence, result.frames, &mut depths)?);
    drop(progress);
    let report = found.report(&result, &depths, files);
    deliver(output, &report, &text(&report, folder), || {
        Ok(found.map_figure(&headline(&report)))
    })
}

/// What is written: poses in one frame and unit, and the map of the longest epoch.
struct Found {
    poses: Vec<TimedPose>,
    /// Which of them are by telemetry alone; empty without telemetry.
    reckoned: Vec<bool>,
    /// Times of all frames.
    times: Vec<f64>,
    /// Number of the longest epoch, counted from 1, and how many there are.
    shown_epoch: [usize; 2],
    tracked_in_all_epochs: usize,
    epoch: Epoch,
    edges: Vec<[f64; 3]>,
    fit: Option<edge_slam::depth::DepthFit>,
    metric: bool,
    tracked: usize,
    fusion: FusionReport,
}

impl Found {
    fn new(result: &Tracking, depths: &Depths) -> Result<Self, Failure> {
        let numbered = result.epochs.iter().enumerate().rev();
        let longest = numbered.max_by_key(|(_, epoch)| epoch.poses.len());
        let (number, mut epoch) = longest.map_or_else(Default::default, |(k, e)| (k, e.clone()));
        if epoch.poses.is_empty() {
            let advice = if depths.is_metric() {
                "give frames with more texture and depth"
            } else {
                "a monocular start needs sideways motion; give more frames, or depth"
            };
            return Err(Failure::new("no frame could be tracked", advice));
        }
        let fit = epoch.fit();
        let scale = depths.report(fit.as_ref()).meters_per_unit;
        let mut fusion = result.fusion.clone();
        let placed = epoch.placed;
        if let Some(world) = placed.or_else(|| scale.map(Similarity3::from_scaling)) {
            epoch.place(&world);
        }
        if scale.is_none() && !result.is_metric {
            // A network that failed its test says nothing about where edges are.
            epoch.edges.clear();
        }
        fusion.meters_per_unit = placed.map(|world| world.scaling());
        let all = result.epochs.iter().map(|e| e.poses.len()).sum();
        let (poses, reckoned, tracked) = match (placed, result.is_metric) {
            (Some(_), _) => (result.fused.clone(), result.reckoned.clone(), all),
            (None, true) => {
                let poses = result.epochs.iter().flat_map(|e| e.poses.clone());
                (poses.collect(), Vec::new(), all)
            }
            (None, false) => (epoch.poses.clone(), Vec::new(), epoch.poses.len()),
        };
        Ok(Self {
            poses,
            reckoned,
            times: result.times.clone(),
            shown_epoch: [number + 1, result.epochs.len()],
            tracked_in_all_epochs: all,
            edges: epoch.edge_points(),
            epoch,
            fit,
            metric: result.is_metric || scale.is_some() || placed.is_some(),
            tracked,
            fusion,
        })
    }

    fn write(&self, folder: &Path) -> Result<Vec<String>, Failure> {
        write_file(&folder.join("trajectory.txt"), |file| {
            write_tum(&self.poses, file)
        })?;
        write_map_folder(&self.epoch.map, folder)
            .map_err(|error| Failure::new(error, "check that the folder can be written to"))?;
        let scale = if self.metric {
            Scale::MetersPerUnit(1.0)
        } else {
            Scale::Unknown
        };
        let edges = Map {
            scale,
            ..Map::from_positions(self.edges.iter().copied())
        };
        let mut files = vec![
            "trajectory.txt",
            "map.ply",
            "keyframes.csv",
            "observations.csv.gz",
        ];
        if !self.edges.is_empty() {
            write_file(&folder.join("edges.ply"), |file| write_ply(&edges, file))?;
            files.push("edges.ply");
        } else {
            tracking::remove_old(&folder.join("edges.ply"))?;
        }
        let headline = format!("{} poses, from above the first camera", self.poses.len());
        plot::save(&self.map_figure(&headline), &folder.join("trajectory.png"))?;
        files.push("trajectory.png");
        Ok(files.into_iter().map(str::to_owned).collect())
    }

    /// The middle frame, with its depth where that can be relied on.
    fn pictures(
        &self,
        folder: &Path,
        sequence: &ImageSequence,
        frames: usize,
        depths: &mut Depths,
    ) -> Result<Vec<String>, Failure> {
        let index = frames / 2;
        let Some(loaded) = sequence.load(index).map_err(tracking::unreadable)? else {
            return Ok(Vec::new());
        };
        let name = FrameName {
            index,
            count: sequence.len(),
            time: loaded.time,
        };
        let depth = depths.depth_if_used(&loaded.frame(), self.fit.as_ref())?;
        let names = tracking::draw_frame(folder, &loaded.image.view(), depth.as_ref(), &name)?;
        Ok(names.into_iter().map(str::to_owned).collect())
    }

    fn report(&self, result: &Tracking, depths: &Depths, files: Vec<String>) -> SlamReport {
        let all = |count: fn(&Epoch) -> usize| result.epochs.iter().map(count).sum();
        let at = |share| percentile(result.milliseconds.clone(), share).unwrap_or(0.0);
        SlamReport {
            frames: result.frames,
            tracked: self.tracked,
            poses: self.poses.len(),
            tracked_in_all_epochs: self.tracked_in_all_epochs,
            keyframes: all(|epoch| epoch.keyframes),
            ms_median: at(0.5),
            ms_p95: at(0.95),
            epochs: result.epochs.len(),
            metric: self.metric,
            points: self.epoch.map.points.len(),
            edge_points: self.edges.len(),
            depth: depths.report(self.fit.as_ref()),
            fusion: self.fusion.clone(),
            files,
        }
    }

    fn unit(&self) -> &'static str {
        if self.metric { "m" } else { "map units" }
    }
}

fn headline(report: &SlamReport) -> String {
    format!(
        "{} of {} frames tracked, {} keyframes, {} points, {} edge points",
        report.tracked, report.frames, report.keyframes, report.points, report.edge_points
    )
}

fn text(report: &SlamReport, folder: &Path) -> String {
    let mut text = format!(
        "{}\n{:.1} ms a frame (median), {:.1} ms (95 %)",
        headline(report),
        report.ms_median,
        report.ms_p95
    );
    if report.epochs > 1 {
        let more = report.tracked_in_all_epochs - report.tracked;
        text.push_str(&format!("\ntracking broke off {} times", report.epochs - 1));
        if more > 0 {
            text.push_str(&format!(
                "; {more} poses of other epochs have another unit and are left out"
            ));
        }
    }
    match (&report.depth.correlation, report.depth.meters_per_unit) {
        (Some(correlation), None) => text.push_str(&format!(
            "\nthe network's depth correlates by {correlation:.2} with {} triangulated points: not used",
            report.depth.pairs
        )),
        (Some(correlation), Some(meters)) => text.push_str(&format!(
            "\nscale from the network: {meters:.3} m a unit, correlation {correlation:.2}"
        )),
        (None, _) if !report.metric => text.push_str("\nno metric scale: lengths are map units"),
        (None, _) => {}
    }
    text.push_str(&fusion_text(&report.fusion));
    text.push_str(&format!(
        "\nwritten to {}: {}",
        folder.display(),
        report.files.join(", ")
    ));
    text
}

/// What moved the filter, or that there was none.
fn fusion_text(fusion: &FusionReport) -> String {
    let FusionReport {
        samples,
        accepted,
        rejected,
        dead_reckoned,
        outside,
        ..
    } = fusion;
    let Some(file) = &fusion.file else {
        return "\nno telemetry: poses are the odometry's own, no filter was used".to_owned();
    };
    let Some(meters) = fusion.meters_per_unit else {
        return format!(
            "\ntelemetry of {file} ({samples} samples) not used: while tracked, the drone never moved at 0.15 m/s for a second"
        );
    };
    format!(
        "\nfused with {file}: {samples} samples; {accepted} visual poses taken, {rejected} refused, \
         {dead_reckoned} frames by telemetry alone, {outside} outside of it; {meters:.3} m a unit of the odometry"
    )
}
