//! The named worlds.

use super::WorldError;
use super::floor_plan::FloorPlan;

/// Names of the presets, the default first.
pub const PRESETS: [&str; 9] = [
    "apartment",
    "one-door-room",
    "two-rooms",
    "closed-room",
    "corridor-four-doors",
    "ring-corridor",
    "office-six-rooms",
    "cluttered-lab",
    "dead-end-maze",
];

/// The plan of a preset.
pub(crate) fn plan(name: &str) -> Result<FloorPlan, WorldError> {
    let text = match name {
        "apartment" => include_str!("../../plans/apartment.toml"),
        "one-door-room" => include_str!("../../plans/one-door-room.toml"),
        "two-rooms" => include_str!("../../plans/two-rooms.toml"),
        "closed-room" => include_str!("../../plans/closed-room.toml"),
        "corridor-four-doors" => include_str!("../../plans/corridor-four-doors.toml"),
        "ring-corridor" => include_str!("../../plans/ring-corridor.toml"),
        "office-six-rooms" => include_str!("../../plans/office-six-rooms.toml"),
        "cluttered-lab" => include_str!("../../plans/cluttered-lab.toml"),
        "dead-end-maze" => include_str!("../../plans/dead-end-maze.toml"),
        _ => return Err(unknown(name)),
    };
    text.parse()
}

/// No world has this name.
pub(crate) fn unknown(name: &str) -> WorldError {
    WorldError::UnknownName {
        name: name.to_owned(),
    }
}
