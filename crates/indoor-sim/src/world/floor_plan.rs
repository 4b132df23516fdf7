//! A floor plan as a person writes it: rectangular rooms, doors in their walls, furniture, a start pose.

use serde::{Deserialize, Serialize};

use super::WorldError;

/// A plan of one storey, metres, x and y in the floor's plane, z up with the floor at 0.
///
/// Walls stand on the border of every room; where two rooms share a border there is one wall. Doors cut them.
///
/// ```
/// let plan: indoor_sim::FloorPlan = r#"
///     name = "den"
///     [start]
///     position = [1.0, 1.0]
///     [[rooms]]
///     name = "den"
///     min = [0.0, 0.0]
///     max = [4.0, 3.0]
/// "#.parse()?;
/// assert_eq!(plan.height, 2.6);
/// # Ok::<(), indoor_sim::WorldError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FloorPlan {
    /// What the plan is called.
    pub name: String,
    /// Floor to ceiling, metres, above 1.5.
    #[serde(default = "default_height")]
    pub height: f64,
    /// Thickness of walls, metres, in (0, 1).
    #[serde(default = "default_wall_thickness")]
    pub wall_thickness: f64,
    /// Where the drone stands at first.
    pub start: Start,
    /// The rooms; at least one.
    pub rooms: Vec<Room>,
    /// The doors.
    #[serde(default)]
    pub doors: Vec<Door>,
    /// Boxes in the rooms.
    #[serde(default)]
    pub furniture: Vec<Furniture>,
}

/// Where the drone stands at first, on the floor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// x and y, metres.
    pub position: [f64; 2],
    /// Heading, degrees, counter-clockwise from x.
    #[serde(default)]
    pub yaw_degrees: f64,
}

/// A rectangular room between the centre lines of its walls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Room {
    /// What the room is called.
    pub name: String,
    /// Lowest x and y, metres.
    pub min: [f64; 2],
    /// Highest x and y, metres.
    pub max: [f64; 2],
    /// How much texture the room's surfaces carry, relative to an ordinary living room, 0..=4.
    #[serde(default = "default_texture")]
    pub texture: f64,
}

/// An open doorway.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Door {
    /// What the door is called.
    pub name: String,
    /// Its middle on a wall's centre line, x and y, metres.
    pub center: [f64; 2],
    /// Clear width, metres.
    #[serde(default = "default_door_width")]
    pub width: f64,
    /// Clear height, metres; below the room's height.
    #[serde(default = "default_door_height")]
    pub height: f64,
}

/// A box of furniture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Furniture {
    /// Lowest corner, metres.
    pub min: [f64; 3],
    /// Highest corner, metres.
    pub max: [f64; 3],
    /// How much texture it carries, relative to ordinary furniture, 0..=4.
    #[serde(default = "default_texture")]
    pub texture: f64,
}

impl core::str::FromStr for FloorPlan {
    type Err = WorldError;

    /// Reads TOML. Errors: [`WorldError::Syntax`] with the parser's words, and every error of [`FloorPlan::validate`].
    fn from_str(text: &str) -> Result<Self, WorldError> {
        let plan: Self = toml::from_str(text).map_err(|error| WorldError::Syntax {
            reason: error.message().to_owned(),
            line: error.span().map_or(0, |span| line_of(text, span.start)),
        })?;
        plan.validate()?;
        Ok(plan)
    }
}

impl FloorPlan {
    /// Checks every number. Errors name the first thing that is wrong.
    pub fn validate(&self) -> Result<(), WorldError> {
        bounded("height", self.height, 1.5, 20.0)?;
        bounded("wall_thickness", self.wall_thickness, 0.01, 1.0)?;
        if self.rooms.is_empty() {
            return Err(WorldError::NoRooms);
        }
        for room in &self.rooms {
            self.validate_room(room)?;
        }
        for door in &self.doors {
            self.validate_door(door)?;
        }
        for (index, item) in self.furniture.iter().enumerate() {
            validate_furniture(index, item)?;
        }
        bounded("start.yaw_degrees", self.start.yaw_degrees, -1e6, 1e6)?;
        bounded("start.position x", self.start.position[0], -LIMIT, LIMIT)?;
        bounded("start.position y", self.start.position[1], -LIMIT, LIMIT)
    }

    fn validate_room(&self, room: &Room) -> Result<(), WorldError> {
        bounded("rooms.texture", room.texture, 0.0, 4.0)?;
        for axis in 0..2 {
            bounded("rooms.min", room.min[axis], -LIMIT, LIMIT)?;
            bounded("rooms.max", room.max[axis], -LIMIT, LIMIT)?;
            let side = room.max[axis] - room.min[axis];
            if side < 4.0 * self.wall_thickness {
                return Err(WorldError::RoomTooSmall {
                    room: room.name.clone(),
                    side,
                });
            }
        }
        Ok(())
    }

    fn validate_door(&self, door: &Door) -> Result<(), WorldError> {
        bounded("doors.center x", door.center[0], -LIMIT, LIMIT)?;
        bounded("doors.center y", door.center[1], -LIMIT, LIMIT)?;
        bounded("doors.width", door.width, 0.05, 20.0)?;
        bounded("doors.height", door.height, 0.05, self.height)
    }
}

/// Coordinates beyond this are a mistake, metres.
const LIMIT: f64 = 200.0;

fn validate_furniture(index: usize, item: &Furniture) -> Result<(), WorldError> {
    bounded("furniture.texture", item.texture, 0.0, 4.0)?;
    for axis in 0..3 {
        bounded("furniture.min", item.min[axis], -LIMIT, LIMIT)?;
        bounded("furniture.max", item.max[axis], -LIMIT, LIMIT)?;
        if item.max[axis] <= item.min[axis] {
            return Err(WorldError::FlatFurniture { index });
        }
    }
    Ok(())
}

/// Refuses a value outside `low..=high` or not finite.
pub(crate) fn bounded(
    name: &'static str,
    value: f64,
    low: f64,
    high: f64,
) -> Result<(), WorldError> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err(WorldError::OutOfRange {
        name,
        value,
        low,
        high,
    })
}

/// The line, counted from 1, of a byte offset.
fn line_of(text: &str, offset: usize) -> usize {
    1 + text
        .bytes()
        .take(offset)
        .filter(|&byte| byte == b'\n')
        .count()
}

fn default_height() -> f64 {
    2.6
}

fn default_wall_thickness() -> f64 {
    0.1
}

fn default_texture() -> f64 {
    1.0
}

fn default_door_width() -> f64 {
    0.9
}

fn default_door_height() -> f64 {
    2.05
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Door, FloorPlan, Furniture, Room, WorldError};
    use crate::world::World;

    const DEN: &str = "name='den'\n[start]\nposition=[1.0,1.0]\n[[rooms]]\nname='den'\nmin=[0.0,0.0]\nmax=[4.0,3.0]\n";

    #[test]
    fn mistakes_are_named_with_their_line() {
        let letters = DEN.replace("[4.0,3.0]", "[4.0,'x']");
        let Err(WorldError::Syntax { line, .. }) = letters.parse::<FloorPlan>() else {
            panic!("letters must not pass");
        };
        assert_eq!(line, 7);
        let nan = DEN.replace("4.0,3.0", "nan,3.0");
        assert!(matches!(
            nan.parse::<FloorPlan>(),
            Err(WorldError::OutOfRange { .. })
        ));
        let flat = DEN.replace("4.0,3.0", "4.0,0.0");
        assert!(matches!(
            flat.parse::<FloorPlan>(),
            Err(WorldError::RoomTooSmall { .. })
        ));
        let unknown = format!("{DEN}colour='red'\n");
        assert!(matches!(
            unknown.parse::<FloorPlan>(),
            Err(WorldError::Syntax { .. })
        ));
    }

    proptest! {
        #[test]
        fn any_text_is_a_plan_or_an_error(text in "[a-z\\[\\]{}=.,\"0-9 \n-]{0,120}") {
            let _ = text.parse::<FloorPlan>();
            let _ = format!("{DEN}{text}").parse::<FloorPlan>();
        }

        #[test]
        fn any_numbers_make_a_world_or_an_error(
            numbers in prop::collection::vec(-5.0..9.0_f64, 14), flip in any::<bool>()
        ) {
            let mut plan: FloorPlan = DEN.parse().unwrap();
            let pair = |i: usize| [numbers[i], numbers[i + 1]];
            plan.rooms.push(Room { name: "b".into(), min: pair(0), max: pair(2), texture: 1.0 });
            let center = if flip { [4.0, numbers[4]] } else { pair(4) };
            plan.doors.push(Door { name: "d".into(), center, width: numbers[6].abs(), height: 2.0 });
            let triple = |i: usize| [numbers[i], numbers[i + 1], numbers[i + 2]];
            plan.furniture.push(Furniture { min: triple(8), max: triple(11), texture: 0.1 });
            plan.start.position = pair(7);
            if let Ok(world) = World::new(plan, 1) {
                prop_assert!(world.clearance([world.start().position[0], world.start().position[1], 0.1]) >= 0.0);
                let reach = world.reachable(1.0, 0.2, 0.15);
                prop_assert!(reach.cells.iter().all(|&cell| world.clearance(cell) >= 0.15));
            }
        }
    }

    #[test]
    fn a_plan_survives_being_written_and_read() {
        let plan: FloorPlan = DEN.parse().unwrap();
        let text = toml::to_string(&plan).unwrap();
        assert_eq!(text.parse::<FloorPlan>().unwrap(), plan);
    }
}
