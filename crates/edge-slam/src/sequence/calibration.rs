//! The camera of a recorded folder: its own file, else the calibration that the TUM benchmark publishes.

use std::path::Path;

use super::SequenceError;
use super::folder::optional_text;
use crate::camera::{Camera, PinholeCamera, RadialTangential};

/// File with the 3x3 matrix K.
const NAME: &str = "camera-intrinsics.txt";

/// The folder's `camera-intrinsics.txt`, if there is one.
pub(super) fn read_intrinsics(folder: &Path) -> Result<Option<Camera>, SequenceError> {
    optional_text(folder, NAME)?
        .map(|text| parse_intrinsics(&text))
        .transpose()
}

/// The 3x3 matrix K, row by row; a word that is no number, or a number too many or too few, is an error.
pub(super) fn parse_intrinsics(text: &str) -> Result<Camera, SequenceError> {
    let broken = |line: usize| SequenceError::Line { name: NAME, line };
    let mut numbers = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default();
        for word in content.split_whitespace() {
            let number = word.parse::<f64>().map_err(|_| broken(index + 1))?;
            numbers.push(number);
        }
    }
    let pinhole = match numbers[..] {
        [fx, _, cx, _, fy, cy, _, _, _] => PinholeCamera::new(fx, fy, cx, cy).ok(),
        _ => None,
    };
    pinhole.map(Camera::ideal).ok_or(broken(1))
}

/// The calibration that the TUM benchmark publishes for its three cameras, told by `fr1`, `freiburg1` and so on in
/// the folder's name; the benchmark's default camera for other names.
pub(super) fn tum_camera(folder: &Path) -> Option<Camera> {
    let name = folder.canonicalize().ok();
    let name = name.as_deref().unwrap_or(folder).file_name();
    let name = name.unwrap_or_default().to_string_lossy().to_lowercase();
    let is = |number: char| {
        ["fr", "freiburg"].iter().any(|word| {
            name.match_indices(word)
                .any(|(at, _)| name[at + word.len()..].starts_with(number))
        })
    };
    let [fx, fy, cx, cy, k1, k2, p1, p2, k3] = if is('1') {
        FREIBURG_1
    } else if is('2') {
        FREIBURG_2
    } else if is('3') {
        FREIBURG_3
    } else {
        DEFAULT
    };
    Some(Camera {
        pinhole: PinholeCamera::new(fx, fy, cx, cy).ok()?,
        distortion: RadialTangential { k1, k2, p1, p2, k3 },
    })
}

/// fx fy cx cy k1 k2 p1 p2 k3; the third camera's images are published undistorted.
const FREIBURG_1: [f64; 9] = [
    517.306408, 516.469215, 318.643040, 255.313989, 0.262383, -0.953104, -0.005358, 0.002628,
    1.163314,
];
const FREIBURG_2: [f64; 9] = [
    520.908620, 521.007327, 325.141442, 249.701764, 0.231222, -0.784899, -0.003257, -0.000105,
    0.917205,
];
const FREIBURG_3: [f64; 9] = [535.4, 539.2, 320.1, 247.6, 0.0, 0.0, 0.0, 0.0, 0.0];
const DEFAULT: [f64; 9] = [525.0, 525.0, 319.5, 239.5, 0.0, 0.0, 0.0, 0.0, 0.0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_camera() {
        let focal = |name: &str| tum_camera(Path::new(name)).unwrap().pinhole.fx;
        assert_eq!(focal("x/rgbd_dataset_freiburg1_xyz"), FREIBURG_1[0]);
        assert_eq!(focal("tum_fr2_desk"), FREIBURG_2[0]);
        assert_eq!(focal("TUM_FR3_office"), FREIBURG_3[0]);
        assert_eq!(focal("my frames 1"), DEFAULT[0]);
    }
}
