//! The camera: pinhole with radial and tangential distortion, a labelled default, and a calibration file per drone.
//!
//! Pixels: u to the right, v down, the centre of the first pixel at (0, 0). Rays: x right, y down, z forward.
//! Source of the model: Brown, "Close-range camera calibration", 1971; the same coefficients and order as OpenCV's.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write as _;

/// Where an [`Intrinsics`] comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CalibrationSource {
    /// The mean of five published calibrations of other drones: focal lengths differ by 1.7 % and the principal point by
    /// up to 49 pixels from drone to drone, so measure your own before relying on it.
    PublishedMean,
    /// A calibration of this drone, with its name.
    Drone(String),
}

/// Intrinsic parameters of the video picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Intrinsics {
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
    /// Focal length in pixels, x and y.
    pub focal: [f64; 2],
    /// Principal point, pixels.
    pub principal: [f64; 2],
    /// k1, k2, p1, p2, k3.
    pub distortion: [f64; 5],
    /// Where the numbers come from.
    pub source: CalibrationSource,
}

/// Why a calibration file is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// A line is no `key = value` with a known key and finite numbers.
    #[error("line {line} of the calibration is not understood: `{text}`")]
    Line {
        /// From 1.
        line: usize,
        /// Its text.
        text: String,
    },
    /// A key is missing.
    #[error("the calibration lacks `{key}`")]
    Missing {
        /// Which.
        key: &'static str,
    },
    /// A number makes no camera.
    #[error("the calibration's {what} must be positive")]
    NotPositive {
        /// Which.
        what: &'static str,
    },
}

impl Default for Intrinsics {
    /// The mean of five published calibrations of the 960 x 720 stream (horizontal field of view 54.8 degrees; the
    /// advertised 82.6 degrees are not those of the video).
    fn default() -> Self {
        Self {
            width: 960,
            height: 720,
            focal: [927.00, 925.25],
            principal: [485.77, 358.75],
            distortion: [-0.0235, 0.0713, 0.0004, -0.0005, 0.0],
            source: CalibrationSource::PublishedMean,
        }
    }
}

impl Intrinsics {
    /// The pixel at which a ray is seen; `None` if it points backwards or is not finite.
    #[must_use]
    pub fn project(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        if !(z > 0.0 && x.is_finite() && y.is_finite() && z.is_finite()) {
            return None;
        }
        let [a, b] = self.distort([x / z, y / z]);
        Some([
            a * self.focal[0] + self.principal[0],
            b * self.focal[1] + self.principal[1],
        ])
    }

    /// The direction (x, y, 1) seen at a pixel; `None` if the distortion cannot be inverted there.
    ///
    /// Fixed-point iteration, at most 50 steps, until the pixel is met to 1e-6 pixel.
    #[must_use]
    pub fn ray(&self, [u, v]: [f64; 2]) -> Option<[f64; 3]> {
        let goal = [
            (u - self.principal[0]) / self.focal[0],
            (v - self.principal[1]) / self.focal[1],
        ];
        let tolerance = 1e-6 / self.focal[0].max(self.focal[1]);
        let mut point = goal;
        for _ in 0..50 {
            let seen = self.distort(point);
            let miss = [goal[0] - seen[0], goal[1] - seen[1]];
            if !(miss[0].is_finite() && miss[1].is_finite()) {
                return None;
            }
            if miss[0].abs().max(miss[1].abs()) <= tolerance {
                return Some([point[0], point[1], 1.0]);
            }
            point = [point[0] + miss[0], point[1] + miss[1]];
        }
        None
    }

    fn distort(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ]
    }

    /// The same picture without distortion: 8-bit grey, row by row, bilinear, black where nothing was seen.
    /// `None` if the picture does not have `width * height` bytes.
    #[must_use]
    pub fn undistort_grey(&self, picture: &[u8]) -> Option<Vec<u8>> {
        let (width, height) = (self.width as usize, self.height as usize);
        if picture.len() != width.checked_mul(height)? {
            return None;
        }
        let mut straight = Vec::with_capacity(picture.len());
        for row in 0..self.height {
            for column in 0..self.width {
                let x = (f64::from(column) - self.principal[0]) / self.focal[0];
                let y = (f64::from(row) - self.principal[1]) / self.focal[1];
                let [a, b] = self.distort([x, y]);
                let u = a * self.focal[0] + self.principal[0];
                let v = b * self.focal[1] + self.principal[1];
                straight.push(bilinear(picture, width, height, u, v).unwrap_or(0));
            }
        }
        Some(straight)
    }

    /// The calibration as text, one `key = value` a line.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        let [fx, fy] = self.focal;
        let [cx, cy] = self.principal;
        let [k1, k2, p1, p2, k3] = self.distortion;
        if let CalibrationSource::Drone(name) = &self.source {
            let _ = writeln!(text, "drone = {name}");
        }
        let _ = writeln!(text, "width = {}\nheight = {}", self.width, self.height);
        for (key, value) in KEYS.iter().zip([fx, fy, cx, cy, k1, k2, p1, p2, k3]) {
            let _ = writeln!(text, "{key} = {value}");
        }
        text
    }

    /// Reads what [`Intrinsics::to_text`] writes; `#` begins a comment, a missing distortion coefficient is zero.
    ///
    /// # Errors
    /// A line that is not understood, a missing key, or a size or focal length that is not positive.
    pub fn from_text(text: &str) -> Result<Self, CalibrationError> {
        let (mut drone, mut size, mut values) = (None, [None; 2], [None; 9]);
        for (index, line) in text.lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default().trim();
            if content.is_empty() {
                continue;
            }
            let wrong = || CalibrationError::Line {
                line: index + 1,
                text: line.to_string(),
            };
            let (key, value) = content.split_once('=').ok_or_else(wrong)?;
            let (key, value) = (key.trim(), value.trim());
            let number = || {
                value
                    .parse()
                    .ok()
                    .filter(|v: &f64| v.is_finite())
                    .ok_or_else(wrong)
            };
            match (key, KEYS.iter().position(|known| *known == key)) {
                ("drone", _) => drone = Some(value.to_string()),
                ("width", _) => size[0] = Some(value.parse::<u32>().map_err(|_| wrong())?),
                ("height", _) => size[1] = Some(value.parse::<u32>().map_err(|_| wrong())?),
                (_, Some(slot)) => values[slot] = Some(number()?),
                _ => return Err(wrong()),
            }
        }
        Self::checked(drone, size, values)
    }

    fn checked(
        drone: Option<String>,
        size: [Option<u32>; 2],
        values: [Option<f64>; 9],
    ) -> Result<Self, CalibrationError> {
        let need = |slot: usize| values[slot].ok_or(CalibrationError::Missing { key: KEYS[slot] });
        let focal = [need(0)?, need(1)?];
        let width = size[0].ok_or(CalibrationError::Missing { key: "width" })?;
        let height = size[1].ok_or(CalibrationError::Missing { key: "height" })?;
        if focal[0] <= 0.0 || focal[1] <= 0.0 {
            return Err(CalibrationError::NotPositive {
                what: "focal length",
            });
        }
        if width == 0 || height == 0 {
            return Err(CalibrationError::NotPositive { what: "size" });
        }
        Ok(Self {
            width,
            height,
            focal,
            principal: [need(2)?, need(3)?],
            distortion: [4, 5, 6, 7, 8].map(|slot| values[slot].unwrap_or(0.0)),
            source: CalibrationSource::Drone(drone.unwrap_or_default()),
        })
    }
}

const KEYS: [&str; 9] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];

fn bilinear(picture: &[u8], width: usize, height: usize, u: f64, v: f64) -> Option<u8> {
    if !(u >= 0.0 && v >= 0.0 && u <= (width - 1) as f64 && v <= (height - 1) as f64) {
        return None;
    }
    let (column, row) = (u as usize, v as usize);
    let (right, below) = ((column + 1).min(width - 1), (row + 1).min(height - 1));
    let (a, b) = (u - column as f64, v - row as f64);
    let at = |r: usize, c: usize| picture.get(r * width + c).copied().map(f64::from);
    let top = at(row, column)? * (1.0 - a) + at(row, right)? * a;
    let bottom = at(below, column)? * (1.0 - a) + at(below, right)? * a;
    Some((top * (1.0 - b) + bottom * b + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_default_has_the_videos_field_of_view() {
        let camera = Intrinsics::default();
        let horizontal = 2.0 * (480.0 / camera.focal[0]).atan().to_degrees();
        assert!((54.3..55.1).contains(&horizontal), "{horizontal}");
        assert_eq!(camera.source, CalibrationSource::PublishedMean);
    }

    #[test]
    fn a_file_comes_back_and_wrong_ones_are_named() {
        let camera = Intrinsics {
            source: CalibrationSource::Drone("57A6A7".into()),
            ..Intrinsics::default()
        };
        assert_eq!(Intrinsics::from_text(&camera.to_text()), Ok(camera.clone()));
        let missing = camera.to_text().replace("cx = 485.77\n", "");
        assert_eq!(
            Intrinsics::from_text(&missing),
            Err(CalibrationError::Missing { key: "cx" })
        );
        let nan = camera.to_text().replace("485.77", "NaN");
        assert!(matches!(
            Intrinsics::from_text(&nan),
            Err(CalibrationError::Line { line: 6, .. })
        ));
        let zero = camera.to_text().replace("fx = 927", "fx = 0");
        assert!(matches!(
            Intrinsics::from_text(&zero),
            Err(CalibrationError::NotPositive { .. })
        ));
    }

    #[test]
    fn undistortion_keeps_the_centre_and_straightens_a_line() {
        let camera = Intrinsics {
            width: 64,
            height: 48,
            focal: [50.0, 50.0],
            principal: [31.0, 23.0],
            distortion: [-0.2, 0.0, 0.0, 0.0, 0.0],
            source: CalibrationSource::PublishedMean,
        };
        // A straight wall edge at x/z = 0.4, as the distorting camera sees it.
        let mut picture = std::vec![0_u8; 64 * 48];
        for row in 0..48 {
            for column in 0..64 {
                let ray = camera.ray([f64::from(column), f64::from(row)]).unwrap();
                if ray[0] > 0.4 {
                    picture[(row * 64 + column) as usize] = 255;
                }
            }
        }
        let straight = camera.undistort_grey(&picture).unwrap();
        let edge = |row: usize| (0..64).find(|c| straight[row * 64 + c] > 127).unwrap();
        for row in 3..45 {
            assert!(edge(row).abs_diff(51) <= 1, "row {row}: {}", edge(row));
        }
        assert_eq!(camera.undistort_grey(&[0; 10]), None);
    }

    proptest! {
        #[test]
        fn a_ray_is_seen_where_it_came_from(u in 0.0..960.0f64, v in 0.0..720.0f64) {
            let camera = Intrinsics::default();
            let back = camera.project(camera.ray([u, v]).unwrap()).unwrap();
            prop_assert!((back[0] - u).abs() < 1e-5 && (back[1] - v).abs() < 1e-5);
        }

        #[test]
        fn any_numbers_are_taken(values in proptest::array::uniform5(-1e3..1e3f64), u: f64, v: f64) {
            let camera = Intrinsics { distortion: values, ..Intrinsics::default() };
            let _ = camera.ray([u, v]);
            let _ = camera.project([u, v, 1.0]);
        }

        #[test]
        fn any_text_is_read(text in "((fx|fy|cx|width|height|k1) ?= ?[-0-9.e]{0,6}\n){0,8}\\PC{0,20}") {
            let _ = Intrinsics::from_text(&text);
        }
    }
}
