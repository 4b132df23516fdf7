//! The named worlds.

use super::WorldError;
use super::floor_plan::FloorPlan;

/// Names of the presets, the default first.
pub const PRESETS: [&str; 4] = ["apartment", "one-door-room", "two-rooms", "closed-room"];

/// The same, for messages.
pub(crate) const KNOWN: &str = "apartment, one-door-room, two-rooms, closed-room";

/// The plan of a preset.
pub(crate) fn plan(name: &str) -> Result<FloorPlan, WorldError> {
    let text = match name {
        "apartment" => include_str!("../../plans/apartment.toml"),
        "one-door-room" => include_str!("../../plans/one-door-room.toml"),
        "two-rooms" => include_str!("../../plans/two-rooms.toml"),
        "closed-room" => include_str!("../../plans/closed-room.toml"),
        _ => {
            return Err(WorldError::UnknownName {
                name: name.to_owned(),
                known: KNOWN,
            });
        }
    };
    text.parse()
}
