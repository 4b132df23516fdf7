//! Any bytes as a depth network: loaded or refused, no panic.

#![no_main]

use edge_slam::depth::OnnxDepth;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let _ = OnnxDepth::new(data);
});
