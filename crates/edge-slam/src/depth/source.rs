//! Where depth comes from: a sensor, a constant guess, or nowhere.

use super::{DepthError, DepthImage};
use crate::Frame;

/// Gives each frame its depth, if it can.
pub trait DepthSource {
    /// Depth of a frame, pixel by pixel: of the frame's size. `None` when there is none for it.
    ///
    /// # Errors
    /// [`DepthError`] when the source fails; a source that merely knows nothing gives `None`.
    fn depth(&mut self, frame: &Frame<'_>) -> Result<Option<DepthImage>, DepthError>;

    /// Whether the values are metres; otherwise a scale must be fitted ([`super::fit_depth`]).
    fn is_metric(&self) -> bool;
}

/// The depth that a sensor took with the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SensorDepth;

impl DepthSource for SensorDepth {
    fn depth(&mut self, frame: &Frame<'_>) -> Result<Option<DepthImage>, DepthError> {
        Ok(frame.depth.cloned())
    }

    fn is_metric(&self) -> bool {
        true
    }
}

/// The same distance everywhere: the baseline that a depth network has to beat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantDepth {
    /// Distance, units, positive.
    pub distance: f32,
}

impl DepthSource for ConstantDepth {
    fn depth(&mut self, frame: &Frame<'_>) -> Result<Option<DepthImage>, DepthError> {
        if !(self.distance > 0.0 && self.distance.is_finite()) {
            let value = f64::from(self.distance);
            return Err(DepthError::Parameter {
                name: "distance",
                value,
                range: "positive",
            });
        }
        let (width, height) = (frame.image.width(), frame.image.height());
        DepthImage::new(vec![self.distance; width * height], width, height).map(Some)
    }

    fn is_metric(&self) -> bool {
        false
    }
}

/// No depth at all: purely monocular.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoDepth;

impl DepthSource for NoDepth {
    fn depth(&mut self, _: &Frame<'_>) -> Result<Option<DepthImage>, DepthError> {
        Ok(None)
    }

    fn is_metric(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;

    #[test]
    fn each_source_gives_what_it_has() {
        let image = GrayImage::filled(4, 3, 0);
        let depth = DepthImage::new(vec![2.0; 12], 4, 3).unwrap();
        let frame = Frame {
            time: 0.0,
            image: image.view(),
            depth: Some(&depth),
        };
        assert_eq!(SensorDepth.depth(&frame).unwrap(), Some(depth.clone()));
        assert_eq!(NoDepth.depth(&frame).unwrap(), None);
        let constant = ConstantDepth { distance: 3.0 }
            .depth(&frame)
            .unwrap()
            .unwrap();
        assert_eq!(constant.get(3, 2), Some(3.0));
        assert!(ConstantDepth { distance: f32::NAN }.depth(&frame).is_err());
    }
}
