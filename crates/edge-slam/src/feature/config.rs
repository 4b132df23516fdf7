//! What an ORB extractor can be told.

/// Parameters of [`super::OrbExtractor`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbConfig {
    /// Features wanted per image, 1..=100 000. Default 1,000 (ORB-SLAM for 640 x 480).
    pub features: usize,
    /// Pyramid levels, 1..=16. Default 8 (Rublee et al. 2011).
    pub levels: usize,
    /// Size ratio of neighbouring levels, 1.05..=2. Default 1.2 (Rublee et al. 2011).
    pub scale_factor: f64,
    /// FAST threshold, grey levels, 1..=100. Default 20 (ORB-SLAM).
    pub threshold: u8,
    /// Threshold for cells that had no corner with the first one, 1..=threshold. Default 7 (ORB-SLAM).
    pub low_threshold: u8,
    /// Side of such a cell, pixels of the level, 16..=256. Default 35 (ORB-SLAM3).
    pub cell: usize,
    /// Which corners are kept when there are too many. Default [`Selection::Strongest`]; geometry
    /// is better off with [`Selection::Balanced`].
    pub selection: Selection,
}

/// Which corners are kept when there are too many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Selection {
    /// The strongest of the level, wherever they are, without the low threshold (Rublee et al. 2011, OpenCV): they
    /// repeat most often, but crowd on few objects.
    #[default]
    Strongest,
    /// The strongest, but no tile of the image may hold more than twice its share: repeats less often by a tenth,
    /// and halves the error of a direction of travel.
    Balanced,
    /// The best of each leaf of a quadtree, so that the whole image is covered evenly (ORB-SLAM).
    Spread,
}

impl Default for OrbConfig {
    fn default() -> Self {
        Self {
            features: 1000,
            levels: 8,
            scale_factor: 1.2,
            threshold: 20,
            low_threshold: 7,
            cell: 35,
            selection: Selection::Strongest,
        }
    }
}

/// A parameter outside its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[error("{name} is {value}, but must be in {min}..={max}")]
pub struct OrbConfigError {
    /// Field of [`OrbConfig`].
    pub name: &'static str,
    /// What was given.
    pub value: f64,
    /// Least allowed value.
    pub min: f64,
    /// Greatest allowed value.
    pub max: f64,
}

impl OrbConfig {
    /// Errs at the first field outside its range.
    ///
    /// # Errors
    /// [`OrbConfigError`] with the field's name and range.
    #[expect(
        clippy::cast_precision_loss,
        reason = "only compared with small bounds"
    )]
    pub fn validate(&self) -> Result<(), OrbConfigError> {
        let fields = [
            ("features", self.features as f64, 1.0, 100_000.0),
            ("levels", self.levels as f64, 1.0, 16.0),
            ("scale_factor", self.scale_factor, 1.05, 2.0),
            ("threshold", f64::from(self.threshold), 1.0, 100.0),
            (
                "low_threshold",
                f64::from(self.low_threshold),
                1.0,
                f64::from(self.threshold),
            ),
            ("cell", self.cell as f64, 16.0, 256.0),
        ];
        for (name, value, min, max) in fields {
            if !(value >= min && value <= max) {
                return Err(OrbConfigError {
                    name,
                    value,
                    min,
                    max,
                });
            }
        }
        Ok(())
    }
}
