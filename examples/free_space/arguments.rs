//! The command line.

use std::error::Error;
use std::path::PathBuf;

use sparse_to_obstacles::FreeSpaceConfig;

pub(crate) const HELP: &str = "\
How much true surface proven free space leaves open, and how much room it gives

usage: measure_free_space MAP_FOLDER SEQUENCE_FOLDER [REFERENCE_TRAJECTORY] [OPTIONS]

MAP_FOLDER            map.ply, keyframes.csv (with times) and observations.csv(.gz)
SEQUENCE_FOLDER       images with depth images: rgb.txt and depth.txt, or folders color and depth; the camera from
                      camera-intrinsics.txt
REFERENCE_TRAJECTORY  lines `time x y z qx qy qz qw`, camera to world, metres; default: groundtruth_tum.txt or
                      groundtruth.txt in SEQUENCE_FOLDER

--radius METRES       radius of the drone's ball (0.15)
--voxel METRES        edge of a voxel, of the truth and of free space (0.08)
--every FRAMES        use one depth image of so many (5)
--contradiction ODDS  log-odds at which rays contradict a point (that of the library)
";

/// What is measured and how.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Arguments {
    pub(crate) map: PathBuf,
    pub(crate) sequence: PathBuf,
    pub(crate) reference: Option<PathBuf>,
    /// Metres.
    pub(crate) radius: f64,
    /// Metres.
    pub(crate) voxel: f64,
    pub(crate) every: usize,
    pub(crate) contradiction: f64,
}

impl Arguments {
    pub(crate) fn new(map: PathBuf, sequence: PathBuf) -> Self {
        Self {
            map,
            sequence,
            reference: None,
            radius: 0.15,
            voxel: 0.08,
            every: 5,
            contradiction: FreeSpaceConfig::default().contradiction_log_odds,
        }
    }

    /// The words after the command's name.
    pub(crate) fn parse(words: Vec<String>) -> Result<Self, Box<dyn Error>> {
        let mut arguments = Self::new(PathBuf::new(), PathBuf::new());
        let mut paths = Vec::new();
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            if !word.starts_with("--") {
                paths.push(PathBuf::from(word));
                continue;
            }
            let value = words.next().unwrap_or_default();
            arguments.set(&word, &value)?;
        }
        let mut paths = paths.into_iter();
        let (Some(map), Some(sequence), reference, None) =
            (paths.next(), paths.next(), paths.next(), paths.next())
        else {
            return Err(
                "give a map folder and a sequence folder, and at most a trajectory: see --help"
                    .into(),
            );
        };
        Ok(Self {
            map,
            sequence,
            reference,
            ..arguments
        })
    }

    fn set(&mut self, option: &str, value: &str) -> Result<(), String> {
        let number: Option<f64> = value.parse().ok();
        let above_0 = number.filter(|n| *n > 0.0 && n.is_finite());
        let metres = || above_0.ok_or(format!("{option} needs a length above 0, not `{value}`"));
        match option {
            "--radius" => self.radius = metres()?,
            "--voxel" => self.voxel = metres()?,
            "--every" => {
                let count = value.parse().ok().filter(|&n| n > 0);
                self.every =
                    count.ok_or(format!("{option} needs a number above 0, not `{value}`"))?;
            }
            "--contradiction" => {
                let odds = number.filter(|n| *n >= 0.0);
                self.contradiction =
                    odds.ok_or(format!("{option} needs 0 or more, not `{value}`"))?;
            }
            _ => return Err(format!("{option} is no option: see --help")),
        }
        Ok(())
    }
}
