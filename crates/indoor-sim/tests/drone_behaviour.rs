//! The drone obeys, errs, refuses, drains and crashes as it should.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a broken expectation must fail the test"
)]

use core::time::Duration;

use indoor_sim::{DroneConfig, Phase, SimConfig, Simulator, World};
use tello_sdk::{Command, Distance, Query, Refusal, Speed, Stick, Turn, Waypoint};

fn simulator(config: DroneConfig, seed: u64) -> Simulator {
    let world = World::named("closed-room", seed).unwrap();
    let config = SimConfig {
        drone: config,
        ..SimConfig::exact()
    };
    Simulator::new(world, config, seed).unwrap()
}

/// Sends a command and waits for its reply; the time it took, seconds, and the reply.
fn fly(sim: &mut Simulator, command: &Command) -> (f64, String) {
    let begin = sim.now();
    sim.send(command).unwrap();
    for _ in 0..10_000 {
        if let Some(reply) = sim.poll_reply() {
            return ((sim.now() - begin).as_secs_f64(), reply.raw);
        }
        sim.advance(Duration::from_millis(20));
    }
    panic!("{command} was never answered");
}

fn forward(cm: i64) -> Command {
    Command::Forward(Distance::from_cm(cm).unwrap())
}

fn place(sim: &Simulator) -> [f64; 3] {
    sim.pose().translation.vector.into()
}

#[test]
fn an_exact_drone_goes_exactly_where_it_is_sent() {
    let mut sim = simulator(DroneConfig::exact(), 1);
    let (seconds, reply) = fly(&mut sim, &Command::TakeOff);
    assert!(
        reply == "ok" && (seconds - 3.89).abs() < 0.1,
        "{seconds} {reply}"
    );
    let start = place(&sim);
    assert!((0.8..=1.0).contains(&start[2]));
    fly(&mut sim, &forward(50));
    fly(
        &mut sim,
        &Command::CounterClockwise(Turn::from_degrees(90).unwrap()),
    );
    fly(&mut sim, &forward(40));
    let to = Waypoint::from_cm(30, -20, 25).unwrap();
    fly(
        &mut sim,
        &Command::Go {
            to,
            speed: Speed::from_cm_per_s(50).unwrap(),
        },
    );
    let wanted = [start[0] + 0.5 + 0.2, start[1] + 0.4 + 0.3, start[2] + 0.25];
    for axis in 0..3 {
        assert!(
            (place(&sim)[axis] - wanted[axis]).abs() < 1e-6,
            "{:?} {wanted:?}",
            place(&sim)
        );
    }
    let (seconds, _) = fly(&mut sim, &Command::Land);
    assert!((1.0..3.0).contains(&seconds) && sim.phase() == Phase::Landed);
    assert!((place(&sim)[2] - 0.10).abs() < 1e-6);
    assert!(sim.truth().collisions.is_empty());
}

#[test]
fn moves_err_by_a_few_per_cent() {
    let mut lengths = Vec::new();
    for seed in 0..40 {
        let mut sim = simulator(DroneConfig::default(), seed);
        fly(&mut sim, &Command::TakeOff);
        let before = sim.pose().translation.vector;
        fly(&mut sim, &forward(100));
        lengths.push((sim.pose().translation.vector - before).norm());
    }
    let mean = lengths.iter().sum::<f64>() / 40.0;
    let spread = (lengths.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / 40.0).sqrt();
    assert!(
        (mean - 1.0).abs() < 0.02 && (0.01..0.06).contains(&spread),
        "{mean} {spread}"
    );
}

#[test]
fn a_move_into_a_wall_hits_it() {
    let mut sim = simulator(DroneConfig::exact(), 3);
    fly(&mut sim, &Command::TakeOff);
    let (_, reply) = fly(&mut sim, &forward(400));
    assert_eq!(reply, "error Motor stop");
    assert_eq!(
        (sim.phase(), sim.truth().collisions.len()),
        (Phase::Crashed, 1)
    );
    let hit = sim.truth().collisions[0];
    let solid = sim.world().solids()[hit.solid];
    assert!(solid.distance(hit.position) < 0.10 && sim.truth().min_clearance <= 0.10);
    sim.advance(Duration::from_secs(3));
    assert!(place(&sim)[2] < 0.9, "it falls");
    assert_eq!(
        sim.send(&Command::TakeOff).unwrap_err().refusal,
        Refusal::MotorStop
    );
}

#[test]
fn one_command_at_a_time_but_stop_land_and_questions_always() {
    let mut sim = simulator(DroneConfig::exact(), 4);
    assert_eq!(
        sim.send(&forward(50)).unwrap_err().refusal,
        Refusal::MotorStop
    );
    fly(&mut sim, &Command::TakeOff);
    sim.send(&forward(150)).unwrap();
    sim.advance(Duration::from_millis(1200));
    assert_eq!(
        sim.send(&forward(50)).unwrap_err().refusal,
        Refusal::NotJoystick
    );
    sim.send(&Command::Query(Query::Battery)).unwrap();
    assert_eq!(sim.poll_reply().unwrap().raw, "99");
    let before = sim.pose().translation.vector;
    let (seconds, reply) = fly(&mut sim, &Command::Stop);
    let way = (sim.pose().translation.vector - before).norm();
    assert!(
        reply == "ok" && seconds <= 1.05 && way < 0.15,
        "{seconds} {way}"
    );
    assert!(
        sim.poll_reply().is_none(),
        "the interrupted move is not answered"
    );
    sim.send(&forward(50)).unwrap();
    fly(&mut sim, &Command::Land);
    assert_eq!(sim.phase(), Phase::Landed);
}

#[test]
fn sticks_hold_a_velocity_until_they_are_centred() {
    let mut sim = simulator(DroneConfig::exact(), 5);
    fly(&mut sim, &Command::TakeOff);
    let stick = |percent| Stick::from_percent(percent).unwrap();
    let rc = Command::Rc {
        roll: stick(0),
        pitch: stick(30),
        throttle: stick(0),
        yaw: stick(0),
    };
    let before = place(&sim);
    sim.send(&rc).unwrap();
    sim.advance(Duration::from_secs(3));
    let way = place(&sim)[0] - before[0];
    assert!((0.6..0.9).contains(&way), "{way}");
    assert_eq!(
        sim.send(&forward(20)).unwrap_err().refusal,
        Refusal::NotJoystick
    );
    sim.send(&Command::RC_ZERO).unwrap();
    sim.advance(Duration::from_secs(3));
    let rest = place(&sim);
    sim.advance(Duration::from_secs(1));
    assert!((place(&sim)[0] - rest[0]).abs() < 1e-3 && sim.poll_reply().is_none());
}

#[test]
fn the_battery_refuses_drains_and_lands() {
    let low = DroneConfig {
        battery_percent: 9.0,
        ..DroneConfig::exact()
    };
    let mut sim = simulator(low, 6);
    assert_eq!(
        sim.send(&Command::TakeOff).unwrap_err().refusal,
        Refusal::MotorStop
    );
    let small = DroneConfig {
        battery_percent: 10.5,
        silence_limit: None,
        ..DroneConfig::exact()
    };
    let mut sim = simulator(small, 6);
    fly(&mut sim, &Command::TakeOff);
    sim.advance(Duration::from_secs(30));
    assert!(sim.is_flying());
    sim.advance(Duration::from_secs(30));
    assert_eq!(sim.phase(), Phase::Landed);
    let mut sim = simulator(
        DroneConfig {
            silence_limit: None,
            ..DroneConfig::exact()
        },
        6,
    );
    fly(&mut sim, &Command::TakeOff);
    sim.advance(Duration::from_secs(60));
    let left = sim.telemetry().battery.unwrap().value.percent();
    assert!((91..=92).contains(&left), "{left}");
}

#[test]
fn silence_and_slowness_have_limits() {
    let mut sim = simulator(DroneConfig::exact(), 7);
    fly(&mut sim, &Command::TakeOff);
    sim.advance(Duration::from_secs(20));
    assert_eq!(sim.phase(), Phase::Landed);
    let mut sim = simulator(DroneConfig::exact(), 7);
    fly(&mut sim, &Command::TakeOff);
    let to = Waypoint::from_cm(-190, 0, 0).unwrap();
    let slow = Command::Go {
        to,
        speed: Speed::from_cm_per_s(10).unwrap(),
    };
    let (seconds, reply) = fly(&mut sim, &slow);
    assert!(
        reply == "error Run timeout" && seconds < 16.0,
        "{reply} {seconds}"
    );
}

#[test]
fn telemetry_is_rounded_as_on_the_wire() {
    let mut sim = simulator(DroneConfig::default(), 8);
    fly(&mut sim, &Command::TakeOff);
    fly(
        &mut sim,
        &Command::Clockwise(Turn::from_degrees(30).unwrap()),
    );
    sim.send(&forward(60)).unwrap();
    sim.advance(Duration::from_millis(1000));
    let telemetry = sim.telemetry();
    let attitude = telemetry.attitude.unwrap().value;
    let velocity = telemetry.velocity.unwrap().value.meters_per_s;
    let height = telemetry.height_m.unwrap().value;
    assert!((attitude.yaw_deg - 30.0).abs() <= 5.0 && attitude.yaw_deg.fract() == 0.0);
    assert!(velocity[0] > 0.1 && velocity[1] < 0.0, "{velocity:?}");
    for value in velocity.into_iter().chain([height]) {
        assert!((value * 10.0 - (value * 10.0).round()).abs() < 1e-9);
    }
    let above = place(&sim)[2];
    assert!(
        height < above - 0.05 && height > above - 0.6,
        "{height} {above}"
    );
    assert!((telemetry.tof_m.unwrap().value - above).abs() < 0.05);
}
