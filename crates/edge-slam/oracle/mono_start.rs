//! How good monocular starts are: tracks a recorded sequence from several frames on with several seeds, holds every start and
//! every epoch against the true trajectory.
//!
//! Usage: mono_start SEQUENCE TRUTH SEEDS FIRST [FIRST...]; prints for every epoch that started "first F seed S epoch E
//! frames A..B tracked N baseline M direction D rotation R ape P turned T": frame numbers of the keyframe and of the first tracked frame, how many
//! are tracked, the true baseline at the start in metres, errors of direction and rotation there in degrees, and after
//! Sim(3) by poses over the epoch the rmse in metres and degrees; then medians.
#![allow(clippy::print_stdout, reason = "a measuring program")]

use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use edge_slam::evaluation::{
    AlignBy, Alignment, ApeConfig, TimedPose, absolute_pose_error, associate,
};
use edge_slam::nalgebra::Isometry3;
use edge_slam::odometry::{Odometry, OdometryConfig};
use edge_slam::sequence::{ImageSequence, LoadedFrame};
use rand::SeedableRng;
use slam_bridge::read_tum;

/// Frames of an epoch, by number.
#[derive(Default)]
struct Epoch {
    begin: usize,
    origin: Isometry3<f64>,
    poses: Vec<(usize, TimedPose)>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, truth, seeds, firsts @ ..] = &arguments[..] else {
        return Err("usage: mono_start SEQUENCE TRUTH SEEDS FIRST [FIRST...]".into());
    };
    let sequence = ImageSequence::open(Path::new(folder))?;
    let truth = read_tum(BufReader::new(File::open(truth)?))?;
    let mut frames = Vec::new();
    for index in 0..sequence.len() {
        frames.extend(sequence.load(index)?);
    }
    let mut all = Vec::new();
    for first in firsts {
        let first: usize = first.parse()?;
        for seed in 1..=seeds.parse::<u64>()? {
            for (number, epoch) in track(&sequence, &frames, first, seed)?.iter().enumerate() {
                if let Some(found) = measure(epoch, &frames, &truth)? {
                    print!("first {first} seed {seed} epoch {number} ");
                    let [tracked, baseline, direction, rotation, ape, turned] = found;
                    let (begin, start) = (epoch.begin, epoch.poses[0].0);
                    println!(
                        "frames {begin}..{start} tracked {tracked} baseline {baseline:.3} direction {direction:.1} rotation {rotation:.2} ape {ape:.4} turned {turned:.2}"
                    );
                    all.push(found);
                }
            }
        }
    }
    summary(&all);
    Ok(())
}

fn track(
    sequence: &ImageSequence,
    frames: &[LoadedFrame],
    first: usize,
    seed: u64,
) -> Result<Vec<Epoch>, Box<dyn Error>> {
    let camera = sequence.camera.ok_or("the folder names no camera")?;
    let mut odometry = Odometry::new(camera, OdometryConfig::default())?;
    let rng = &mut rand_pcg::Pcg64::seed_from_u64(seed);
    let mut epochs: Vec<Epoch> = Vec::new();
    let mut number = None;
    for (index, loaded) in frames.iter().enumerate().skip(first) {
        let tracked = odometry.track(&loaded.frame(), None, rng);
        if number.replace(odometry.current_map().epoch) != Some(odometry.current_map().epoch) {
            let origin = odometry.current_map().keyframes.first();
            epochs.push(Epoch {
                begin: index,
                origin: origin.map_or_else(Isometry3::identity, |k| k.world_from_camera),
                poses: Vec::new(),
            });
        }
        if let (Some(pose), Some(epoch)) = (tracked.world_from_camera, epochs.last_mut()) {
            let time = loaded.time;
            epoch.poses.push((index, TimedPose { time, pose }));
        }
    }
    Ok(epochs)
}

/// What is printed of an epoch; `None` where nothing was tracked or the truth has a gap.
fn measure(
    epoch: &Epoch,
    frames: &[LoadedFrame],
    truth: &[TimedPose],
) -> Result<Option<[f64; 6]>, Box<dyn Error>> {
    let Some((start, pose)) = epoch.poses.first() else {
        return Ok(None);
    };
    let at = |index: usize| TimedPose {
        time: frames[index].time,
        pose: Isometry3::identity(),
    };
    let ends = associate(&[at(epoch.begin), at(*start)], truth, 0.02)?;
    let [(_, a), (_, b)] = ends[..] else {
        return Ok(None);
    };
    let true_motion = truth[b].pose.inv_mul(&truth[a].pose);
    let motion = pose.pose.inv_mul(&epoch.origin);
    let direction = motion
        .translation
        .vector
        .angle(&true_motion.translation.vector);
    let rotation = motion.rotation.angle_to(&true_motion.rotation);
    let poses: Vec<TimedPose> = epoch.poses.iter().map(|(_, pose)| *pose).collect();
    let config = ApeConfig {
        alignment: Alignment::Sim3,
        align_by: AlignBy::Poses,
        ..ApeConfig::default()
    };
    let error = absolute_pose_error(&poses, truth, &config).ok();
    let [ape, turned] = error.map_or([f64::NAN; 2], |e| [e.translation.rmse, e.rotation.rmse]);
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    let tracked = poses.len() as f64;
    let baseline = true_motion.translation.vector.norm();
    let [direction, rotation, turned] = [direction, rotation, turned].map(f64::to_degrees);
    Ok(Some([tracked, baseline, direction, rotation, ape, turned]))
}

fn summary(all: &[[f64; 6]]) {
    let median = |k: usize| {
        let mut values: Vec<f64> = all.iter().map(|found| found[k]).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
    };
    let wrong = all.iter().filter(|found| found[2] > 30.0).count();
    let tracked: f64 = all.iter().map(|found| found[0]).sum();
    let astray: f64 = all.iter().filter(|f| f[2] > 30.0).map(|f| f[0]).sum();
    println!(
        "{} starts, {wrong} off by more than 30 degrees; {tracked} frames tracked, {astray} of them after such a start; medians: direction {:.1}, rotation {:.2}, ape {:.4}, turned {:.2}",
        all.len(),
        median(2),
        median(3),
        median(4),
        median(5)
    );
}
