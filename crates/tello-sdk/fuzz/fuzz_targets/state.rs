//! Any bytes on the state port: no panic, and what was read can be written and read again.

#![no_main]

use libfuzzer_sys::fuzz_target;
use std::time::Duration;
use tello_sdk::{Input, Origin, SdkVersion, Session, SessionConfig, StateConvention, StateLine};

fuzz_target!(|data: &[u8]| {
    if let Ok(line) = StateLine::parse(data) {
        let _ = line.telemetry(Duration::ZERO, &StateConvention::default());
        let text = line.encode(SdkVersion::V3_0);
        assert!(StateLine::parse(text.as_bytes()).is_ok(), "{text}");
    }
    if let Ok(mut session) = Session::new(SessionConfig::default()) {
        let (at, origin) = (Duration::from_millis(1), Origin::Drone);
        session.handle_input(Input::State { at, origin, bytes: data });
    }
});
