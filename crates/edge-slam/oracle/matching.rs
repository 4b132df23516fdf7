//! What ways around comparing all descriptors keep and cost, on recorded frames.
//!
//! Usage: matching KITCHEN TRUTH OTHER ; two sequences, the first with its true trajectory. Prints, beside comparing all:
//! matching within the nodes of vocabularies that were trained on every fifth frame of the kitchen's first half or of the other
//! sequence, for pairs of the kitchen's second half; matching by multi-index hashing, for these pairs and for one frame
//! against the descriptors of many; and how often the most similar frame of another time shows the same.
//! Times are milliseconds of processor time, each way in turn, per pair.
#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "a measuring program"
)]

mod cpu_time;

use std::collections::HashSet;
use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::time::Instant;

use cpu_time::mean_cpu_seconds;
use edge_slam::evaluation::{TimedPose, associate};
use edge_slam::feature::{
    Descriptor, Match, MatchConfig, MultiIndex, OrbExtractor, Vocabulary, VocabularyConfig,
    match_by_node, match_descriptors, match_indexed,
};
use edge_slam::nalgebra::Isometry3;
use edge_slam::odometry::OdometryConfig;
use edge_slam::sequence::ImageSequence;
use rand::SeedableRng;
use slam_bridge::read_tum;

type Failure = Box<dyn Error>;

/// The last is matched against up to 100 others, and none of the ten before it.
const LEAST_FRAMES: usize = 111;

/// Descriptors and time of each frame.
struct Frames {
    descriptors: Vec<Vec<Descriptor>>,
    times: Vec<f64>,
}

impl Frames {
    fn read(folder: &str) -> Result<Self, Failure> {
        let sequence = ImageSequence::open(Path::new(folder))?;
        let extractor = OrbExtractor::new(OdometryConfig::default().orb)?;
        let (mut descriptors, mut times) = (Vec::new(), Vec::new());
        for index in 0..sequence.len() {
            if let Some(frame) = sequence.load(index)? {
                descriptors.push(extractor.extract(&frame.image.view()).descriptors);
                times.push(frame.time);
            }
        }
        Ok(Self { descriptors, times })
    }

    fn every_fifth(&self, end: usize) -> Vec<&[Descriptor]> {
        let chosen = self.descriptors.iter().take(end).step_by(5);
        chosen.map(Vec::as_slice).collect()
    }
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kitchen, truth, other] = &arguments[..] else {
        return Err("usage: matching KITCHEN TRUTH OTHER".into());
    };
    let truth = read_tum(BufReader::new(File::open(truth)?))?;
    let (kitchen, other) = (Frames::read(kitchen)?, Frames::read(other)?);
    let count = kitchen.descriptors.len();
    if count < LEAST_FRAMES {
        return Err(format!("KITCHEN has {count} frames, {LEAST_FRAMES} are needed").into());
    }
    let half = count / 2;
    let origin = Instant::now();
    for (name, images) in [
        ("the kitchen's first half", kitchen.every_fifth(half)),
        ("the other sequence", other.every_fifth(usize::MAX)),
    ] {
        let (vocabulary, seconds) = mean_cpu_seconds(origin, 1, || {
            let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
            Vocabulary::train(&images, &VocabularyConfig::default(), rng)
        });
        let vocabulary = vocabulary?;
        let count: usize = images.iter().map(|image| image.len()).sum();
        println!(
            "vocabulary of {name}: {} words from {count} descriptors in {seconds:.2} s",
            vocabulary.words()
        );
        for level in 1..=3 {
            by_node(&kitchen, &vocabulary, level, origin);
        }
        find_again(&kitchen, &truth, &vocabulary)?;
    }
    indexed(&kitchen, origin);
    Ok(())
}

/// Pairs 5 and 10 apart of the second half.
fn pairs(frames: &Frames) -> Vec<[&[Descriptor]; 2]> {
    let count = frames.descriptors.len();
    let begin = (count / 2..count).step_by(5);
    let both = begin.flat_map(|i| [(i, i + 5), (i, i + 10)]);
    both.filter(|&(_, j)| j < count)
        .map(|(i, j)| [&frames.descriptors[i][..], &frames.descriptors[j][..]])
        .collect()
}

/// Milliseconds of the work for a pair, and the results of all pairs.
fn timed<P, R>(origin: Instant, pairs: &[P], work: impl Fn(&P) -> R) -> (f64, Vec<R>) {
    let runs = 4_u32.div_ceil(pairs.len() as u32);
    let (results, seconds) =
        mean_cpu_seconds(origin, runs, || pairs.iter().map(&work).collect::<Vec<R>>());
    (1e3 * seconds / pairs.len() as f64, results)
}

fn by_node(frames: &Frames, vocabulary: &Vocabulary, level: usize, origin: Instant) {
    let config = MatchConfig::default();
    let pairs = pairs(frames);
    let (plain, expected) = timed(origin, &pairs, |[a, b]| match_descriptors(a, b, &config));
    let (indexing, indices) = timed(origin, &pairs, |pair| {
        pair.map(|side| vocabulary.direct_index(side, level))
    });
    let (matching, found) = timed(origin, &indices, |[a, b]| match_by_node(a, b, &config));
    let shared = |(found, expected): (&Vec<Match>, &Vec<Match>)| {
        let known: HashSet<_> = expected.iter().map(|m| (m.first, m.second)).collect();
        let is_known = |m: &&Match| known.contains(&(m.first, m.second));
        found.iter().filter(is_known).count()
    };
    let kept: usize = found.iter().zip(&expected).map(shared).sum();
    let [all, total] = [&expected, &found].map(|m| m.iter().map(Vec::len).sum::<usize>());
    let [kept, more] = [kept, total - kept].map(|n| 100.0 * n as f64 / all as f64);
    println!(
        "  level {level}: keeps {kept:.1} % of {all} matches and adds {more:.1} %; all pairs {plain:.2} ms, by node {matching:.2} ms, both direct indices {indexing:.2} ms"
    );
}

/// For each frame the most similar one at least 60 frames away: does it show the same?
fn find_again(
    frames: &Frames,
    truth: &[TimedPose],
    vocabulary: &Vocabulary,
) -> Result<(), Failure> {
    let stamps: Vec<TimedPose> = frames.times.iter().map(|&time| stamp(time)).collect();
    let places: Vec<(usize, Isometry3<f64>)> = associate(&stamps, truth, 0.02)?
        .into_iter()
        .map(|(i, j)| (i, truth[j].pose))
        .collect();
    let bag = |(i, _): &(usize, _)| vocabulary.bag_of_words(&frames.descriptors[*i]);
    let bags: Vec<_> = places.iter().map(bag).collect();
    let (mut asked, mut right, mut chance) = (0, 0, 0.0);
    for (query, bag) in bags.iter().enumerate() {
        let far: Vec<usize> = (0..bags.len())
            .filter(|k| k.abs_diff(query) >= 60)
            .collect();
        let is_same = |k: &usize| shows_the_same(&places[query].1, &places[*k].1);
        let score = |k: usize| bag.similarity(&bags[k]);
        let good = far.iter().filter(|k| is_same(k)).count();
        let best = far
            .iter()
            .copied()
            .max_by(|a, b| score(*a).total_cmp(&score(*b)));
        let (Some(best), true) = (best, good > 0) else {
            continue;
        };
        asked += 1;
        right += usize::from(is_same(&best));
        chance += good as f64 / far.len() as f64;
    }
    println!(
        "  most similar frame at another time: {right} of {asked} show the same (within 0.5 m and 20 degrees), {chance:.0} by chance"
    );
    Ok(())
}

fn stamp(time: f64) -> TimedPose {
    TimedPose {
        time,
        pose: Isometry3::identity(),
    }
}

fn shows_the_same(a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
    let away = (a.translation.vector - b.translation.vector).norm();
    away < 0.5 && a.rotation.angle_to(&b.rotation) < 20_f64.to_radians()
}

fn indexed(frames: &Frames, origin: Instant) {
    let count = frames.descriptors.len();
    let last = &frames.descriptors[count - 1][..];
    let many: Vec<Vec<Descriptor>> = [10, 30, 100, count - 10]
        .map(|used| frames.descriptors[..used].concat())
        .into();
    let mut sets = vec![pairs(frames)];
    sets.extend(many.iter().map(|many| vec![[last, many]]));
    let strict = |max_distance| MatchConfig {
        max_distance,
        ..MatchConfig::default()
    };
    let nearest = |max_distance| MatchConfig {
        ratio: 1.0,
        mutual: false,
        ..strict(max_distance)
    };
    for set in sets {
        for config in [strict(64), nearest(32), nearest(16)] {
            measure_index(&set, &config, origin);
        }
    }
}

fn measure_index(pairs: &[[&[Descriptor]; 2]], config: &MatchConfig, origin: Instant) {
    let (plain, expected) = timed(origin, pairs, |[a, b]| match_descriptors(a, b, config));
    let (building, indices) = timed(origin, pairs, |pair| pair.map(MultiIndex::new));
    let (matching, found) = timed(origin, &indices, |[a, b]| match_indexed(a, b, config));
    let matches: usize = found.iter().map(Vec::len).sum();
    println!(
        "multi-index, {} of {} by {} descriptors, within {} bits, ratio {}, mutual {}: {matches} matches, the same {}; all pairs {plain:.2} ms, by index {matching:.2} ms, both indices {building:.2} ms",
        pairs.len(),
        pairs[0][0].len(),
        pairs[0][1].len(),
        config.max_distance,
        config.ratio,
        config.mutual,
        found == expected
    );
}
