//! Seeded fault scenarios in virtual time: 2,500 by default, `TELLO_SCENARIOS=10000` for all.
//!
//! Each scenario draws a mixture of every fault of the text protocol (loss, copies, delays and overtaking in both
//! directions, late and missing replies, refusals, binary packets, replies from other ports, gaps, a deaf or
//! self-landing drone) and a random flight, ended by `land`. Then must hold: no motion left this side more than once
//! per request, no reply was attributed to a command that it does not answer, and the drone stands on the ground.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod virtual_flight;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::time::Duration;
use tello_sdk::emulator::{EmulatorConfig, Faults, WhenBusy};
use tello_sdk::*;
use virtual_flight::Flight;

/// How many scenarios a run flies unless told otherwise.
const SCENARIOS: u64 = 2_500;

struct Report {
    airborne: bool,
    unknown: usize,
}

fn scenario(seed: u64) -> Report {
    let mut rng = Pcg64::seed_from_u64(seed);
    let when_busy = if rng.random_bool(0.5) {
        WhenBusy::Drop
    } else {
        WhenBusy::Refuse
    };
    let drone = EmulatorConfig {
        faults: Faults::random(seed),
        seed,
        when_busy,
        ..EmulatorConfig::default()
    };
    let mut flight = Flight::new(SessionConfig::default(), drone);
    let mut motions = 0;
    let mut airborne = false;
    flight.fly("command");
    for _ in 0..3 {
        if airborne || flight.session.alarm().is_some() {
            break;
        }
        flight.fly("takeoff");
        motions += 1;
        airborne = flight.drone.is_flying();
    }
    for _ in 0..rng.random_range(1..6) {
        motions += fly_something(&mut flight, &mut rng);
        airborne |= flight.drone.is_flying();
    }
    land(&mut flight, &mut rng, seed);
    check(&flight, motions, seed);
    let unknown = |(_, event): &&(Duration, Event)| {
        matches!(
            event,
            Event::Finished {
                outcome: Outcome::Unknown { .. },
                ..
            }
        )
    };
    Report {
        airborne,
        unknown: flight.events.iter().filter(unknown).count(),
    }
}

/// One random command, waited for, abandoned to a stop, or replaced by sticks; returns the motions requested.
fn fly_something(flight: &mut Flight, rng: &mut Pcg64) -> usize {
    let texts = [
        "takeoff",
        "takeoff",
        "forward 100",
        "up 50",
        "cw 90",
        "back 40",
        "battery?",
        "speed 40",
        "tof?",
        "flip l",
    ];
    let text = texts[rng.random_range(0..texts.len())];
    let command = Command::parse(text).unwrap();
    let motion = command.class() == Class::Motion;
    let Ok(id) = flight.session.request(flight.now, command) else {
        return 0;
    };
    if rng.random_bool(0.15) {
        flight.run(
            flight.now + Duration::from_millis(rng.random_range(0..3000)),
            |_| false,
        );
        let stop = flight.session.request(flight.now, Command::Stop).unwrap();
        flight.wait(stop, Duration::from_secs(60));
    } else {
        flight.wait(id, Duration::from_secs(60));
    }
    if rng.random_bool(0.2) {
        let sticks = Sticks {
            pitch: Stick::from_percent(30).unwrap(),
            ..Sticks::CENTER
        };
        let _ = flight.session.set_sticks(flight.now, sticks);
        flight.run(flight.now + Duration::from_millis(700), |_| false);
    }
    usize::from(motion)
}

/// Asks for a landing until it is confirmed, as a user would.
fn land(flight: &mut Flight, rng: &mut Pcg64, seed: u64) {
    flight.run(
        flight.now + Duration::from_millis(rng.random_range(0..2000)),
        |_| false,
    );
    for _ in 0..3 {
        let id = flight.session.request(flight.now, Command::Land).unwrap();
        let outcome = flight.wait(id, Duration::from_secs(100));
        if outcome.is_some_and(|outcome| outcome.is_done()) {
            break;
        }
    }
    // A take-off still on its way would lift it again.
    flight.run(flight.now + Duration::from_secs(5), |_| false);
    assert!(
        !flight.drone.is_flying(),
        "seed {seed}: still flying\n{}",
        flight.transcript()
    );
}

fn check(flight: &Flight, motions: usize, seed: u64) {
    let is_motion = |text: &str| Command::parse(text).is_ok_and(|c| c.class() == Class::Motion);
    let sent = flight
        .sent
        .iter()
        .filter(|(_, text)| is_motion(text))
        .count();
    let reached = flight
        .drone
        .log()
        .iter()
        .filter(|r| !r.is_copy && is_motion(&r.text))
        .count();
    assert!(
        sent <= motions,
        "seed {seed}: {motions} motions requested, {sent} sent"
    );
    assert!(
        reached <= motions,
        "seed {seed}: {motions} motions requested, {reached} arrived"
    );
    let wrong = &flight.misattributed;
    assert!(
        wrong.is_empty(),
        "seed {seed}: {wrong:?}\n{}",
        flight.transcript()
    );
}

#[test]
fn no_motion_twice_no_reply_misattributed_everything_landed() {
    let wanted = std::env::var("TELLO_SCENARIOS")
        .ok()
        .and_then(|count| count.parse().ok());
    let count: u64 = wanted.unwrap_or(SCENARIOS);
    let reports: Vec<Report> = (0..count).map(scenario).collect();
    let airborne = reports.iter().filter(|report| report.airborne).count();
    let unknown: usize = reports.iter().map(|report| report.unknown).sum();
    println!("{count} scenarios, {airborne} in the air, {unknown} commands ended unknown");
    assert!(airborne as u64 > count / 2 && unknown as u64 > count / 10);
}
