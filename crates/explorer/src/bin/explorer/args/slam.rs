//! The flags of `slam` and `evaluate`.

use core::str::FromStr;
use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use edge_slam::camera::{Camera, PinholeCamera, RadialTangential};

use super::positive;

#[derive(Debug, Args)]
pub(crate) struct Slam {
    /// A folder with rgb.txt (and depth.txt) as the TUM benchmark has it, with color/ (and depth/), or with nothing but pictures.
    #[arg(value_name = "SEQUENCE")]
    pub(crate) sequence: PathBuf,
    /// Folder for trajectory.txt, the map and the pictures; made when missing.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Where depth comes from: `sensor`, `model FILE` (an ONNX network) or `none`; the sensor's where it was
    /// recorded by default.
    #[arg(long, value_name = "sensor|model FILE|none")]
    pub(crate) depth: Option<DepthChoice>,
    /// How features are found again from frame to frame.
    #[arg(long, value_enum, default_value_t = TrackerChoice::Orb)]
    pub(crate) tracker: TrackerChoice,
    /// The camera, pixels; by default as the sequence's camera-intrinsics.txt says, or the TUM benchmark's own.
    #[arg(long, value_name = "fx,fy,cx,cy[,k1,k2,p1,p2[,k3]]", allow_hyphen_values = true, value_parser = camera)]
    pub(crate) camera: Option<Camera>,
    /// The flight's telemetry, a recording of tello-sdk, or `none`; by default flight.tello beside the frames, where it
    /// is there. Position and scale then come from the filter, in metres.
    #[arg(long, value_name = "FILE|none")]
    pub(crate) telemetry: Option<TelemetryChoice>,
    /// When the recording began, on the clock of the frames.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_hyphen_values = true, value_parser = moment)]
    pub(crate) telemetry_start: f64,
    /// Stop after so many frames.
    #[arg(long, value_name = "N")]
    pub(crate) frames: Option<usize>,
}

/// Where depth comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum DepthChoice {
    Sensor,
    Model(PathBuf),
    None,
}

/// How features are found again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TrackerChoice {
    /// Descriptors in every frame are matched.
    Orb,
    /// The keyframe's patches are followed.
    Klt,
}

/// Where telemetry comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum TelemetryChoice {
    File(PathBuf),
    None,
}

impl FromStr for TelemetryChoice {
    type Err = core::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "none" => Self::None,
            file => Self::File(file.into()),
        })
    }
}

impl FromStr for DepthChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            None if text == "sensor" => Ok(Self::Sensor),
            None if text == "none" => Ok(Self::None),
            Some(("model", file)) if !file.is_empty() => Ok(Self::Model(file.into())),
            _ => Err("say sensor, none, or model and the network's file".to_owned()),
        }
    }
}

/// `--depth model FILE` are two words, which a flag cannot take without swallowing what follows `--depth sensor`:
/// they become `--depth model=FILE`.
pub(crate) fn join_model_file(words: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = Vec::new();
    for word in words {
        let model = match joined.as_slice() {
            [.., flag, last] => flag == "--depth" && last == "model",
            _ => false,
        } || joined.last().is_some_and(|last| last == "--depth=model");
        match joined.last_mut().filter(|_| model) {
            Some(last) => {
                last.push("=");
                last.push(word);
            }
            None => joined.push(word),
        }
    }
    joined
}

fn camera(text: &str) -> Result<Camera, String> {
    let number = |part: &str| {
        let value = part.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        value.ok_or_else(|| format!("'{part}' is not a number"))
    };
    let mut numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    if !matches!(numbers.len(), 4 | 8 | 9) {
        let found = numbers.len();
        return Err(format!("{found} numbers where 4, 8 or 9 belong"));
    }
    numbers.resize(9, 0.0);
    let [fx, fy, cx, cy, k1, k2, p1, p2, k3] = numbers[..] else {
        return Err("four numbers are needed".to_owned());
    };
    Ok(Camera {
        pinhole: PinholeCamera::new(fx, fy, cx, cy).map_err(|error| error.to_string())?,
        distortion: RadialTangential { k1, k2, p1, p2, k3 },
    })
}

#[derive(Debug, Args)]
pub(crate) struct Evaluate {
    /// The trajectory to measure, "time tx ty tz qx qy qz qw" a line (TUM format).
    #[arg(value_name = "ESTIMATE")]
    pub(crate) estimate: PathBuf,
    /// The true trajectory, in the same format.
    #[arg(value_name = "REFERENCE")]
    pub(crate) reference: PathBuf,
    /// What the estimate may be moved by before it is compared: monocular ones need sim3, metric ones se3.
    #[arg(long, value_enum, default_value_t = AlignChoice::Sim3)]
    pub(crate) align: AlignChoice,
    /// What fixes the rotation of that. Unless said: positions for the trajectory, as in published figures, and poses for the map,
    /// whose far points would swing with what positions leave open. Poses want both trajectories to be of the same camera.
    #[arg(long, value_enum)]
    pub(crate) align_by: Option<AlignByChoice>,
    /// Poses up to this many seconds apart are compared.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds)]
    pub(crate) max_difference: f64,
    /// A map in the estimate's frame and unit (the folder that `slam` wrote, or a map file): how much of it lies on the surface
    /// that the sequence's depth images show from the true poses, and how much of that surface it covers.
    #[arg(long, value_name = "MAP", requires = "sequence")]
    pub(crate) map: Option<PathBuf>,
    /// The sequence with the depth images, as `slam` reads it.
    #[arg(long, value_name = "SEQUENCE", requires = "map")]
    pub(crate) sequence: Option<PathBuf>,
    /// How far apart a map point and the surface may be, metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.05, value_parser = positive)]
    pub(crate) threshold: f64,
    /// The depth images' camera, pixels; by default as the sequence says.
    #[arg(long, value_name = "fx,fy,cx,cy[,k1,k2,p1,p2[,k3]]", allow_hyphen_values = true, value_parser = camera)]
    pub(crate) camera: Option<Camera>,
}

/// The freedom of the alignment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum AlignChoice {
    /// Rotation, translation and scale.
    Sim3,
    /// Rotation and translation.
    Se3,
    /// Nothing.
    None,
}

/// What fixes the rotation of an alignment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum AlignByChoice {
    /// Where the camera was.
    Positions,
    /// How it was turned; then scale and translation by where it was.
    Poses,
}

fn moment(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| "must be a finite number of seconds".to_owned())
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("must be a finite number of seconds, 0 or more".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(words: &[&str]) -> Vec<String> {
        let words = words.iter().map(OsString::from);
        join_model_file(words)
            .iter()
            .map(|word| word.to_string_lossy().into_owned())
            .collect()
    }

    #[test]
    fn the_model_takes_the_next_word_and_the_sensor_does_not() {
        let both = joined(&["slam", "--depth", "model", "a b.onnx", "folder"]);
        assert_eq!(both, ["slam", "--depth", "model=a b.onnx", "folder"]);
        assert_eq!(
            joined(&["slam", "--depth=model", "x"]),
            ["slam", "--depth=model=x"]
        );
        let same = ["slam", "--depth", "sensor", "folder", "model", "x"];
        assert_eq!(joined(&same), same);
        assert_eq!(joined(&["--depth", "model"]), ["--depth", "model"]);
        assert_eq!(
            "model=x=y".parse(),
            Ok(DepthChoice::Model(PathBuf::from("x=y")))
        );
        assert!("model".parse::<DepthChoice>().is_err() && "lidar".parse::<DepthChoice>().is_err());
    }

    #[test]
    fn cameras_have_four_eight_or_nine_numbers() {
        assert!(camera("500,500,320,240").is_ok());
        let lens = camera("517,516,318,255,0.26,-0.95,-0.005,0.002").expect("a camera");
        assert_eq!((lens.distortion.k2, lens.distortion.k3), (-0.95, 0.0));
        for bad in ["500", "0,500,320,240", "a,b,c,d", "1,2,3,4,5"] {
            assert!(camera(bad).is_err(), "{bad}");
        }
    }
}
