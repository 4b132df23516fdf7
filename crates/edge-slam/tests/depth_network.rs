//! The network's published check vector; skipped where the file is not there.
#![allow(clippy::unwrap_used, reason = "a test file")]
#![cfg(feature = "depth-onnx")]

mod shared;

use edge_slam::depth::OnnxDepth;
use proptest::prelude::*;
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

/// A field of a protocol buffer that has a length.
fn field(number: u8, body: &[u8]) -> Vec<u8> {
    let length = u8::try_from(body.len()).unwrap();
    [&[number << 3 | 2, length], body].concat()
}

#[test]
fn a_network_of_unknown_operators_is_refused() {
    // model.graph = 7, graph.node = 1, node.op_type = 4.
    let node = field(1, &field(4, b"NoSuchOperator"));
    let model = [&[8, 8][..], &field(7, &node)].concat();
    assert!(OnnxDepth::new(&model).is_err());
}

#[test]
fn a_network_file_that_breaks_off_or_was_damaged_is_refused_or_loaded() {
    let Some(path) = shared(&["models", "fastdepth_nyu.onnx"]) else {
        return;
    };
    let whole = std::fs::read(path).unwrap();
    for length in [1, 2, 7, 100, 10_000, whole.len() / 2, whole.len() - 1] {
        assert!(OnnxDepth::new(&whole[..length]).is_err(), "{length}");
    }
    // Where the structure is: at both ends of the file.
    for at in (0..100).chain(whole.len() - 60..whole.len()).step_by(9) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x55;
        let _ = OnnxDepth::new(&damaged);
    }
}

proptest! {
    #[test]
    fn foreign_bytes_are_no_network(bytes in prop::collection::vec(any::<u8>(), 1..200)) {
        // A protocol buffer without a graph may come out by chance; it has nothing to run.
        if let Ok(network) = OnnxDepth::new(&bytes) {
            prop_assert!(network.predict(vec![0.0; 3 * 224 * 224]).is_err());
        }
    }

    #[test]
    fn damaged_graphs_do_not_panic(
        name in "[A-Za-z]{0,12}", at in 0usize..40, value in any::<u8>(), cut in 0usize..60,
    ) {
        let node = field(1, &[field(1, b"x"), field(2, b"y"), field(4, name.as_bytes())].concat());
        let mut model = [&[8, 8][..], &field(7, &node)].concat();
        let at = at % model.len();
        model[at] = value;
        model.truncate(cut);
        let _ = OnnxDepth::new(&model);
    }
}
