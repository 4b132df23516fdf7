//! The command line: every command, its flags and their defaults.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

mod emulate;
mod slam;

pub(crate) use emulate::Emulate;
pub(crate) use slam::{
    AlignByChoice, AlignChoice, DepthChoice, Evaluate, Slam, TelemetryChoice, TrackerChoice,
    join_model_file,
};

/// Explores unknown rooms with a toy drone, and cleans, reads and plans on sparse SLAM maps.
///
/// Without a command it flies the demonstration. Lengths are map units: a monocular map has no scale.
/// Where a length is not given, it is derived from the map's own size, as if the median distance from
/// the camera to its points were 1.9 m; --scale says what a map unit really is.
#[derive(Debug, Parser)]
#[command(version, about, long_about, name = "explorer")]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) output: Output,
}

/// What every command understands.
#[derive(Debug, Clone, Args)]
pub(crate) struct Output {
    /// Print one JSON object on stdout and nothing else there.
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Draw the result into FILE.svg or FILE.png.
    #[arg(long, global = true, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Seed of everything random; the same seed gives the same result.
    #[arg(long, global = true, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Fly the default simulated mission and write explorer-out/report.html.
    Demo(Demo),
    /// Run the whole pipeline once on a map: clean, exits, obstacles, path to the best exit.
    Map(Pipeline),
    /// Remove outliers; uses observations when the map has them.
    Clean(Clean),
    /// Find where the place opens, best first.
    Exits(Exits),
    /// Cluster the points into convex obstacles, and prove free space where observations allow it.
    Obstacles(Obstacles),
    /// Plan one path.
    Plan(Plan),
    /// Fly missions in the simulator, faster than real time.
    Simulate(Simulate),
    /// Track a recorded image sequence: trajectory, sparse and edge map, pictures.
    Slam(Slam),
    /// Measure a trajectory against the true one: APE (ATE) and RPE as evo defines them.
    Evaluate(Evaluate),
    /// Be a Tello, or several, on UDP for any client, until interrupted.
    ///
    /// State lines come at 10 Hz, and real H.264 (a moving test card of 960 x 720) while video is on. The
    /// times are those of a real drone: a take-off takes 4 s. Mission pads 1 to 4 lie ahead of each drone, a metre apart,
    /// the first under it.
    Emulate(Emulate),
}

/// A map to read, and what its unit is.
#[derive(Debug, Clone, Args)]
pub(crate) struct Input {
    /// .ply, .pcd, .csv, .xyz or .txt (x y z first), or a folder with map.ply, keyframes.csv and
    /// observations.csv(.gz); of map_N.ply the newest.
    #[arg(value_name = "INPUT")]
    pub(crate) path: PathBuf,
    /// Metres per map unit, if you know it.
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub(crate) scale: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// Folder for the report and the files beside it; made when missing.
    #[arg(short, long, value_name = "DIR", default_value = "explorer-out")]
    pub(crate) output: PathBuf,
    #[arg(long, value_name = "W", default_value = "apartment", help = world_help())]
    pub(crate) world: String,
}

impl Default for Demo {
    fn default() -> Self {
        Self {
            output: "explorer-out".into(),
            world: "apartment".to_owned(),
        }
    }
}

fn world_help() -> String {
    format!(
        "A preset ({}) or generated:SEED",
        indoor_sim::PRESETS.join(", ")
    )
}

#[derive(Debug, Args)]
pub(crate) struct Pipeline {
    #[command(flatten)]
    pub(crate) input: Input,
    /// Where the agent is.
    #[arg(long, value_name = "x,y,z", default_value = "0,0,0", allow_hyphen_values = true, value_parser = vector)]
    pub(crate) position: Vector,
    /// Which way is up: 0,-1,0 for ORB-SLAM maps (y points down).
    #[arg(long, value_name = "x,y,z", default_value = "0,0,1", allow_hyphen_values = true, value_parser = direction)]
    pub(crate) up: Vector,
    /// Clusters to make; one for every 12 kept points by default.
    #[arg(long, value_name = "K")]
    pub(crate) clusters: Option<usize>,
    /// Radius of the body that must fit, map units; as long as 0.15 m by default.
    #[arg(long, value_name = "r", value_parser = positive)]
    pub(crate) radius: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct Clean {
    #[command(flatten)]
    pub(crate) input: Input,
    /// How outliers are told; lengths of every method are multiples of the map's own spacing.
    #[arg(long, value_enum, default_value_t = CleanMethod::Submodular)]
    pub(crate) method: CleanMethod,
    /// Where the camera was, for a map without observations: far points are then judged more
    /// leniently, as their depth is less certain.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = vector)]
    pub(crate) position: Option<Vector>,
    /// Write the kept points.
    #[arg(short, long, value_name = "KEPT.ply", value_parser = ply_file)]
    pub(crate) output: Option<PathBuf>,
    /// Write row (from 0) and score of every point, to cut elsewhere: those at or above 0 are removed. Not for baselines.
    #[arg(long, value_name = "SCORES.csv")]
    pub(crate) scores: Option<PathBuf>,
    /// Repeat the work for a steadier time.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,
    /// Which way is up, for the picture; told by the keyframes, else 0,0,1.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = direction)]
    pub(crate) up: Option<Vector>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CleanMethod {
    /// The recommended one: minimax submodular optimisation on distances divided by viewing ranges, with all that
    /// the observations tell.
    Submodular,
    /// The paper's constants, literally (reading A): they remove nothing, from any map.
    #[value(alias = "a")]
    Paper,
    /// Keeps a point that lies near some other point (reading D).
    #[value(alias = "d")]
    Nearest,
    /// Keeps a point that lies near one that has neighbours of its own (reading F).
    #[value(alias = "f")]
    Supported,
    /// The same, but small groups of points apart from all others go (reading G).
    #[value(alias = "g")]
    Connected,
    /// The same, and a point goes sooner when cameras saw through it (reading H); without observations as connected.
    #[value(alias = "h")]
    Rays,
    /// Baseline: statistical outlier removal, points far from their 20 neighbours, more than 2 deviations above the mean.
    Sor,
    /// Baseline: radius outlier removal, points with fewer than 2 others within 4 nearest-neighbour distances.
    Ror,
    /// Baseline: local outlier factor, points in a thinner place than their 20 neighbours, factor above 1.5.
    Lof,
    /// Baseline: density clustering, points of no cluster, reach 1.8 fourth-neighbour distances, 3 points.
    Dbscan,
}

#[derive(Debug, Args)]
pub(crate) struct Exits {
    #[command(flatten)]
    pub(crate) input: Input,
    /// Where the agent is.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = vector)]
    pub(crate) position: Vector,
    /// Which way is up: 0,-1,0 for ORB-SLAM maps (y points down).
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = direction)]
    pub(crate) up: Vector,
    /// What counts as an opening.
    #[arg(long, value_enum, default_value_t = ExitRule::RangeAware)]
    pub(crate) rule: ExitRule,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExitRule {
    /// Sectors that are empty, or whose points lie well behind the wall beside them.
    RangeAware,
    /// Algorithm 2 as printed: the widest sector without points.
    Paper,
}

#[derive(Debug, Args)]
pub(crate) struct Obstacles {
    #[command(flatten)]
    pub(crate) input: Input,
    /// Clusters to make, at most as many as there are points.
    #[arg(long, value_name = "K")]
    pub(crate) clusters: usize,
    /// Write the hulls as a Wavefront mesh.
    #[arg(short, long, value_name = "HULLS.obj")]
    pub(crate) output: Option<PathBuf>,
    /// Write the centres of the proven-free voxels in which the body fits; needs observations.
    #[arg(long, value_name = "FREE.ply", value_parser = ply_file)]
    pub(crate) proven_free: Option<PathBuf>,
    /// Radius of the body that must fit, map units; as long as 0.15 m by default; 0 asks for its centre alone.
    #[arg(long, value_name = "r", value_parser = not_negative)]
    pub(crate) radius: Option<f64>,
    /// Which way is up, for the picture; told by the keyframes, else 0,0,1.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = direction)]
    pub(crate) up: Option<Vector>,
}

#[derive(Debug, Args)]
pub(crate) struct Plan {
    #[command(flatten)]
    pub(crate) input: Input,
    /// Where the path begins.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = vector)]
    pub(crate) from: Vector,
    /// Where it ends.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = vector)]
    pub(crate) to: Vector,
    /// Radius of the body that must fit, map units; as long as 0.15 m by default.
    #[arg(long, value_name = "r", value_parser = positive)]
    pub(crate) radius: Option<f64>,
    #[arg(long, value_enum, default_value_t = Planner::RrtConnect)]
    pub(crate) planner: Planner,
    #[arg(long, value_enum, default_value_t = Refiner::Dag)]
    pub(crate) refine: Refiner,
    /// Where the path may lead; proven-free when the map has observations, else hulls.
    #[arg(long, value_enum)]
    pub(crate) space: Option<SpaceChoice>,
    /// Clusters to make; one for every 12 kept points by default.
    #[arg(long, value_name = "K")]
    pub(crate) clusters: Option<usize>,
    /// Plan again for a steadier time, of which the median is told.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,
    /// Which way is up, for the picture; told by the keyframes, else 0,0,1.
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = direction)]
    pub(crate) up: Option<Vector>,
}

/// How the tree grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Planner {
    Rrt,
    RrtConnect,
    RrtStar,
    InformedRrtStar,
}

/// How the path is shortened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Refiner {
    /// The shortest path over the path's vertices and over cuts of its corners.
    Dag,
    /// The shortest path over the path's own vertices alone, as the paper has it.
    Vertices,
    /// Tightened like a rope.
    Rope,
    /// The farthest vertex in sight, again and again.
    Greedy,
    None,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SpaceChoice {
    /// Everywhere but in hulls (the paper): crosses walls that have no points.
    Hulls,
    /// Only where the camera has seen through, and in no hull.
    ProvenFree,
}

#[derive(Debug, Args)]
pub(crate) struct Simulate {
    #[arg(long, value_name = "W", help = world_help())]
    pub(crate) world: String,
    /// Missions to fly, with seeds N, N + 1 and so on.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) runs: u32,
    /// What the simulated camera delivers.
    #[arg(long, value_parser = ["features"], default_value = "features")]
    pub(crate) perception: String,
    /// Which SLAM makes the map.
    #[arg(long, value_parser = ["synthetic"], default_value = "synthetic")]
    pub(crate) slam: String,
    /// The radio link.
    #[arg(long, value_parser = ["ideal"], default_value = "ideal")]
    pub(crate) link: String,
}

/// Three numbers of the command line.
pub(crate) type Vector = [f64; 3];

fn vector(text: &str) -> Result<Vector, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| {
            part.trim()
                .parse()
                .map_err(|_| format!("'{part}' is not a number"))
        })
        .collect::<Result<_, _>>()?;
    match <Vector>::try_from(numbers.as_slice()) {
        Ok(vector) if vector.iter().all(|x| x.is_finite()) => Ok(vector),
        Ok(_) => Err("numbers must be finite".to_owned()),
        Err(_) => Err(format!("{} numbers where x,y,z needs three", numbers.len())),
    }
}

fn direction(text: &str) -> Result<Vector, String> {
    let vector = vector(text)?;
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 1e-9 && length.is_finite() {
        Ok(vector.map(|x| x / length))
    } else {
        Err("a direction needs a length".to_owned())
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("must be a finite number above 0".to_owned()),
    }
}

/// The name says what is in the file, to whoever reads it next.
fn ply_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let named = path
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("ply"));
    named
        .then_some(path)
        .ok_or_else(|| "points are written as PLY: name a file .ply".to_owned())
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("must be a finite number, at least 0".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn vectors_have_three_finite_numbers() {
        assert_eq!(vector("0,-1, 2.5"), Ok([0.0, -1.0, 2.5]));
        assert!(vector("0,-1").is_err() && vector("a,b,c").is_err() && vector("nan,0,0").is_err());
        assert_eq!(direction("0,-2,0"), Ok([0.0, -1.0, 0.0]));
        assert!(direction("0,0,0").is_err());
    }
}
