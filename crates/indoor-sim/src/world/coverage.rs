//! How much of the reachable space somebody has seen.

use super::World;

/// Side of a grid cell, metres.
const RESOLUTION: f64 = 0.15;

/// Radius of the ball that must reach a cell: the drone's body of 0.10 m and a margin of 0.05 m.
const BALL: f64 = 0.15;

/// Share of the reachable cells at `height` that some position sees: within `max_range` metres and with nothing solid
/// between. 0 without positions or reachable cells. Positions that are not finite see nothing.
///
/// Science: "coverage of reachable free area seen within 5 m from the scan positions" is the usual figure.
/// Cost: cells × positions ray casts at worst; a cell that was seen is not tested again.
#[must_use]
pub fn coverage(world: &World, positions: &[[f64; 3]], max_range: f64) -> f64 {
    let reach = world.reachable(FLYING_HEIGHT.min(0.5 * world.height()), RESOLUTION, BALL);
    if reach.cells.is_empty() {
        return 0.0;
    }
    let seen = reach
        .cells
        .iter()
        .filter(|&&cell| is_seen(world, positions, max_range, cell))
        .count();
    seen as f64 / reach.cells.len() as f64
}

/// Height of the cells' centres, metres: where the drone hovers after take-off.
pub(crate) const FLYING_HEIGHT: f64 = 1.0;

fn is_seen(world: &World, positions: &[[f64; 3]], max_range: f64, cell: [f64; 3]) -> bool {
    positions.iter().any(|&position| {
        let squared: f64 = (0..3)
            .map(|axis| (position[axis] - cell[axis]).powi(2))
            .sum();
        squared <= max_range * max_range && world.sees(position, cell)
    })
}
