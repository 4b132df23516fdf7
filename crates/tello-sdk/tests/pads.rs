//! Mission pads: our client flies over emulated ones.

#![allow(clippy::unwrap_used, clippy::panic)]

mod virtual_flight;

use tello_sdk::emulator::{EmulatorConfig, FloorPad, Physics};
use tello_sdk::*;
use virtual_flight::Flight;

fn pad(number: i64, position: [f64; 2], yaw_deg: f64) -> FloorPad {
    let number = PadNumber::from_number(number).unwrap();
    FloorPad {
        number,
        position,
        yaw_deg,
    }
}

fn flight() -> Flight {
    let drone = EmulatorConfig {
        pads: vec![pad(3, [0.0, 0.0], 0.0), pad(5, [1.0, 0.0], 90.0)],
        ..EmulatorConfig::default()
    };
    Flight::new(SessionConfig::default(), drone)
}

fn ok(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Answered(_))
}

fn refused(outcome: &Outcome) -> bool {
    let refusal = Refusal::NotValidMarker;
    matches!(outcome, Outcome::Refused { refusal: r, .. } if *r == refusal)
}

#[test]
fn a_pad_is_seen_only_when_looked_for_and_gives_a_frame_to_fly_in() {
    let mut flight = flight();
    assert!(ok(&flight.fly("command")) && ok(&flight.fly("takeoff")));
    assert!(flight.session.telemetry().pad.is_none());
    assert!(refused(&flight.fly("go 0 0 60 50 m3")), "not looking");
    assert!(ok(&flight.fly("mon")));
    assert!(refused(&flight.fly("go 0 0 60 50 m5")), "a metre away");
    assert!(ok(&flight.fly("go 20 10 60 50 m3")));
    let at = flight.drone.physics().truth().position;
    for (axis, wanted) in [0.2, 0.1, 0.6].into_iter().enumerate() {
        assert!((at[axis] - wanted).abs() < 0.01, "{at:?}");
    }
    flight.run(flight.now + std::time::Duration::from_millis(500), |_| {
        false
    });
    let sighting = flight.session.telemetry().pad.unwrap().value;
    assert_eq!((sighting.pad, sighting.position_cm), (3, [20, 10, 60]));
}

#[test]
fn a_jump_ends_over_the_second_pad_facing_as_asked() {
    let mut flight = flight();
    assert!(ok(&flight.fly("command")) && ok(&flight.fly("takeoff")) && ok(&flight.fly("mon")));
    assert!(ok(&flight.fly("jump 100 0 80 50 0 m3 m5")));
    let truth = flight.drone.physics().truth();
    assert!((truth.position[0] - 1.0).abs() < 0.01, "{truth:?}");
    assert!((truth.attitude_deg[2] - 90.0).abs() < 0.5, "{truth:?}");
    // In the second pad's frame forward is the first one's right.
    assert!(ok(&flight.fly("go 30 0 80 50 m5")));
    let at = flight.drone.physics().truth().position;
    assert!(
        (at[0] - 1.0).abs() < 0.01 && (at[1] + 0.3).abs() < 0.01,
        "{at:?}"
    );
    assert!(
        refused(&flight.fly("jump 100 0 80 50 0 m5 m3")),
        "nothing there"
    );
    assert!(ok(&flight.fly("moff")));
    assert!(refused(&flight.fly("curve 100 100 60 200 0 60 30 m5")));
}
