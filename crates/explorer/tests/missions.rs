//! Whole missions in the simulator, judged by the true geometry that the mission never sees.

use std::error::Error;

use explorer::{FlightSummary, MissionConfig, SimulatedFlight};
use indoor_sim::{SimConfig, World};

fn fly(world: &str, seed: u64) -> Result<FlightSummary, Box<dyn Error>> {
    let place = World::named(world, seed)?;
    let (sim, mission) = (SimConfig::default(), MissionConfig::default());
    let mut flight = SimulatedFlight::new(place, sim, mission, seed)?;
    while !flight.is_over() {
        flight.step(&mut ());
    }
    Ok(flight.summary())
}

/// A drone that stops by itself, has seen all, and kept its whole body and half as much again away from everything solid.
fn assert_explored(world: &str, seed: u64) -> Result<(), Box<dyn Error>> {
    let summary = fly(world, seed)?;
    let body = MissionConfig::default().drone_radius_m;
    let clearance = summary.min_clearance.ok_or("it never flew")?;
    assert_eq!(summary.outcome, "explored", "{world} {seed}: {summary:?}");
    assert_eq!(summary.collisions, 0, "{world} {seed}: {summary:?}");
    assert!(clearance > 1.5 * body, "{world} {seed}: {summary:?}");
    assert!(summary.coverage > 0.95, "{world} {seed}: {summary:?}");
    Ok(())
}

#[test]
fn a_closed_room_is_explored_without_a_touch() {
    for seed in [1, 12] {
        assert_explored("closed-room", seed).unwrap();
    }
}

#[test]
fn the_room_behind_a_door_is_found_without_a_touch() {
    assert_explored("one-door-room", 1).unwrap();
}

#[test]
fn the_same_seed_flies_the_same_way() {
    assert_eq!(
        fly("closed-room", 3).unwrap(),
        fly("closed-room", 3).unwrap()
    );
}
