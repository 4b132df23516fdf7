//! The same seed gives the same bits; another seed gives another flight.

#![allow(
    clippy::unwrap_used,
    reason = "a broken expectation must fail the test"
)]

use core::time::Duration;

use indoor_sim::slam_bridge::{Map, SlamSource};
use indoor_sim::{SimConfig, Simulator, World};
use tello_sdk::{Command, Distance, Turn};

/// A short flight: the map and the true trajectory.
fn flight(world_seed: u64, seed: u64, step: Duration) -> (Map, Vec<[f64; 3]>) {
    let world = World::named("generated:4", world_seed).unwrap();
    let mut sim = Simulator::new(world, SimConfig::default(), seed).unwrap();
    let up = Command::Up(Distance::from_cm(30).unwrap());
    let turn = Command::Clockwise(Turn::from_degrees(25).unwrap());
    for command in [Command::TakeOff, up, turn.clone(), turn] {
        sim.send(&command).unwrap();
        let until = sim.now() + Duration::from_secs(5);
        while sim.now() < until {
            sim.advance(step);
        }
    }
    (sim.slam_ref().map(), sim.truth().positions(0.0))
}

#[test]
fn the_same_seed_gives_the_same_bits_whatever_the_callers_step() {
    let once = flight(1, 2, Duration::from_millis(20));
    assert_eq!(once, flight(1, 2, Duration::from_millis(20)));
    assert_eq!(once, flight(1, 2, Duration::from_millis(100)));
}

#[test]
fn another_seed_gives_another_flight() {
    let (map, track) = flight(1, 2, Duration::from_millis(100));
    let (other_map, other_track) = flight(1, 3, Duration::from_millis(100));
    assert!(map != other_map && track != other_track);
    let (texture, same_track) = flight(2, 2, Duration::from_millis(100));
    assert!(map != texture && track == same_track);
}

#[test]
fn generated_plans_differ_by_seed_and_only_by_seed() {
    let plans: Vec<_> = (0..6)
        .map(|seed| indoor_sim::generate(seed).unwrap())
        .collect();
    for (seed, plan) in plans.iter().enumerate() {
        assert_eq!(*plan, indoor_sim::generate(seed as u64).unwrap());
        assert!(plans[..seed].iter().all(|other| other != plan));
    }
}
