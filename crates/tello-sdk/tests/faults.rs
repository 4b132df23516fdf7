//! Every preset of faults, seen from the client: each does what its name says, and the client lands in spite of it.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod virtual_flight;

use std::time::Duration;
use tello_sdk::emulator::{EmulatorConfig, Faults, PRESETS, Physics};
use tello_sdk::*;
use virtual_flight::Flight;

fn flight(preset: &str) -> Flight {
    let drone = EmulatorConfig {
        faults: Faults::preset(preset, 7).unwrap(),
        seed: 7,
        ..EmulatorConfig::default()
    };
    Flight::new(SessionConfig::default(), drone)
}

/// Up, eight moves there and back, down; what was refused on the ground is asked for once more later.
fn fly(flight: &mut Flight) -> Vec<Outcome> {
    let mut outcomes = vec![flight.fly("command"), flight.fly("takeoff")];
    if !flight.drone.is_flying() {
        flight.run(flight.now + Duration::from_secs(21), |_| false);
        outcomes.push(flight.fly("takeoff"));
    }
    for text in [
        "forward 50",
        "cw 90",
        "back 50",
        "ccw 90",
        "up 40",
        "go 50 0 0 50",
        "down 40",
        "cw 180",
    ] {
        if flight.session.alarm().is_none() {
            outcomes.push(flight.fly(text));
        }
    }
    outcomes.push(flight.fly("land"));
    outcomes
}

#[test]
fn with_every_preset_the_client_ends_on_the_ground_and_repeats_no_motion() {
    for (name, _) in PRESETS {
        let mut flight = flight(name);
        let outcomes = fly(&mut flight);
        flight.run(flight.now + Duration::from_secs(90), |_| false);
        assert!(!flight.drone.is_flying(), "{name}: {outcomes:?}");
        assert_eq!(flight.misattributed, Vec::<String>::new(), "{name}");
        for text in ["forward 50", "up 40", "go 50 0 0 50", "cw 180"] {
            assert!(flight.count_sent(text) <= 1, "{name}: {text}");
        }
    }
}

/// Hovers until the faults with a time have begun.
fn hover(preset: &str) -> Flight {
    let mut flight = flight(preset);
    flight.fly("command");
    flight.fly("takeoff");
    flight.run(Duration::from_secs(26), |_| false);
    flight
}

fn refusals(outcomes: &[Outcome], wanted: Refusal) -> usize {
    let is = |o: &&Outcome| matches!(o, Outcome::Refused { refusal, .. } if *refusal == wanted);
    outcomes.iter().filter(is).count()
}

#[test]
fn each_preset_does_what_it_says() {
    let flown = |name: &str| {
        let mut flight = flight(name);
        let outcomes = fly(&mut flight);
        (flight, outcomes)
    };
    let unknown = |outcomes: &[Outcome]| {
        outcomes
            .iter()
            .filter(|o| matches!(o, Outcome::Unknown { .. }))
            .count()
    };
    let (good, outcomes) = flown("none");
    assert!(
        outcomes
            .iter()
            .all(|o| matches!(o, Outcome::Answered(_) | Outcome::Confirmed))
    );
    let states = good.session.counters().states;
    assert!(flown("lose-state").0.session.counters().states < states * 8 / 10);
    assert!(unknown(&flown("lose-replies").1) + unknown(&flown("lose-commands").1) > 0);
    assert!(unknown(&flown("unanswered").1) > 0);
    assert!(flown("duplicates").0.session.counters().stale > 0);
    assert!(
        flown("late-ok")
            .0
            .heard
            .iter()
            .any(|(_, text)| text.starts_with("ok"))
    );
    assert!(flown("binary-packet").0.session.counters().binary > 0);
    assert!(flown("other-port").0.session.counters().attributed > 0);
    assert!(refusals(&flown("imu-invalid").1, Refusal::NoValidImu) > 0);
    let blind = hover("vision-loss").fly("forward 50");
    assert_eq!(refusals(&[blind], Refusal::NoValidImu), 1);
    assert!(
        flown("refusals")
            .1
            .iter()
            .any(|o| matches!(o, Outcome::Refused { .. }))
    );
    assert!(
        flown("wifi-gap")
            .0
            .events
            .iter()
            .any(|(_, e)| *e == Event::LinkLost)
    );
    let alarm = |name| {
        flown(name).0.events.into_iter().find_map(|(_, e)| match e {
            Event::Alarm(alarm) => Some(alarm),
            _ => None,
        })
    };
    assert_eq!(
        alarm("low-battery"),
        Some(Alarm::Battery {
            percent: 4,
            limit: 10
        })
    );
    assert_eq!(
        alarm("heat"),
        Some(Alarm::Temperature {
            celsius: 101,
            limit: 90
        })
    );
    let mut silent = flight("silent-emergency");
    silent.fly("command");
    silent.fly("takeoff");
    let outcome = silent.fly("emergency");
    assert!(!matches!(outcome, Outcome::Answered(_)) && silent.count_sent("emergency") > 1);
    let mut auto = flight("auto-land");
    auto.fly("command");
    auto.fly("takeoff");
    auto.run(Duration::from_secs(30), |_| false);
    assert!(!auto.drone.is_flying() && auto.count_sent("land") == 0);
}

/// `ap` is answered, the drone reboots into the other network, and answers `command` again.
#[test]
fn station_mode() {
    let mut flight = flight("none");
    flight.fly("command");
    let outcome = flight.fly("ap workshop secret99");
    let Outcome::Answered(reply) = outcome else {
        panic!("{outcome:?}")
    };
    assert!(reply.raw.contains("reboot"), "{}", reply.raw);
    assert!(matches!(flight.fly("command"), Outcome::Answered(_)));
    assert!(!flight.drone.physics().truth().motors);
}
