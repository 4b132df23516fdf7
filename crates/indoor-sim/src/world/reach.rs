//! Which places a ball can reach from the start, on a grid at one height.

use super::World;

/// A grid of free, reachable places at one height.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    /// Centres of the reachable cells, metres, row by row.
    pub cells: Vec<[f64; 3]>,
    /// Side of a cell, metres.
    pub resolution: f64,
    /// Radius of the ball, metres.
    pub radius: f64,
}

/// Cells whose centre a ball of `radius` can occupy at `height` and reach from the start through neighbouring cells
/// (four neighbours). Empty when the ball does not fit at the start. Cost: one clearance query per cell.
pub(crate) fn reachable(world: &World, height: f64, resolution: f64, radius: f64) -> Reach {
    let grid = Grid::new(world, height, resolution);
    let free: Vec<bool> = (0..grid.len())
        .map(|cell| world.clearance(grid.center(cell)) >= radius)
        .collect();
    let mut seen = vec![false; grid.len()];
    let start = grid.nearest([world.start().position[0], world.start().position[1]]);
    let mut open = Vec::new();
    if free[start] {
        seen[start] = true;
        open.push(start);
    }
    while let Some(cell) = open.pop() {
        for next in grid.neighbours(cell).into_iter().flatten() {
            if free[next] && !seen[next] {
                seen[next] = true;
                open.push(next);
            }
        }
    }
    let cells = (0..grid.len())
        .filter(|&cell| seen[cell])
        .map(|cell| grid.center(cell))
        .collect();
    Reach {
        cells,
        resolution: grid.resolution,
        radius,
    }
}

/// A grid has no more cells than this.
const MOST_CELLS: f64 = 4e6;

struct Grid {
    low: [f64; 2],
    columns: usize,
    rows: usize,
    height: f64,
    resolution: f64,
}

impl Grid {
    fn new(world: &World, height: f64, resolution: f64) -> Self {
        let (low, high) = world.bounds();
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        let resolution = resolution.max((area / MOST_CELLS).sqrt());
        let count = |axis: usize| (((high[axis] - low[axis]) / resolution).floor() as usize).max(1);
        Self {
            low: [low[0], low[1]],
            columns: count(0),
            rows: count(1),
            height,
            resolution,
        }
    }

    fn len(&self) -> usize {
        self.columns * self.rows
    }

    fn center(&self, cell: usize) -> [f64; 3] {
        let (column, row) = (cell % self.columns, cell / self.columns);
        [
            self.low[0] + (column as f64 + 0.5) * self.resolution,
            self.low[1] + (row as f64 + 0.5) * self.resolution,
            self.height,
        ]
    }

    fn nearest(&self, point: [f64; 2]) -> usize {
        let at = |axis: usize, count: usize| {
            (((point[axis] - self.low[axis]) / self.resolution).max(0.0) as usize).min(count - 1)
        };
        at(1, self.rows) * self.columns + at(0, self.columns)
    }

    fn neighbours(&self, cell: usize) -> [Option<usize>; 4] {
        let (column, row) = (cell % self.columns, cell / self.columns);
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < self.columns).then_some(cell + 1),
            (row > 0).then(|| cell - self.columns),
            (row + 1 < self.rows).then_some(cell + self.columns),
        ]
    }
}
