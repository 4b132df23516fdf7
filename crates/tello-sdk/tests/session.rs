//! The session against the emulated drone in virtual time.

#![allow(clippy::unwrap_used, clippy::panic)]

mod virtual_flight;

use std::time::Duration;
use tello_sdk::emulator::{EmulatorConfig, Faults};
use tello_sdk::*;
use virtual_flight::Flight;

fn flight(drone: EmulatorConfig) -> Flight {
    Flight::new(SessionConfig::default(), drone)
}

fn seconds(s: u64) -> Duration {
    Duration::from_secs(s)
}

#[test]
fn a_square_is_flown_and_every_command_answered() {
    let mut flight = flight(EmulatorConfig::default());
    assert!(flight.fly("command").is_done());
    assert!(flight.fly("takeoff").is_done());
    for _ in 0..4 {
        assert!(matches!(flight.fly("forward 100"), Outcome::Answered(_)));
        assert!(matches!(flight.fly("cw 90"), Outcome::Answered(_)));
    }
    let Outcome::Answered(battery) = flight.fly("battery?") else {
        panic!()
    };
    assert!(battery.number().unwrap() > 80.0);
    assert_eq!(flight.session.motors(), Motors::Turning);
    assert!(flight.fly("land").is_done());
    assert!(!flight.drone.is_flying());
    assert_eq!(flight.count_sent("forward 100"), 4);
    assert_eq!(flight.misattributed, [""; 0]);
    assert_eq!(flight.session.counters().stale, 0);
}

#[test]
fn what_the_sdk_lacks_or_the_lane_forbids_is_an_error_before_sending() {
    let mut flight = flight(EmulatorConfig::default());
    let throw = flight.session.request(flight.now, Command::ThrowFly);
    assert!(matches!(throw, Err(RequestError::Unsupported { .. })));
    assert_eq!(
        flight.session.request(flight.now, Command::RC_ZERO),
        Err(RequestError::Sticks)
    );
    flight.fly("command");
    for _ in 0..17 {
        let _ = flight.session.request(flight.now, Command::StreamOff);
    }
    let full = flight.session.request(flight.now, Command::StreamOff);
    assert!(matches!(full, Err(RequestError::QueueFull { waiting: 16 })));
}

#[test]
fn a_lost_take_off_is_not_sent_again_and_judged_not_started() {
    // The command is swallowed by a gap of the link.
    let faults = Faults {
        gap: Some((seconds(3), seconds(4))),
        ..Faults::default()
    };
    let mut lossy = flight(EmulatorConfig {
        faults,
        ..EmulatorConfig::default()
    });
    lossy.fly("command");
    lossy.run(Duration::from_millis(3500), |_| false);
    let outcome = lossy.fly("takeoff");
    assert_eq!(
        outcome,
        Outcome::Unknown {
            verdict: Verdict::NotStarted,
            attempts: 1
        }
    );
    assert_eq!(lossy.count_sent("takeoff"), 1);
    assert!(!lossy.drone.is_flying());
}

#[test]
fn a_lost_reply_is_judged_done_by_the_telemetry_and_the_next_move_waits() {
    // The replies to motions come five minutes late, which is never.
    let faults = Faults {
        late: 1.0,
        late_by: seconds(300),
        ..Faults::default()
    };
    let mut flight = flight(EmulatorConfig {
        faults,
        ..EmulatorConfig::default()
    });
    flight.fly("command");
    for text in ["takeoff", "up 60", "cw 180", "forward 200"] {
        let before = flight.now;
        let wanted = Outcome::Unknown {
            verdict: Verdict::Done,
            attempts: 1,
        };
        assert_eq!(flight.fly(text), wanted, "{text}");
        assert_eq!(flight.count_sent(text), 1);
        assert!(
            flight.now - before < seconds(32),
            "{text} took {:?}",
            flight.now - before
        );
    }
    assert_eq!(flight.fly("land"), Outcome::Confirmed);
    assert_eq!(flight.misattributed, [""; 0]);
}

#[test]
fn land_overtakes_a_running_move_and_is_confirmed_by_the_motors() {
    let mut flight = flight(EmulatorConfig::default());
    flight.fly("command");
    flight.fly("takeoff");
    let forward = flight
        .session
        .request(flight.now, Command::parse("forward 500").unwrap())
        .unwrap();
    let waiting = flight
        .session
        .request(flight.now, Command::parse("up 50").unwrap())
        .unwrap();
    flight.run(flight.now + seconds(1), |_| false);
    assert_eq!(flight.fly("land"), Outcome::Confirmed);
    assert!(!flight.drone.is_flying());
    let outcome = |id| {
        flight.events.iter().find_map(|(_, e)| match e {
            Event::Finished {
                id: found, outcome, ..
            } if *found == id => Some(outcome.clone()),
            _ => None,
        })
    };
    assert!(matches!(
        outcome(forward),
        Some(Outcome::Unknown {
            verdict: Verdict::InProgress,
            attempts: 1
        })
    ));
    assert_eq!(outcome(waiting), Some(Outcome::NotSent));
    assert_eq!(flight.count_sent("up 50"), 0);
}

#[test]
fn land_is_repeated_while_the_drone_ignores_it() {
    let faults = Faults {
        deaf_to_land: seconds(5),
        ..Faults::default()
    };
    let mut flight = flight(EmulatorConfig {
        faults,
        ..EmulatorConfig::default()
    });
    flight.fly("command");
    flight.fly("takeoff");
    assert_eq!(flight.fly("land"), Outcome::Confirmed);
    assert!(flight.count_sent("land") >= 4);
    assert!(!flight.drone.is_flying());
}

#[test]
fn sticks_go_out_at_twenty_hertz_and_are_centred_by_the_watchdog() {
    let mut flight = flight(EmulatorConfig::default());
    flight.fly("command");
    flight.fly("takeoff");
    let forward = Sticks {
        pitch: Stick::from_percent(50).unwrap(),
        ..Sticks::CENTER
    };
    let start = flight.now;
    for step in 0..10 {
        flight.session.set_sticks(flight.now, forward).unwrap();
        flight.run(start + Duration::from_millis(100) * (step + 1), |_| false);
    }
    let refused = flight
        .session
        .request(flight.now, Command::parse("up 50").unwrap());
    assert_eq!(refused, Err(RequestError::SticksInUse));
    assert!((19..=21).contains(&flight.count_sent("rc 0 50 0 0")));
    flight.run(flight.now + seconds(2), |_| false);
    assert_eq!(flight.count_sent("rc 0 0 0 0"), 5);
    assert!(
        flight
            .events
            .iter()
            .any(|(_, event)| *event == Event::SticksCentered)
    );
    assert!(flight.fly("up 50").is_done());
}

#[test]
fn the_drone_is_kept_alive_without_the_user() {
    let mut flight = flight(EmulatorConfig::default());
    flight.fly("command");
    flight.fly("takeoff");
    flight.run(flight.now + seconds(60), |_| false);
    assert!(flight.drone.is_flying());
    flight.fly("land");
}

#[test]
fn a_missing_heartbeat_lands() {
    let config = SessionConfig {
        heartbeat: Some(seconds(30)),
        ..SessionConfig::default()
    };
    let mut flight = Flight::new(config, EmulatorConfig::default());
    flight.fly("command");
    flight.fly("takeoff");
    flight.run(seconds(60), |_| false);
    assert!(!flight.drone.is_flying());
    assert!(matches!(
        flight.session.alarm(),
        Some(Alarm::Heartbeat { .. })
    ));
}

#[test]
fn a_low_battery_lands_and_refuses_more_until_acknowledged() {
    let mut flight = flight(EmulatorConfig {
        battery: 11.0,
        drain: 20.0,
        ..EmulatorConfig::default()
    });
    flight.fly("command");
    flight.fly("takeoff");
    flight.run(flight.now + seconds(30), |_| false);
    assert!(!flight.drone.is_flying());
    let alarm = Alarm::Battery {
        percent: 9,
        limit: 10,
    };
    assert_eq!(flight.session.alarm(), Some(alarm));
    let again = flight.session.request(flight.now, Command::TakeOff);
    assert_eq!(again, Err(RequestError::Alarmed(alarm)));
    flight.session.acknowledge_alarm();
    assert!(flight.session.request(flight.now, Command::TakeOff).is_ok());
}

#[test]
fn leaving_the_fence_lands() {
    let safety = SafetyConfig {
        fence: Some(([-1.0; 3], [1.0; 3])),
        ..SafetyConfig::default()
    };
    let mut flight = Flight::new(
        SessionConfig {
            safety,
            ..SessionConfig::default()
        },
        EmulatorConfig::default(),
    );
    flight.fly("command");
    flight.fly("takeoff");
    flight.session.report_position(flight.now, [0.5, 0.0, 0.5]);
    assert_eq!(flight.session.alarm(), None);
    flight.session.report_position(flight.now, [1.5, 0.0, 0.5]);
    flight.run(flight.now + seconds(10), |_| false);
    assert!(!flight.drone.is_flying());
}

#[test]
fn silence_of_the_link_lands_as_soon_as_it_is_back() {
    let faults = Faults {
        gap: Some((seconds(10), seconds(20))),
        ..Faults::default()
    };
    let mut flight = flight(EmulatorConfig {
        faults,
        ..EmulatorConfig::default()
    });
    flight.fly("command");
    flight.fly("takeoff");
    flight.run(seconds(30), |_| false);
    let lands: Vec<_> = flight
        .sent
        .iter()
        .filter(|(_, text)| text == "land")
        .collect();
    assert!(
        lands[0].0 < seconds(14),
        "attempted on schedule while the link is dead"
    );
    assert!(lands.iter().any(|(at, _)| *at >= seconds(20)));
    assert!(!flight.drone.is_flying());
    assert!(
        flight
            .events
            .iter()
            .any(|(_, event)| *event == Event::LinkRestored)
    );
}

#[test]
fn the_same_seed_gives_the_same_transcript() {
    let transcript = |seed| {
        let drone = EmulatorConfig {
            faults: Faults::lossy(),
            seed,
            ..EmulatorConfig::default()
        };
        let mut flight = flight(drone);
        for text in ["command", "takeoff", "forward 100", "cw 90", "land"] {
            flight.fly(text);
        }
        flight.sent
    };
    assert_eq!(transcript(7), transcript(7));
    assert_ne!(transcript(7), transcript(8));
}

#[test]
fn a_recorded_flight_runs_again_to_the_letter() {
    let drone = EmulatorConfig {
        faults: Faults::lossy(),
        seed: 3,
        ..EmulatorConfig::default()
    };
    let mut flight = flight(drone);
    for text in [
        "command",
        "takeoff",
        "forward 100",
        "battery?",
        "cw 90",
        "land",
    ] {
        flight.fly(text);
    }
    let again = record::replay(&flight.recording, SessionConfig::default()).unwrap();
    assert_eq!(again.sent, flight.sent);
    assert!(again.is_identical() && again.skipped == 0);
    // A torn tail loses the tail only.
    let torn = &flight.recording[..flight.recording.len() / 2];
    assert!(
        !record::replay(torn, SessionConfig::default())
            .unwrap()
            .recorded
            .is_empty()
    );
}

#[test]
fn times_at_the_end_of_time_do_not_overflow() {
    let mut session = Session::new(SessionConfig::default()).unwrap();
    session.request(Duration::MAX, Command::EnterSdk).unwrap();
    session.set_sticks(Duration::MAX, Sticks::CENTER).unwrap();
    for _ in 0..50 {
        session.handle_input(Input::Tick(Duration::MAX));
        let _ = session.poll_output();
    }
    let config = SessionConfig {
        keep_alive: Some(Duration::MAX),
        ..SessionConfig::default()
    };
    assert!(matches!(
        Session::new(config),
        Err(ConfigError::TooLong {
            field: "keep_alive"
        })
    ));
    let config = SessionConfig {
        stick_period: Duration::ZERO,
        ..SessionConfig::default()
    };
    assert!(matches!(
        Session::new(config),
        Err(ConfigError::Zero {
            field: "stick_period"
        })
    ));
}
