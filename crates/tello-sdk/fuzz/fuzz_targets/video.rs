//! Any datagrams on the video port, in both framings: no panic, units within their bound.

#![no_main]

use libfuzzer_sys::fuzz_target;
use std::time::Duration;
use tello_sdk::video::{Assembler, AssemblerConfig, Framing, nal_units};

const LONGEST: usize = 4096;

fuzz_target!(|data: &[u8]| {
    for framing in [Framing::Text, Framing::Binary] {
        let config = AssemblerConfig { framing, max_unit: LONGEST, ..AssemblerConfig::default() };
        let mut assembler = Assembler::new(config);
        let (mut rest, mut at) = (data, Duration::ZERO);
        // The first byte of each piece is its length, and the time that passes before it.
        while let [length, after @ ..] = rest {
            at += Duration::from_millis(u64::from(*length) / 8);
            let (datagram, next) = after.split_at(after.len().min(usize::from(*length) * 8));
            rest = next;
            let timed = assembler.handle_timeout(at);
            for unit in assembler.push(at, datagram).into_iter().chain([timed]).flatten() {
                assert!(unit.data.len() <= LONGEST);
                let _ = nal_units(&unit.data).count();
            }
        }
    }
});
