//! Depth from a monocular network in ONNX form (feature `depth-onnx`), run on the processor.
//!
//! Contract of the network: input `[1, 3, 224, 224]`, RGB in 0..=1; output `[1, 1, 224, 224]`, metres for a camera like
//! the one it was trained with. The frame is cropped as in training (Wofk et al., ICRA 2019): scaled to 250 rows, the central
//! 304 x 228 squashed to 224 x 224. A grey frame is given as three equal channels. Treat the scale as unknown and gate the
//! result with [`super::fit_depth`]: outside its training data such a network may be worse than a constant.

use rten::Model;
use rten_tensor::NdTensor;
use rten_tensor::prelude::*;

use super::onnx_names::without_operator_names;
use super::{DepthError, DepthImage, DepthSource};
use crate::Frame;

/// Side of the network's input and output, pixels.
const SIDE: usize = 224;
/// Rows to which training scaled its frames, and the part of them that it used.
const TRAINING: [f64; 3] = [250.0, 304.0, 228.0];

/// A loaded network.
#[allow(
    missing_debug_implementations,
    reason = "the network's weights are nobody's debug output"
)]
pub struct OnnxDepth {
    model: Model,
}

impl OnnxDepth {
    /// Loads a network from the bytes of an ONNX file.
    ///
    /// # Errors
    /// [`DepthError::Network`] when the bytes are no ONNX model or use unknown operators.
    pub fn new(bytes: &[u8]) -> Result<Self, DepthError> {
        let failed = DepthError::Network {
            step: "loading the file",
        };
        let bytes = without_operator_names(bytes).ok_or(failed)?;
        let model = Model::load(bytes).map_err(|_| failed)?;
        Ok(Self { model })
    }

    /// Runs the network on 3 x 224 x 224 values in 0..=1, channel by channel, row by row.
    ///
    /// # Errors
    /// [`DepthError::Size`] for another number of values, [`DepthError::Network`] when the network fails.
    pub fn predict(&self, image: Vec<f32>) -> Result<Vec<f32>, DepthError> {
        let (needed, found) = (3 * SIDE * SIDE, image.len());
        if found != needed {
            return Err(DepthError::Size {
                width: SIDE,
                height: SIDE,
                needed,
                found,
            });
        }
        let input = NdTensor::from_data([1, 3, SIDE, SIDE], image);
        let failed = |step| DepthError::Network { step };
        let output = self
            .model
            .run_one(input.view().into(), None)
            .map_err(|_| failed("running"))?;
        let output: NdTensor<f32, 4> = output
            .try_into()
            .map_err(|_| failed("reading its output, which has four dimensions"))?;
        if output.shape() != [1, 1, SIDE, SIDE] {
            return Err(failed("reading its output, which is 1 x 1 x 224 x 224"));
        }
        Ok(output.to_vec())
    }
}

impl DepthSource for OnnxDepth {
    fn depth(&mut self, frame: &Frame<'_>) -> Result<Option<DepthImage>, DepthError> {
        let crop = Crop::of(frame.image.width(), frame.image.height());
        let mut grey = Vec::with_capacity(3 * SIDE * SIDE);
        for index in 0..SIDE * SIDE {
            let (x, y) = crop.to_frame(index % SIDE, index / SIDE);
            let value = frame.image.bilinear(x, y).unwrap_or(0.0) / 255.0;
            #[expect(clippy::cast_possible_truncation, reason = "0..=1")]
            grey.push(value as f32);
        }
        grey.extend_from_within(..);
        grey.extend_from_within(..SIDE * SIDE);
        let small = self.predict(grey)?;
        let (width, height) = (frame.image.width(), frame.image.height());
        let pick = |index: usize| {
            crop.covering(index % width, index / width)
                .map_or(0.0, |(x, y)| small[y * SIDE + x])
        };
        DepthImage::new((0..width * height).map(pick).collect(), width, height).map(Some)
    }

    fn is_metric(&self) -> bool {
        false
    }
}

/// The part of the frame that the network sees, pixels.
struct Crop {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

#[expect(clippy::cast_precision_loss, reason = "pixel coordinates")]
impl Crop {
    fn of(width: usize, height: usize) -> Self {
        let [rows, across, down] = TRAINING;
        let scale = height as f64 / rows;
        let (wide, tall) = ((across * scale).min(width as f64), down * scale);
        let centred = |full: usize, part: f64| (full as f64 - part) / 2.0;
        Self {
            left: centred(width, wide),
            top: centred(height, tall),
            width: wide,
            height: tall,
        }
    }

    /// Centre of a network pixel in the frame.
    fn to_frame(&self, x: usize, y: usize) -> (f64, f64) {
        let place = |start: f64, size: f64, k: usize| {
            (start + size * (k as f64 + 0.5) / SIDE as f64 - 0.5).max(0.0)
        };
        (
            place(self.left, self.width, x),
            place(self.top, self.height, y),
        )
    }

    /// The network pixel that covers a frame pixel, if one does.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked first"
    )]
    fn covering(&self, x: usize, y: usize) -> Option<(usize, usize)> {
        let place = |start: f64, size: f64, k: usize| {
            let k = ((k as f64 + 0.5 - start) / size * SIDE as f64).floor();
            (k >= 0.0 && k < SIDE as f64).then_some(k as usize)
        };
        Some((
            place(self.left, self.width, x)?,
            place(self.top, self.height, y)?,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crop_goes_there_and_back() {
        let crop = Crop::of(640, 480);
        for (x, y) in [(0, 0), (100, 30), (223, 223)] {
            let (u, v) = crop.to_frame(x, y);
            let back = crop.covering(u.round() as usize, v.round() as usize);
            assert_eq!(back, Some((x, y)));
        }
        assert_eq!(crop.covering(0, 0), None);
        assert!(Crop::of(1, 1).covering(0, 0).is_some());
    }

    #[test]
    fn bytes_that_are_no_model_are_refused() {
        assert!(matches!(
            OnnxDepth::new(&[1, 2, 3]),
            Err(DepthError::Network { .. })
        ));
        assert!(OnnxDepth::new(&[]).is_err());
    }
}
