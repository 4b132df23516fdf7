//! Any bytes on the port of the binary protocol, at either end: no panic, and a drained session.

#![no_main]

use libfuzzer_sys::fuzz_target;
use std::net::SocketAddr;
use std::time::Duration;
use tello_sdk::binary::{
    BinaryConfig, BinaryEmulator, BinaryOutput, BinarySession, Frame, LogRecords,
};
use tello_sdk::emulator::{EmulatorConfig, Kinematic, Timing};

fuzz_target!(|data: &[u8]| {
    for record in LogRecords::new(data) {
        let _ = (record.telemetry(Duration::ZERO), record.gyro(), record.tof());
    }
    let mut session = BinarySession::new(BinaryConfig::default());
    let mut drone = BinaryEmulator::new(EmulatorConfig::default(), Kinematic::new(Timing::fast()));
    let client = SocketAddr::from(([127, 0, 0, 1], 9000));
    drone.receive(Duration::ZERO, client, b"conn_req:\x96\x17");
    // The raw bytes, and the same as the content of frames with right checksums.
    let mut datagrams = vec![data.to_vec()];
    if let [kind, low, high, payload @ ..] = data {
        for message in [u16::from_le_bytes([*low, *high]), 0x50, 0x54, 0x56, 0x1050, 0x1051] {
            datagrams.push(Frame { kind: *kind, message, sequence: 1, payload }.encode());
        }
    }
    let mut at = Duration::ZERO;
    for datagram in datagrams {
        at += Duration::from_millis(150);
        session.handle_datagram(at, &datagram);
        drone.receive(at, client, &datagram);
        while drone.poll(at).is_some() {}
        for _ in 0..1000 {
            if matches!(session.poll_output(), BinaryOutput::WaitUntil(_)) {
                break;
            }
        }
        assert!(matches!(session.poll_output(), BinaryOutput::WaitUntil(_)), "too many outputs");
    }
});
