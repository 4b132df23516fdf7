//! Draws floor plans: rooms on both sides of a corridor, doors, furniture that leaves every room reachable.

use rand::{Rng, RngExt};

use super::floor_plan::{Door, FloorPlan, Furniture, Room, Start};
use super::{FLYING_HEIGHT, World, WorldError};
use crate::random::{Purpose, stream, uniform};

/// A floor plan for a seed: a corridor 7 to 14 m long and 1.4 to 2 m wide with two to four rooms on each side, each with
/// a door to the corridor, some with a second one to a neighbour, and furniture. A ball of 0.25 m reaches every room at
/// a height of 1 m.
///
/// # Errors
/// None is known for any seed; the checks of [`FloorPlan::validate`] are passed on.
pub fn generate(seed: u64) -> Result<FloorPlan, WorldError> {
    let mut rng = stream(seed, Purpose::Layout);
    let mut plan = empty_plan(seed, &mut rng);
    furnish(&mut plan, &mut rng)?;
    if rng.random::<bool>() {
        swap_axes(&mut plan);
    }
    plan.validate()?;
    Ok(plan)
}

/// The ball that must reach every room, metres.
const BALL: f64 = 0.25;

/// Gap between furniture and a wall's centre line, metres.
const GAP: f64 = 0.06;

fn empty_plan(seed: u64, rng: &mut impl Rng) -> FloorPlan {
    let length = uniform(rng, 7.0, 14.0);
    let width = uniform(rng, 1.4, 2.0);
    let south = uniform(rng, 2.8, 4.4);
    let north = uniform(rng, 2.8, 4.4);
    let mut plan = FloorPlan {
        name: format!("generated:{seed}"),
        height: uniform(rng, 2.4, 3.0),
        wall_thickness: 0.1,
        start: Start {
            position: [0.0, 0.0],
            yaw_degrees: 0.0,
        },
        rooms: vec![Room {
            name: "corridor".to_owned(),
            min: [0.0, south],
            max: [length, south + width],
            texture: uniform(rng, 0.9, 1.4),
        }],
        doors: Vec::new(),
        furniture: Vec::new(),
    };
    add_row(&mut plan, rng, (0.0, south), south, "south");
    add_row(
        &mut plan,
        rng,
        (south + width, south + width + north),
        south + width,
        "north",
    );
    place_start(&mut plan, rng);
    plan
}

/// A row of rooms along the corridor, from `low` to `high` in y; `border` is the corridor's side.
fn add_row(
    plan: &mut FloorPlan,
    rng: &mut impl Rng,
    (low, high): (f64, f64),
    border: f64,
    side: &str,
) {
    let length = plan.rooms[0].max[0];
    let most = (length / 2.8).floor().clamp(2.0, 4.0);
    let count = uniform(rng, 2.0, most + 1.0).floor().min(most) as usize;
    let weights: Vec<f64> = (0..count).map(|_| uniform(rng, 0.8, 1.2)).collect();
    let total: f64 = weights.iter().sum();
    let mut from = 0.0;
    for (number, weight) in weights.iter().enumerate() {
        let to = if number + 1 == count {
            length
        } else {
            from + length * weight / total
        };
        let name = format!("{side} room {}", number + 1);
        if number > 0 && rng.random::<f64>() < 0.25 {
            let between = format!("{side} room {number} - {name}");
            let y = uniform(rng, low + 0.8, high - 0.8);
            plan.doors.push(draw_door(between, [from, y], rng));
        }
        let x = uniform(rng, from + 0.7, to - 0.7);
        plan.doors
            .push(draw_door(format!("{name} - corridor"), [x, border], rng));
        let texture = uniform(rng, 0.9, 1.7);
        plan.rooms.push(Room {
            name,
            min: [from, low],
            max: [to, high],
            texture,
        });
        from = to;
    }
}

fn draw_door(name: String, center: [f64; 2], rng: &mut impl Rng) -> Door {
    Door {
        name,
        center,
        width: uniform(rng, 0.8, 1.0),
        height: 2.05,
    }
}

/// The middle of one of the rooms, looking along an axis.
fn place_start(plan: &mut FloorPlan, rng: &mut impl Rng) {
    let number = rng.random_range(1..plan.rooms.len());
    let room = &plan.rooms[number];
    let position = core::array::from_fn(|axis| 0.5 * (room.min[axis] + room.max[axis]));
    let yaw_degrees = 90.0 * f64::from(rng.random_range(0..4_u8));
    plan.start = Start {
        position,
        yaw_degrees,
    };
}

/// Two to six pieces in each room; a piece that stands in a doorway, on the start or cuts off a room is taken away again.
fn furnish(plan: &mut FloorPlan, rng: &mut impl Rng) -> Result<(), WorldError> {
    for number in 1..plan.rooms.len() {
        let pieces = rng.random_range(2..=6_u8);
        for _ in 0..pieces {
            let item = draw_furniture(&plan.rooms[number], rng);
            if stands_in_the_way(plan, &item) {
                continue;
            }
            plan.furniture.push(item);
            if !every_room_is_reached(plan)? {
                plan.furniture.pop();
            }
        }
    }
    Ok(())
}

/// A box, most often against a wall.
fn draw_furniture(room: &Room, rng: &mut impl Rng) -> Furniture {
    let heights = [0.45, 0.75, 1.1, 1.9];
    let height = heights[rng.random_range(0..heights.len())];
    let mut min = [0.0; 3];
    let mut max = [0.0, 0.0, height];
    let against = rng.random_range(0..5_u8);
    for axis in 0..2 {
        let (low, high) = (room.min[axis] + GAP, room.max[axis] - GAP);
        let size = uniform(rng, 0.4, 1.5).min(0.4 * (high - low));
        min[axis] = match (against, axis) {
            (0, 0) | (2, 1) => low,
            (1, 0) | (3, 1) => high - size,
            _ => uniform(rng, low, high - size),
        };
        max[axis] = min[axis] + size;
    }
    Furniture {
        min,
        max,
        texture: uniform(rng, 0.5, 1.5),
    }
}

fn stands_in_the_way(plan: &FloorPlan, item: &Furniture) -> bool {
    let near = |point: [f64; 2], margin: f64| {
        (0..2).all(|axis| {
            item.min[axis] - margin < point[axis] && point[axis] < item.max[axis] + margin
        })
    };
    let overlaps = plan.furniture.iter().any(|other| {
        (0..2).all(|axis| item.min[axis] < other.max[axis] && other.min[axis] < item.max[axis])
    });
    overlaps
        || near(plan.start.position, 0.9)
        || plan
            .doors
            .iter()
            .any(|door| near(door.center, 0.5 * door.width + 0.4))
}

/// Whether the ball reaches some place in each room.
fn every_room_is_reached(plan: &FloorPlan) -> Result<bool, WorldError> {
    let world = World::untextured(plan.clone())?;
    let reach = world.reachable(FLYING_HEIGHT, 0.15, BALL);
    let mut reached = vec![false; plan.rooms.len()];
    for &cell in &reach.cells {
        if let Some(room) = world.room_at(cell) {
            reached[room] = true;
        }
    }
    Ok(reached.into_iter().all(|done| done))
}

fn swap_axes(plan: &mut FloorPlan) {
    for room in &mut plan.rooms {
        room.min.swap(0, 1);
        room.max.swap(0, 1);
    }
    for door in &mut plan.doors {
        door.center.swap(0, 1);
    }
    for item in &mut plan.furniture {
        item.min.swap(0, 1);
        item.max.swap(0, 1);
    }
    plan.start.position.swap(0, 1);
}
