//! Why a world cannot be built.

use super::PRESETS;

/// Why a world cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// No preset has this name.
    #[error(
        "no world is called {name:?}; use one of {}, or generated:SEED with a whole number",
        PRESETS.join(", ")
    )]
    UnknownName {
        /// The name asked for.
        name: String,
    },
    /// The text is no floor plan.
    #[error("floor plan, line {line}: {reason}")]
    Syntax {
        /// What the parser says.
        reason: String,
        /// Line, counted from 1; 0 when unknown.
        line: usize,
    },
    /// A number is out of its range or not finite.
    #[error("world: {name} is {value}, must be in {low}..={high}")]
    OutOfRange {
        /// Which number.
        name: &'static str,
        /// What it is.
        value: f64,
        /// Least allowed.
        low: f64,
        /// Greatest allowed.
        high: f64,
    },
    /// The plan has no rooms.
    #[error("floor plan: no rooms; add at least one [[rooms]] table")]
    NoRooms,
    /// A room's side is shorter than four wall thicknesses.
    #[error(
        "floor plan: room {room:?} has a side of {side} m, must be at least four wall thicknesses"
    )]
    RoomTooSmall {
        /// The room's name.
        room: String,
        /// The short side, metres.
        side: f64,
    },
    /// A piece of furniture has no volume.
    #[error("floor plan: furniture number {index} has max at or below min in some axis")]
    FlatFurniture {
        /// Its number in the list, from 0.
        index: usize,
    },
    /// A door lies on no wall, or reaches beyond the end of its wall.
    #[error(
        "floor plan: door {door:?} at ({x}, {y}) does not fit into any wall; put its center on a room's border"
    )]
    DoorOffWall {
        /// The door's name.
        door: String,
        /// x of its centre, metres.
        x: f64,
        /// y of its centre, metres.
        y: f64,
    },
    /// The drone does not fit where it should start.
    #[error(
        "floor plan: the start ({x}, {y}) is only {clearance:.2} m from something solid, the drone needs 0.15 m"
    )]
    StartBlocked {
        /// x, metres.
        x: f64,
        /// y, metres.
        y: f64,
        /// Distance to the nearest solid above the floor, metres.
        clearance: f64,
    },
}
