//! `explorer clean`: which points of a map are outliers.

use std::io::{self, Write};

use explorer::baseline;
use serde::Serialize;
use slam_bridge::write_ply;
use submodular_minimax::{OutlierConfig, StopReason, remove_outliers};

use crate::args::{Clean, CleanMethod, Output, Vector};
use crate::failure::Failure;
use crate::input::{self, LoadedMap};
use crate::output::{deliver, write_file};
use crate::planning::at;
use crate::plot::{Figure, TopView, color, scene};
use crate::progress::Progress;
use crate::stopwatch::{median, timed};

/// The command's JSON object.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct CleanReport {
    /// Points read.
    pub(crate) points: usize,
    /// Points kept.
    pub(crate) kept: usize,
    /// Rows of the removed points in the input, from 0.
    pub(crate) removed_indices: Vec<usize>,
    /// Median time of the repeats.
    pub(crate) seconds: f64,
    /// Iterations of Algorithm 1; none for a baseline.
    pub(crate) iterations: Option<usize>,
    /// Bounds on the value of the solution; none for a baseline.
    pub(crate) certificate: Option<CertificateReport>,
    #[serde(skip)]
    pub(crate) kept_indices: Vec<usize>,
    /// How suspicious each point is; none of a baseline.
    #[serde(skip)]
    scores: Option<Vec<f64>>,
    /// The points give no length to tell outliers by.
    #[serde(skip)]
    without_spacing: bool,
}

/// The value reached lies between the best possible and `upper_bound`.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct CertificateReport {
    lower_bound: f64,
    upper_bound: f64,
}

pub(crate) fn run(arguments: &Clean, output: &Output) -> Result<(), Failure> {
    let progress = Progress::begin("reading the map");
    let loaded = input::load(&arguments.input)?;
    progress.step("removing outliers");
    let report = clean(
        &loaded,
        arguments.method,
        arguments.position,
        arguments.repeat,
    )?;
    drop(progress);
    let scores = match (&arguments.scores, &report.scores) {
        (Some(path), Some(scores)) => Some((path, scores)),
        (Some(_), None) => {
            let advice = "leave --scores out or take a --method that is no baseline";
            return Err(Failure::new("a baseline gives no scores", advice));
        }
        (None, _) => None,
    };
    if let Some(path) = &arguments.output {
        if report.kept == 0 {
            return Err(Failure::new(
                format!(
                    "all {} points are outliers to this method, so nothing is left to write",
                    report.points
                ),
                "try another --method, or leave --output out to see the result",
            ));
        }
        let kept = loaded.map.with_points_at(&report.kept_indices);
        write_file(path, |file| write_ply(&kept, file))?;
    }
    if let Some((path, scores)) = scores {
        write_file(path, |file| write_scores(scores, file))?;
    }
    deliver(output, &report, &text(&report), || {
        figure(&loaded, &report, arguments)
    })
}

fn write_scores(scores: &[f64], file: &mut impl Write) -> io::Result<()> {
    writeln!(file, "row,score")?;
    (scores.iter().enumerate()).try_for_each(|(row, score)| writeln!(file, "{row},{score}"))
}

/// Cleans `repeat` times, which gives the same result each time.
pub(crate) fn clean(
    loaded: &LoadedMap,
    method: CleanMethod,
    position: Option<Vector>,
    repeat: u32,
) -> Result<CleanReport, Failure> {
    let mut times = Vec::new();
    let mut result = None;
    for _ in 0..repeat.max(1) {
        let (removal, seconds) = timed(|| removal(loaded, method, position));
        times.push(seconds);
        result = Some(removal?);
    }
    let mut report = result.ok_or_else(|| Failure::internal("nothing was computed"))?;
    report.seconds = median(times);
    Ok(report)
}

fn removal(
    loaded: &LoadedMap,
    method: CleanMethod,
    position: Option<Vector>,
) -> Result<CleanReport, Failure> {
    let points = &loaded.points;
    let reading = |config| minimax(loaded, position, &config);
    let baseline = match method {
        CleanMethod::Submodular => return reading(OutlierConfig::default()),
        CleanMethod::Paper => return reading(OutlierConfig::paper()),
        CleanMethod::Nearest => return reading(OutlierConfig::nearest()),
        CleanMethod::Supported => return reading(OutlierConfig::supported()),
        CleanMethod::Connected => return reading(OutlierConfig::connected()),
        CleanMethod::Rays => return reading(OutlierConfig::rays()),
        CleanMethod::Sor => baseline::statistical(points, &Default::default()),
        CleanMethod::Ror => baseline::radius(points, &Default::default()),
        CleanMethod::Lof => baseline::lof(points, &Default::default()),
        CleanMethod::Dbscan => baseline::dbscan(points, &Default::default()),
    };
    let removal = baseline.map_err(|error| Failure::new(error, "correct the map"))?;
    Ok(CleanReport {
        points: points.len(),
        kept: removal.kept.len(),
        removed_indices: removal.removed,
        seconds: 0.0,
        iterations: None,
        certificate: None,
        kept_indices: removal.kept,
        scores: None,
        without_spacing: false,
    })
}

fn minimax(
    loaded: &LoadedMap,
    position: Option<Vector>,
    config: &OutlierConfig,
) -> Result<CleanReport, Failure> {
    let views = loaded.views(position)?;
    let removal = remove_outliers(&loaded.points, views.as_ref(), config)
        .map_err(|error| Failure::new(error, "correct the map"))?;
    let certificate = CertificateReport {
        lower_bound: removal.certificate.lower_bound,
        // An empty sum is -0.
        upper_bound: removal.certificate.upper_bound + 0.0,
    };
    Ok(CleanReport {
        points: loaded.points.len(),
        kept: removal.kept.len(),
        removed_indices: removal.removed,
        seconds: 0.0,
        iterations: Some(removal.iterations),
        certificate: Some(certificate),
        kept_indices: removal.kept,
        scores: Some(removal.scores),
        without_spacing: removal.stop == StopReason::NoSpacing,
    })
}

/// "kept 4,239 of 4,460 points (95.0 %)".
pub(crate) fn text(report: &CleanReport) -> String {
    let share = 100.0 * report.kept as f64 / report.points.max(1) as f64;
    let judged = match report.without_spacing {
        true => ", none judged: fewer than five points, or most of them in one place",
        false => "",
    };
    format!(
        "kept {} of {} points ({share:.1} %) in {:.3} s{judged}",
        report.kept, report.points, report.seconds
    )
}

fn figure(loaded: &LoadedMap, report: &CleanReport, arguments: &Clean) -> Result<Figure, Failure> {
    let view = TopView::new(loaded.up(arguments.up), loaded.unit()).map_err(Failure::internal)?;
    let kept = at(&loaded.points, &report.kept_indices);
    let removed = at(&loaded.points, &report.removed_indices);
    Ok(Figure {
        title: "Outlier removal, seen from above".to_owned(),
        subtitle: text(report),
        axes: view.names(),
        layers: vec![
            scene::outliers(&view, &removed),
            scene::cloud("kept", color::POINT, &view, &kept),
        ],
    })
}
