//! An image of distances along the optical axis.

use crate::image::Neighbourhood;

/// Why numbers cannot be a depth image.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DepthError {
    /// The number of values does not fit the size.
    #[error("{width} x {height} pixels need {needed} depths, {found} are there")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// width * height.
        needed: usize,
        /// Values handed in.
        found: usize,
    },
    /// A parameter is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// What.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// A depth network failed.
    #[error("the depth network failed while {step}")]
    Network {
        /// At what.
        step: &'static str,
    },
    /// Too few good pairs to fit a scale.
    #[error("{pairs} pixels have both depths, at least {needed} are needed")]
    TooFewPairs {
        /// What was found.
        pairs: usize,
        /// What is needed.
        needed: usize,
    },
}

/// Depth z of each pixel, metres (or units up to scale); not positive or NaN where unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthImage {
    data: Vec<f32>,
    width: usize,
    height: usize,
}

impl DepthImage {
    /// Values row by row. Values that are not finite and positive mean "unknown".
    ///
    /// # Errors
    /// [`DepthError::Size`] when their number is not `width * height`, or that is zero.
    pub fn new(data: Vec<f32>, width: usize, height: usize) -> Result<Self, DepthError> {
        let needed = width.saturating_mul(height);
        if needed == 0 || data.len() != needed {
            return Err(DepthError::Size {
                width,
                height,
                needed,
                found: data.len(),
            });
        }
        Ok(Self {
            data,
            width,
            height,
        })
    }

    /// 16-bit readings, `units_per_metre` (TUM: 5000; millimetres: 1000); 0 and 65535 mean no reading.
    ///
    /// # Errors
    /// [`DepthError`] for a wrong count or a unit that is not positive.
    pub fn from_u16(
        readings: &[u16],
        width: usize,
        height: usize,
        units_per_metre: f32,
    ) -> Result<Self, DepthError> {
        if !(units_per_metre > 0.0 && units_per_metre.is_finite()) {
            let value = f64::from(units_per_metre);
            return Err(DepthError::Parameter {
                name: "units_per_metre",
                value,
                range: "positive",
            });
        }
        let metres = |&reading: &u16| match reading {
            0 | u16::MAX => 0.0,
            reading => f32::from(reading) / units_per_metre,
        };
        Self::new(readings.iter().map(metres).collect(), width, height)
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The raw values, row by row.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.data
    }

    /// The depth at a whole pixel, if known.
    #[must_use]
    pub fn get(&self, x: usize, y: usize) -> Option<f64> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let value = f64::from(self.data[y * self.width + x]);
        (value > 0.0 && value.is_finite()).then_some(value)
    }

    /// The bilinear depth at a sub-pixel place, if all four neighbours are known and differ by at most a tenth
    /// of their mean (no interpolation across a depth edge).
    #[must_use]
    pub fn bilinear(&self, x: f64, y: f64) -> Option<f64> {
        let near = Neighbourhood::of(x, y, self.width, self.height)?;
        let ([left, right], [top, bottom]) = (near.columns(), near.rows());
        let corners = [
            self.get(left, top)?,
            self.get(right, top)?,
            self.get(left, bottom)?,
            self.get(right, bottom)?,
        ];
        let (low, high) = corners
            .iter()
            .fold((f64::MAX, 0.0_f64), |(l, h), &d| (l.min(d), h.max(d)));
        if high - low > 0.1 * 0.5 * (high + low) {
            return None;
        }
        Some(near.blend(corners))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_depth_is_none() {
        let image = DepthImage::new(vec![f32::NAN, -1.0, 0.0, 2.0], 2, 2).unwrap();
        assert_eq!(image.get(0, 0), None);
        assert_eq!(image.get(1, 0), None);
        assert_eq!(image.get(1, 1), Some(2.0));
        assert_eq!(image.get(2, 0), None);
        assert_eq!(image.bilinear(0.5, 0.5), None);
        assert_eq!(image.bilinear(1.0, 1.0), Some(2.0));
    }

    #[test]
    fn depth_edges_are_not_bridged() {
        let image = DepthImage::from_u16(&[1000, 1040, 1000, 3000], 2, 2, 1000.0).unwrap();
        assert_eq!(image.bilinear(0.5, 0.5), None);
        assert!(
            (image.bilinear(0.5, 0.0).unwrap_or(0.0) - 1.02).abs() < 1e-6
                || image.bilinear(0.5, 0.0).is_none()
        );
        let flat = DepthImage::from_u16(&[1000, 1040, 1000, 1040], 2, 2, 1000.0).unwrap();
        assert!((flat.bilinear(0.5, 0.5).unwrap() - 1.02).abs() < 1e-6);
        assert!(DepthImage::from_u16(&[1], 1, 1, 0.0).is_err());
        assert!(DepthImage::new(Vec::new(), 0, 5).is_err());
        assert_eq!(
            DepthImage::from_u16(&[0, u16::MAX], 2, 1, 1.0)
                .unwrap()
                .values(),
            [0.0, 0.0]
        );
    }
}
