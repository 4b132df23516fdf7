//! Any bytes on the command port, at any time, while commands are in flight: no panic, and a drained session.

#![no_main]

use libfuzzer_sys::fuzz_target;
use std::time::Duration;
use tello_sdk::{Command, Input, Origin, Output, Session, SessionConfig};

fuzz_target!(|data: &[u8]| {
    let Ok(mut session) = Session::new(SessionConfig::default()) else {
        return;
    };
    let commands = ["command", "takeoff", "forward 50", "battery?", "attitude?", "land", "stop", "sn?"];
    let mut at = Duration::ZERO;
    // The first byte of each piece chooses what happens before its other bytes arrive.
    for piece in data.split(|byte| *byte == b'\n') {
        let [choice, bytes @ ..] = piece else { continue };
        at += Duration::from_millis(u64::from(*choice) * 7);
        if let Some(Ok(command)) = commands.get(usize::from(choice % 16)).map(|text| Command::parse(text)) {
            let _ = session.request(at, command);
        }
        let origin = if choice & 64 == 0 { Origin::Drone } else { Origin::OtherPort };
        session.handle_input(Input::Reply { at, origin, bytes });
        for _ in 0..1000 {
            if matches!(session.poll_output(), Output::WaitUntil(_)) {
                break;
            }
        }
        assert!(matches!(session.poll_output(), Output::WaitUntil(_)), "too many outputs");
    }
});
