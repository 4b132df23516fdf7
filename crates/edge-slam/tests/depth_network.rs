//! The network's published check vector; skipped where the file is not there.
#![allow(clippy::unwrap_used, reason = "a test file")]
#![cfg(feature = "depth-onnx")]

mod shared;

use edge_slam::depth::OnnxDepth;
use shared::shared;

#[test]
fn the_check_vector_is_met() {
    let Some(path) = shared(&["models", "fastdepth_nyu.onnx"]) else {
        return;
    };
    let bytes = std::fs::read(path).unwrap();
    let network = OnnxDepth::new(&bytes).unwrap();
    let value = |index: usize| {
        let (c, y, x) = (index / (224 * 224), index / 224 % 224, index % 224);
        let (c, y, x) = (c as f32, y as f32, x as f32);
        0.5 + 0.25 * (x / 17.0 + c).sin() + 0.25 * (y / 23.0 - c).cos()
    };
    let depth = network
        .predict((0..3 * 224 * 224).map(value).collect())
        .unwrap();
    let expected = [
        (0, 0, 1.30068),
        (50, 60, 1.24167),
        (112, 112, 1.32574),
        (180, 30, 1.16055),
        (223, 223, 1.34556),
    ];
    for (row, column, metres) in expected {
        assert!(
            (depth[row * 224 + column] - metres).abs() < 1e-3,
            "{row} {column}"
        );
    }
    let mean = depth.iter().sum::<f32>() / depth.len() as f32;
    assert!((mean - 1.21847).abs() < 1e-3, "{mean}");
    assert!(network.predict(vec![0.0; 5]).is_err());
}
