//! Where the depth of a sequence comes from, and what a network's depth turned out to be worth.

use edge_slam::Frame;
use edge_slam::depth::{DepthFit, DepthImage, DepthSource, NoDepth, SensorDepth};
use edge_slam::sequence::ImageSequence;
use serde::Serialize;

use crate::args::DepthChoice;
use crate::failure::Failure;

/// A source and its name.
pub(crate) struct Depths {
    source: Box<dyn DepthSource>,
    pub(crate) name: &'static str,
}

/// What the command says about depth.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct DepthReport {
    /// sensor, model or none.
    pub(crate) source: &'static str,
    /// Metres per unit by the network, when it passed its test.
    pub(crate) meters_per_unit: Option<f64>,
    /// Correlation of the network's depth with triangulated depth (logarithms), and how many points were compared.
    pub(crate) correlation: Option<f64>,
    pub(crate) pairs: usize,
}

/// A network's depth must correlate at least so well with triangulated points; a constant has 0.
pub(crate) const LEAST_CORRELATION: f64 = 0.5;

impl Depths {
    /// The wanted source; the sensor where the sequence has it, none else, when nothing was said.
    pub(crate) fn open(
        choice: Option<&DepthChoice>,
        sequence: &ImageSequence,
    ) -> Result<Self, Failure> {
        let recorded = sequence.has_depth();
        let of = |name, source| Ok(Self { source, name });
        match choice {
            Some(DepthChoice::Sensor) if !recorded => Err(Failure::new(
                "--depth sensor: no frame of the sequence has a depth image",
                "record depth, or use --depth none or model FILE",
            )),
            Some(DepthChoice::Model(path)) => of("model", network(path)?),
            Some(DepthChoice::Sensor) => of("sensor", Box::new(SensorDepth)),
            None if recorded => of("sensor", Box::new(SensorDepth)),
            Some(DepthChoice::None) | None => of("none", Box::new(NoDepth)),
        }
    }

    /// Whether its depths are metres that tracking may rely on.
    pub(crate) fn is_metric(&self) -> bool {
        self.source.is_metric()
    }

    /// Whether anything that is written may rest on its depths: a network must have passed its test.
    fn is_used(&self, fit: Option<&DepthFit>) -> bool {
        self.is_metric() || self.report(fit).meters_per_unit.is_some()
    }

    /// The frame's depth where it can be relied on.
    pub(crate) fn depth_if_used(
        &mut self,
        frame: &Frame<'_>,
        fit: Option<&DepthFit>,
    ) -> Result<Option<DepthImage>, Failure> {
        match self.is_used(fit) {
            true => self.depth(frame),
            false => Ok(None),
        }
    }

    pub(crate) fn depth(&mut self, frame: &Frame<'_>) -> Result<Option<DepthImage>, Failure> {
        let advice = "use another network, or --depth none";
        self.source
            .depth(frame)
            .map_err(|error| Failure::new(error, advice))
    }

    /// The report, given how the network's depth fitted.
    pub(crate) fn report(&self, fit: Option<&DepthFit>) -> DepthReport {
        let passed = fit.filter(|fit| fit.passes(LEAST_CORRELATION));
        DepthReport {
            source: self.name,
            meters_per_unit: passed.map(|fit| 1.0 / fit.scale),
            correlation: fit.map(|fit| fit.correlation),
            pairs: fit.map_or(0, |fit| fit.pairs),
        }
    }
}

#[cfg(feature = "depth-onnx")]
const MOST_NETWORK_BYTES: u64 = 1 << 30;

#[cfg(feature = "depth-onnx")]
fn network(path: &std::path::Path) -> Result<Box<dyn DepthSource>, Failure> {
    let named = |error: &dyn core::fmt::Display| format!("{}: {error}", path.display());
    let bytes = edge_slam::sequence::read_at_most(path, MOST_NETWORK_BYTES)
        .map_err(|error| Failure::new(named(&error), "check the path"))?;
    let network = edge_slam::depth::OnnxDepth::new(&bytes).map_err(|error| {
        let advice =
            "give an ONNX file with the input and output that the README of edge-slam tells";
        Failure::new(named(&error), advice)
    })?;
    Ok(Box::new(network))
}

#[cfg(not(feature = "depth-onnx"))]
fn network(_: &std::path::Path) -> Result<Box<dyn DepthSource>, Failure> {
    Err(Failure::new(
        "--depth model: this program was built without depth networks",
        "build it with `cargo build --release -p explorer --features depth-onnx`",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracking::{FrameName, draw_frame};
    use edge_slam::depth::ConstantDepth;
    use edge_slam::image::GrayImage;

    #[test]
    fn depth_that_failed_its_test_is_not_drawn() {
        let folder = std::env::temp_dir().join(format!("explorer depth {}", std::process::id()));
        let image = GrayImage::filled(64, 48, 90);
        let frame = Frame {
            time: 0.0,
            image: image.view(),
            depth: None,
        };
        let fit = |correlation| DepthFit {
            scale: 1.0,
            correlation,
            spread: 0.1,
            pairs: 100,
        };
        // Like a network, it gives every frame a depth that is not metres.
        let mut depths = Depths {
            source: Box::new(ConstantDepth { distance: 2.0 }),
            name: "model",
        };
        let name = FrameName {
            index: 0,
            count: 1,
            time: 0.0,
        };
        for (fit, drawn) in [
            (None, false),
            (Some(fit(LEAST_CORRELATION - 0.01)), false),
            (Some(fit(LEAST_CORRELATION)), true),
        ] {
            // The folder may hold pictures of an earlier run.
            std::fs::create_dir_all(&folder).expect("a folder");
            std::fs::write(folder.join("depth.png"), "old").expect("a file");
            let depth = depths.depth_if_used(&frame, fit.as_ref()).expect("depth");
            let names =
                draw_frame(&folder, &image.view(), depth.as_ref(), &name).expect("pictures");
            assert_eq!(names.contains(&"depth.png"), drawn, "{fit:?}");
            assert_eq!(folder.join("depth.png").exists(), drawn, "{fit:?}");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
