//! Canny's edge detector (Canny 1986): smooth, differentiate, thin, and keep weak edges that touch strong ones.

use super::gradient::{GradientRow, sobel_at};
use super::thinning::{STRONG, WEAK, strength, thin};
use crate::image::{GrayImage, GrayView, gaussian_blur};
use crate::simd::{Kernel, widest};

/// How the strength of a gradient is measured (Sobel units: eight times grey levels per pixel).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Norm {
    /// |gx| + |gy|, cheaper (OpenCV's default).
    L1,
    /// √(gx² + gy²). Default.
    #[default]
    L2,
}

/// The two thresholds on the gradient's strength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thresholds {
    /// Sobel units, 0 <= low <= high.
    Fixed {
        /// Weak edges are above this.
        low: f64,
        /// Strong edges are above this.
        high: f64,
    },
    /// high = factor times the median of the strengths that are not zero, low = ratio times high.
    Median {
        /// > 0; 1.33 by default.
        factor: f64,
        /// 0..=1; 0.4 by default.
        ratio: f64,
    },
}

/// Parameters of [`canny`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CannyConfig {
    /// Standard deviation of the smoothing, pixels, >= 0; 0 for none. Default 1.4, cut to 5x5.
    pub sigma: f64,
    /// Thresholds. Default by the median.
    pub thresholds: Thresholds,
    /// Strength. Default [`Norm::L2`].
    pub norm: Norm,
}

impl Default for CannyConfig {
    fn default() -> Self {
        let thresholds = Thresholds::Median {
            factor: 1.33,
            ratio: 0.4,
        };
        Self {
            sigma: 1.4,
            thresholds,
            norm: Norm::L2,
        }
    }
}

/// A parameter of [`CannyConfig`] outside its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[error("{name} is {value}, but must be {range}")]
pub struct CannyError {
    /// Which field.
    pub name: &'static str,
    /// What was given.
    pub value: f64,
    /// What is allowed.
    pub range: &'static str,
}

impl CannyConfig {
    /// Errs at the first field outside its range.
    ///
    /// # Errors
    /// [`CannyError`] with the field's name and range.
    pub fn validate(&self) -> Result<(), CannyError> {
        let check = |name, value: f64, good: bool, range| {
            if good && value.is_finite() {
                Ok(())
            } else {
                Err(CannyError { name, value, range })
            }
        };
        check("sigma", self.sigma, self.sigma >= 0.0, "0 or more pixels")?;
        match self.thresholds {
            Thresholds::Fixed { low, high } => {
                check("low", low, low >= 0.0, "0 or more")?;
                check("high", high, high >= low, "at least low")
            }
            Thresholds::Median { factor, ratio } => {
                check("factor", factor, factor > 0.0, "positive")?;
                check("ratio", ratio, (0.0..=1.0).contains(&ratio), "in 0..=1")
            }
        }
    }
}

/// Thin edges of an image, one pixel wide, with the smoothed image they came from.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeMap {
    pub(super) width: usize,
    pub(super) height: usize,
    /// [`EDGE`] where there is one; with a margin of one pixel all around.
    class: Vec<u8>,
    smooth: GrayImage,
    norm: Norm,
}

impl EdgeMap {
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

    /// Whether a pixel is an edge; outside the image it is not.
    #[must_use]
    pub fn is_edge(&self, x: usize, y: usize) -> bool {
        x < self.width && y < self.height && self.class[(y + 1) * (self.width + 2) + x + 1] == EDGE
    }

    /// How many edge pixels there are. Cost: O(pixels).
    #[must_use]
    pub fn count(&self) -> usize {
        self.class.iter().filter(|&&class| class == EDGE).count()
    }

    /// Gradient at a pixel of the image, Sobel units: across and down.
    pub(super) fn gradient(&self, x: usize, y: usize) -> [i32; 2] {
        sobel_at(&self.smooth.view(), x, y)
    }

    /// Strength at a pixel, squared for [`Norm::L2`]; 0 outside.
    pub(super) fn strength(&self, x: usize, y: usize) -> i32 {
        if x >= self.width || y >= self.height {
            return 0;
        }
        let [gx, gy] = self.gradient(x, y);
        strength(gx, gy, self.norm)
    }
}

pub(super) const EDGE: u8 = 3;

/// Finds edges. Cost: O(pixels).
///
/// A pixel survives thinning when it is stronger than both neighbours across the edge, in the nearest of four
/// directions; of two equal neighbours along a row or column the first stays. Flat images have no edges.
///
/// # Errors
/// [`CannyError`] when a parameter is outside its range.
///
/// ```
/// use edge_slam::edge::{CannyConfig, canny};
/// use edge_slam::image::GrayImage;
/// let pixels = (0..64 * 64).map(|i| if i % 64 < 32 { 20 } else { 220 }).collect();
/// let edges = canny(&GrayImage::new(pixels, 64, 64)?.view(), &CannyConfig::default())?;
/// assert_eq!(edges.count(), 64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn canny(view: &GrayView<'_>, config: &CannyConfig) -> Result<EdgeMap, CannyError> {
    config.validate()?;
    let (width, height) = (view.width(), view.height());
    let smooth = if config.sigma > 0.0 {
        gaussian_blur(view, config.sigma, 2)
    } else {
        unchanged(view)
    };
    let limits = limits(config, &smooth.view());
    let mut class = thin(&smooth.view(), config.norm, limits);
    keep_connected(&mut class, width + 2);
    Ok(EdgeMap {
        width,
        height,
        class,
        smooth,
        norm: config.norm,
    })
}

fn unchanged(view: &GrayView<'_>) -> GrayImage {
    let mut copy = GrayImage::filled(view.width(), view.height(), 0);
    for (y, row) in copy.pixels_mut().chunks_exact_mut(view.width()).enumerate() {
        row.copy_from_slice(view.row(y));
    }
    copy
}

/// Both thresholds in the unit of [`strength`].
#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped; float to integer saturates"
)]
fn limits(config: &CannyConfig, smooth: &GrayView<'_>) -> [i32; 2] {
    let (low, high) = match config.thresholds {
        Thresholds::Fixed { low, high } => (low, high),
        Thresholds::Median { factor, ratio } => {
            let high = factor * median_strength(smooth, config.norm);
            (ratio * high, high)
        }
    };
    let unit = |value: f64| match config.norm {
        Norm::L1 => value.floor() as i32,
        Norm::L2 => (value * value).floor() as i32,
    };
    [unit(low), unit(high)]
}

/// Median of the strengths that are not zero; 0 when all are. A histogram of whole Sobel units.
#[expect(
    clippy::cast_precision_loss,
    reason = "strengths of bytes are below 2048"
)]
fn median_strength(smooth: &GrayView<'_>, norm: Norm) -> f64 {
    let mut histogram = vec![0_usize; 2048];
    let mut row = GradientRow::new(smooth.width());
    let mut lengths = vec![0_u16; smooth.width()];
    for y in 0..smooth.height() {
        widest(RowStrengths {
            smooth,
            y,
            norm,
            row: &mut row,
            lengths: &mut lengths,
        });
        for &length in &lengths {
            histogram[usize::from(length).min(2047)] += 1;
        }
    }
    histogram[0] = 0;
    let total: usize = histogram.iter().sum();
    let mut seen = 0;
    let middle = histogram.iter().position(|&count| {
        seen += count;
        2 * seen >= total
    });
    middle.unwrap_or(0) as f64
}

/// Strengths of a row in whole Sobel units.
struct RowStrengths<'a> {
    smooth: &'a GrayView<'a>,
    y: usize,
    norm: Norm,
    row: &'a mut GradientRow,
    lengths: &'a mut [u16],
}

impl Kernel for RowStrengths<'_> {
    type Output = ();

    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "strengths of bytes are below 2048"
    )]
    fn run(self) {
        let Self {
            smooth,
            y,
            norm,
            row,
            lengths,
        } = self;

        row.compute(smooth, y);
        for ((to, &gx), &gy) in lengths.iter_mut().zip(&row.across).zip(&row.down) {
            let value = strength(i32::from(gx), i32::from(gy), norm);
            *to = match norm {
                Norm::L1 => value as u16,
                Norm::L2 => (value as f32).sqrt() as u16,
            };
        }
    }
}

/// Turns strong pixels and the weak ones connected to them (8 neighbours) into edges; others stay weak.
fn keep_connected(class: &mut [u8], stride: usize) {
    let mut stack = Vec::new();
    for word in 0..class.len().div_ceil(8) {
        let span = word * 8..(word * 8 + 8).min(class.len());
        // Most stretches are empty: one test for eight pixels.
        let any = match class[span.clone()].first_chunk::<8>() {
            Some(bytes) => u64::from_le_bytes(*bytes) & u64::from_le_bytes([STRONG; 8]) != 0,
            None => true,
        };
        if !any {
            continue;
        }
        for start in span {
            if class[start] == STRONG {
                class[start] = EDGE;
                stack.push(start);
                flood(class, stride, &mut stack);
            }
        }
    }
}

fn flood(class: &mut [u8], stride: usize, stack: &mut Vec<usize>) {
    while let Some(index) = stack.pop() {
        // The margin is never an edge, so that the three rows around an edge exist.
        for first in [index - stride - 1, index - 1, index + stride - 1] {
            for (k, value) in class[first..first + 3].iter_mut().enumerate() {
                if *value == WEAK || *value == STRONG {
                    *value = EDGE;
                    stack.push(first + k);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    fn disc() -> GrayImage {
        let inside = |i: i32| (i % 80 - 40).pow(2) + (i / 80 - 30).pow(2) < 400;
        GrayImage::new(
            (0..80 * 60)
                .map(|i| if inside(i) { 210 } else { 40 })
                .collect(),
            80,
            60,
        )
        .unwrap()
    }

    #[test]
    fn a_disc_has_a_closed_rim() {
        let edges = canny(&disc().view(), &CannyConfig::default()).unwrap();
        assert!((100..180).contains(&edges.count()), "{}", edges.count());
        for y in 0..60 {
            for x in 0..80 {
                if edges.is_edge(x, y) {
                    let radius = (x as f64 - 40.0).hypot(y as f64 - 30.0);
                    assert!((radius - 20.0).abs() < 1.5);
                }
            }
        }
    }

    #[test]
    fn weak_edges_need_a_strong_neighbour() {
        let image = disc();
        let at = |low, high| {
            let thresholds = Thresholds::Fixed { low, high };
            canny(
                &image.view(),
                &CannyConfig {
                    thresholds,
                    ..Default::default()
                },
            )
            .unwrap()
            .count()
        };
        assert_eq!(at(10.0, 5000.0), 0);
        assert!(at(10.0, 300.0) >= at(300.0, 300.0));
    }

    proptest! {
        #[test]
        fn edges_are_the_weak_pixels_that_reach_a_strong_one(
            width in 1usize..9, height in 1usize..9, seeds in prop::collection::vec(0u8..8, 64),
        ) {
            let stride = width + 2;
            let mut class = vec![0; stride * (height + 2)];
            for (k, seed) in seeds.iter().enumerate().filter(|(k, _)| k / 8 < height && k % 8 < width) {
                class[(k / 8 + 1) * stride + k % 8 + 1] = [0, 0, 0, WEAK, WEAK, WEAK, WEAK, STRONG][usize::from(*seed)];
            }
            // Pixel by pixel until nothing changes.
            let mut reached: Vec<bool> = class.iter().map(|&c| c == STRONG).collect();
            loop {
                let around = |k: usize| [stride + 1, stride, stride - 1, 1].into_iter().any(|d| reached[k - d] || reached[k + d]);
                let new = (0..class.len()).find(|&k| class[k] == WEAK && !reached[k] && around(k));
                let Some(k) = new else { break };
                reached[k] = true;
            }
            keep_connected(&mut class, stride);
            prop_assert_eq!(class.iter().map(|&c| c == EDGE).collect::<Vec<_>>(), reached);
        }
    }

    #[test]
    fn bad_parameters_are_refused() {
        let view = disc();
        for thresholds in [
            Thresholds::Fixed {
                low: 5.0,
                high: 1.0,
            },
            Thresholds::Fixed {
                low: f64::NAN,
                high: 1.0,
            },
            Thresholds::Median {
                factor: 0.0,
                ratio: 0.4,
            },
            Thresholds::Median {
                factor: 1.0,
                ratio: 2.0,
            },
        ] {
            assert!(
                canny(
                    &view.view(),
                    &CannyConfig {
                        thresholds,
                        ..Default::default()
                    }
                )
                .is_err()
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn any_image_is_fine_and_edges_are_thin(
            width in 1usize..20, height in 1usize..20, seed in prop::collection::vec(any::<u8>(), 400),
        ) {
            let image = GrayImage::new(seed, width, height).unwrap();
            for norm in [Norm::L1, Norm::L2] {
                let config = CannyConfig { norm, sigma: 0.0, ..Default::default() };
                let edges = canny(&image.view(), &config).unwrap();
                prop_assert!(edges.count() <= width * height);
            }
            let flat = GrayImage::filled(width, height, seed_of(&image));
            prop_assert_eq!(canny(&flat.view(), &CannyConfig::default()).unwrap().count(), 0);
        }
    }

    fn seed_of(image: &GrayImage) -> u8 {
        image.pixels()[0]
    }
}
