//! The worlds are what they claim: reachable, passable, textured on surfaces only, with blank walls.

#![allow(
    clippy::unwrap_used,
    reason = "a broken expectation must fail the test"
)]

use indoor_sim::{FloorPlan, PRESETS, Solid, SolidKind, World, WorldError, coverage};

fn worlds() -> Vec<World> {
    let generated = (0..12).map(|seed| format!("generated:{seed}"));
    let names = PRESETS
        .iter()
        .map(|name| (*name).to_owned())
        .chain(generated);
    names.map(|name| World::named(&name, 5).unwrap()).collect()
}

#[test]
fn a_ball_of_a_quarter_metre_reaches_every_room() {
    for world in worlds() {
        let reach = world.reachable(1.0, 0.1, 0.25);
        for (number, room) in world.rooms().iter().enumerate() {
            let reached = reach
                .cells
                .iter()
                .any(|&cell| world.room_at(cell) == Some(number));
            assert!(reached, "{}: {} is cut off", world.name(), room.name);
        }
    }
}

#[test]
fn a_drone_fits_through_every_door_and_through_no_wall() {
    for world in worlds() {
        for door in world.doors() {
            let [x, y] = door.center;
            let across = [[0.2, 0.0], [0.0, 0.2]].map(|[dx, dy]| {
                world.segment_is_free([x - dx, y - dy, 1.0], [x + dx, y + dy, 1.0], 0.25)
            });
            assert!(across.contains(&true), "{}: {}", world.name(), door.name);
            let lintel = 0.5 * (door.height + world.height());
            let through = world.segment_is_free([x - 0.2, y - 0.2, lintel], [x, y, lintel], 0.05);
            assert!(!through, "{}: no lintel over {}", world.name(), door.name);
        }
        let (low, high) = world.bounds();
        let beyond = [high[0] + 1.0, high[1] + 1.0, 1.0];
        assert!(!world.segment_is_free([low[0] + 0.5, low[1] + 0.5, 1.0], beyond, 0.01));
    }
}

#[test]
fn landmarks_lie_on_the_surface_of_a_solid_and_outside_of_all_others() {
    for world in worlds() {
        assert!(world.landmarks().len() > 5_000, "{}", world.name());
        for landmark in world.landmarks() {
            assert!(world.clearance(landmark.position) < 1e-9);
            let ahead = core::array::from_fn(|a| landmark.position[a] + 0.01 * landmark.normal[a]);
            assert!(world.clearance(ahead) > 0.0, "{landmark:?}");
            let length: f64 = landmark.normal.iter().map(|value| value * value).sum();
            assert!((length - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn nothing_is_seen_through_a_solid() {
    for world in worlds().iter().take(6) {
        let eyes = world.reachable(1.1, 0.9, 0.2).cells;
        for landmark in world.landmarks().iter().step_by(37) {
            for &eye in eyes.iter().step_by(5) {
                if world.sees_landmark(eye, landmark) {
                    let near =
                        core::array::from_fn(|a| landmark.position[a] + 0.002 * landmark.normal[a]);
                    let hidden = |solid: &Solid| solid.enter(eye, near).is_some();
                    assert!(!world.solids().iter().any(hidden), "{eye:?} {landmark:?}");
                }
            }
        }
    }
}

/// Share of the wall, in the middle of either row of panels and looked at from the rooms, that has no landmark within 0.2 m.
fn blank_share(world: &World) -> f64 {
    let (mut blank, mut all) = (0, 0);
    for solid in world
        .solids()
        .iter()
        .filter(|solid| solid.kind == SolidKind::Wall)
    {
        let along = usize::from(solid.max[1] - solid.min[1] > solid.max[0] - solid.min[0]);
        let pieces = ((solid.max[along] - solid.min[along]) / 0.1) as usize;
        for (piece, side) in (0..pieces).flat_map(|piece| [(piece, solid.min), (piece, solid.max)])
        {
            let mut middle = side;
            middle[along] = solid.min[along] + 0.1 * piece as f64 + 0.05;
            middle[2] = if piece % 2 == 0 { 0.7 } else { 1.9 };
            let outward = if side == solid.min { -0.3 } else { 0.3 };
            let mut front = middle;
            front[1 - along] += outward;
            if world.room_at(front).is_none() || world.clearance(front) < 0.1 {
                continue;
            }
            let close = |point: [f64; 3]| {
                (0..3)
                    .map(|axis| (point[axis] - middle[axis]).powi(2))
                    .sum::<f64>()
                    < 0.04
            };
            all += 1;
            blank += usize::from(!world.landmarks().iter().any(|mark| close(mark.position)));
        }
    }
    blank as f64 / all as f64
}

#[test]
fn every_world_has_blank_walls() {
    for world in worlds().iter().take(8) {
        let share = blank_share(world);
        assert!((0.12..0.5).contains(&share), "{}: {share}", world.name());
    }
}

#[test]
fn coverage_counts_what_is_in_sight_and_in_range() {
    let world = World::named("one-door-room", 1).unwrap();
    assert_eq!(coverage(&world, &[], 5.0), 0.0);
    assert_eq!(coverage(&world, &[[f64::NAN; 3]], 5.0), 0.0);
    let room = coverage(&world, &[[2.2, 1.8, 1.0]], 5.0);
    let both = coverage(&world, &[[2.2, 1.8, 1.0], [6.0, 1.8, 1.0]], 5.0);
    assert!(room > 0.5 && room < 0.85 && both > 0.97, "{room} {both}");
    assert!(coverage(&world, &[[2.2, 1.8, 1.0]], 0.5) < 0.1);
}

#[test]
fn plans_with_mistakes_are_refused() {
    let text = "name='a'\n[start]\nposition=[1.0,1.0]\n[[rooms]]\nname='a'\nmin=[0.0,0.0]\nmax=[3.0,3.0]\n";
    let plan: FloorPlan = text.parse().unwrap();
    assert!(World::new(plan.clone(), 0).is_ok());
    let astray = format!("{text}[[doors]]\nname='d'\ncenter=[1.5,1.5]\n");
    let error = World::new(astray.parse().unwrap(), 0).unwrap_err();
    assert!(matches!(error, WorldError::DoorOffWall { .. }), "{error}");
    let wide = format!("{text}[[doors]]\nname='d'\ncenter=[1.5,0.0]\nwidth=9.0\n");
    assert!(matches!(
        World::new(wide.parse().unwrap(), 0),
        Err(WorldError::DoorOffWall { .. })
    ));
    let mut outside = plan.clone();
    outside.start.position = [5.0, 1.0];
    assert!(matches!(
        World::new(outside, 0),
        Err(WorldError::StartBlocked { .. })
    ));
    let mut touching = plan;
    touching.start.position = [0.1, 1.0];
    assert!(matches!(
        World::new(touching, 0),
        Err(WorldError::StartBlocked { .. })
    ));
    for name in ["castle", "generated:", "generated:x", "generated:-1", ""] {
        assert!(
            matches!(World::named(name, 0), Err(WorldError::UnknownName { .. })),
            "{name}"
        );
    }
}
