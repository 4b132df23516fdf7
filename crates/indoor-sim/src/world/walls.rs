//! From a floor plan to solids: walls on room borders, merged where shared, cut by doors.

use super::WorldError;
use super::floor_plan::{Door, FloorPlan};
use super::solid::{Solid, SolidKind};

/// Floor, ceiling, walls, lintels and furniture of a plan, in this order.
pub(crate) fn solids(plan: &FloorPlan) -> Result<Vec<Solid>, WorldError> {
    let mut solids = slabs(plan);
    let lines = border_lines(plan);
    let mut placed = vec![false; plan.doors.len()];
    for line in &lines {
        for &(from, to) in &line.intervals {
            raise_wall(plan, line, from, to, &mut placed, &mut solids);
        }
    }
    if let Some(index) = placed.iter().position(|&done| !done) {
        let Door {
            name,
            center: [x, y],
            ..
        } = &plan.doors[index];
        return Err(WorldError::DoorOffWall {
            door: name.clone(),
            x: *x,
            y: *y,
        });
    }
    solids.extend(plan.furniture.iter().map(|item| Solid {
        min: item.min,
        max: item.max,
        kind: SolidKind::Furniture,
    }));
    Ok(solids)
}

/// A straight line along x (`along` = 0) or y (`along` = 1) at `offset` of the other axis, and where walls stand on it.
struct BorderLine {
    along: usize,
    offset: f64,
    intervals: Vec<(f64, f64)>,
}

/// Offsets closer than this are one line, metres.
const SAME_LINE: f64 = 1e-3;

fn border_lines(plan: &FloorPlan) -> Vec<BorderLine> {
    let mut lines: Vec<BorderLine> = Vec::new();
    for room in &plan.rooms {
        for along in 0..2 {
            let across = 1 - along;
            for offset in [room.min[across], room.max[across]] {
                let interval = (room.min[along], room.max[along]);
                let same = |line: &&mut BorderLine| {
                    line.along == along && (line.offset - offset).abs() < SAME_LINE
                };
                match lines.iter_mut().find(same) {
                    Some(line) => line.intervals.push(interval),
                    None => lines.push(BorderLine {
                        along,
                        offset,
                        intervals: vec![interval],
                    }),
                }
            }
        }
    }
    for line in &mut lines {
        line.intervals = union(&line.intervals);
    }
    lines
}

/// The union of closed intervals, ascending and disjoint.
fn union(intervals: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = intervals.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, f64)> = Vec::new();
    for (from, to) in sorted {
        match merged.last_mut() {
            Some(last) if from <= last.1 + SAME_LINE => last.1 = last.1.max(to),
            _ => merged.push((from, to)),
        }
    }
    merged
}

/// Pushes the wall from `from` to `to`, interrupted by the doors that lie on it.
fn raise_wall(
    plan: &FloorPlan,
    line: &BorderLine,
    from: f64,
    to: f64,
    placed: &mut [bool],
    solids: &mut Vec<Solid>,
) {
    let half = 0.5 * plan.wall_thickness;
    let mut doors: Vec<(f64, f64, f64)> = Vec::new();
    for (index, door) in plan.doors.iter().enumerate() {
        let (middle, offset) = (door.center[line.along], door.center[1 - line.along]);
        let (left, right) = (middle - 0.5 * door.width, middle + 0.5 * door.width);
        let fits = left >= from + half && right <= to - half;
        if (offset - line.offset).abs() < half && fits {
            placed[index] = true;
            doors.push((left, right, door.height));
        }
    }
    doors.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut begin = from - half;
    for (left, right, height) in doors {
        push_wall(plan, line, (begin, left), (0.0, plan.height), solids);
        push_wall(
            plan,
            line,
            (left.max(begin), right),
            (height, plan.height),
            solids,
        );
        begin = right.max(begin);
    }
    push_wall(plan, line, (begin, to + half), (0.0, plan.height), solids);
}

fn push_wall(
    plan: &FloorPlan,
    line: &BorderLine,
    (from, to): (f64, f64),
    (bottom, top): (f64, f64),
    solids: &mut Vec<Solid>,
) {
    if to - from < 1e-6 || top - bottom < 1e-6 {
        return;
    }
    let half = 0.5 * plan.wall_thickness;
    let mut min = [0.0, 0.0, bottom];
    let mut max = [0.0, 0.0, top];
    (min[line.along], max[line.along]) = (from, to);
    (min[1 - line.along], max[1 - line.along]) = (line.offset - half, line.offset + half);
    let kind = if bottom > 0.0 {
        SolidKind::Lintel
    } else {
        SolidKind::Wall
    };
    solids.push(Solid { min, max, kind });
}

/// Floor and ceiling under and over all rooms, 0.2 m thick.
fn slabs(plan: &FloorPlan) -> Vec<Solid> {
    let half = 0.5 * plan.wall_thickness;
    let low: [f64; 2] = core::array::from_fn(|axis| {
        plan.rooms
            .iter()
            .map(|room| room.min[axis])
            .fold(f64::INFINITY, f64::min)
            - half
    });
    let high: [f64; 2] = core::array::from_fn(|axis| {
        plan.rooms
            .iter()
            .map(|room| room.max[axis])
            .fold(f64::NEG_INFINITY, f64::max)
            + half
    });
    let slab = |bottom: f64, top: f64, kind| Solid {
        min: [low[0], low[1], bottom],
        max: [high[0], high[1], top],
        kind,
    };
    vec![
        slab(-0.2, 0.0, SolidKind::Floor),
        slab(plan.height, plan.height + 0.2, SolidKind::Ceiling),
    ]
}

#[cfg(test)]
mod tests {
    use super::union;

    #[test]
    fn shared_borders_become_one_wall() {
        let merged = union(&[(4.0, 8.0), (0.0, 4.0), (1.0, 2.0), (9.0, 10.0)]);
        assert_eq!(merged, vec![(0.0, 8.0), (9.0, 10.0)]);
    }
}
