//! A grid over the floor's plane that finds the solids a ray can meet.

use super::solid::{Solid, SolidKind};

/// Solids by grid cell. Floor and ceiling cover every cell and are kept apart.
#[derive(Debug, Clone)]
pub(crate) struct SolidIndex {
    origin: [f64; 2],
    columns: usize,
    rows: usize,
    cells: Vec<Vec<u32>>,
    everywhere: Vec<u32>,
}

/// Side of a cell, metres.
const CELL: f64 = 0.5;

impl SolidIndex {
    pub(crate) fn new(solids: &[Solid]) -> Self {
        let (low, high) = extent(solids);
        let columns = (((high[0] - low[0]) / CELL).ceil() as usize).max(1);
        let rows = (((high[1] - low[1]) / CELL).ceil() as usize).max(1);
        let mut index = Self {
            origin: low,
            columns,
            rows,
            cells: vec![Vec::new(); columns * rows],
            everywhere: Vec::new(),
        };
        for (number, solid) in solids.iter().enumerate() {
            index.insert(number as u32, solid);
        }
        index
    }

    fn insert(&mut self, number: u32, solid: &Solid) {
        if matches!(solid.kind, SolidKind::Floor | SolidKind::Ceiling) {
            self.everywhere.push(number);
            return;
        }
        let [x0, y0] = self.cell_of([solid.min[0] - 1e-6, solid.min[1] - 1e-6]);
        let [x1, y1] = self.cell_of([solid.max[0] + 1e-6, solid.max[1] + 1e-6]);
        for y in y0..=y1 {
            for x in x0..=x1 {
                self.cells[y * self.columns + x].push(number);
            }
        }
    }

    /// The cell of a point, points outside clamped to the border.
    fn cell_of(&self, point: [f64; 2]) -> [usize; 2] {
        let clamp = |value: f64, count: usize| (value.max(0.0) as usize).min(count - 1);
        [
            clamp((point[0] - self.origin[0]) / CELL, self.columns),
            clamp((point[1] - self.origin[1]) / CELL, self.rows),
        ]
    }

    /// Share of the way at which the segment first meets a solid, and which one. The segment must start inside the
    /// grid's extent; parts outside are checked against the border cells only.
    pub(crate) fn first_hit(
        &self,
        solids: &[Solid],
        start: [f64; 3],
        end: [f64; 3],
    ) -> Option<(f64, usize)> {
        let mut best: Option<(f64, usize)> = None;
        let consider = |numbers: &[u32], best: &mut Option<(f64, usize)>| {
            for &number in numbers {
                let number = number as usize;
                if let Some(t) = solids[number].enter(start, end)
                    && best.is_none_or(|(nearest, _)| t < nearest)
                {
                    *best = Some((t, number));
                }
            }
        };
        consider(&self.everywhere, &mut best);
        for (cell, exit) in self.walk(start, end) {
            consider(&self.cells[cell], &mut best);
            if best.is_some_and(|(t, _)| t <= exit) {
                break;
            }
        }
        best
    }

    /// The cells under the segment in order, each with the share of the way where the segment leaves it.
    fn walk(&self, start: [f64; 3], end: [f64; 3]) -> Walk {
        let first = self.cell_of([start[0], start[1]]);
        let last = self.cell_of([end[0], end[1]]);
        let mut step = [0_isize; 2];
        let mut next = [f64::INFINITY; 2];
        let mut stride = [f64::INFINITY; 2];
        for axis in 0..2 {
            let delta = end[axis] - start[axis];
            if first[axis] == last[axis] || delta == 0.0 {
                continue;
            }
            step[axis] = if delta > 0.0 { 1 } else { -1 };
            let ahead = first[axis] as f64 + if delta > 0.0 { 1.0 } else { 0.0 };
            next[axis] = (self.origin[axis] + ahead * CELL - start[axis]) / delta;
            stride[axis] = CELL / delta.abs();
        }
        Walk {
            columns: self.columns,
            rows: self.rows,
            at: Some(first),
            last,
            step,
            next,
            stride,
        }
    }
}

/// A walk through the grid along a segment (Amanatides and Woo 1987).
struct Walk {
    columns: usize,
    rows: usize,
    at: Option<[usize; 2]>,
    last: [usize; 2],
    step: [isize; 2],
    next: [f64; 2],
    stride: [f64; 2],
}

impl Iterator for Walk {
    type Item = (usize, f64);

    fn next(&mut self) -> Option<Self::Item> {
        let at = self.at?;
        let axis = usize::from(self.next[1] < self.next[0]);
        let exit = self.next[axis];
        self.at = None;
        if at != self.last && exit <= 1.0 {
            let moved = at[axis].checked_add_signed(self.step[axis]);
            let limit = [self.columns, self.rows][axis];
            if let Some(moved) = moved.filter(|&value| value < limit) {
                let mut following = at;
                following[axis] = moved;
                self.at = Some(following);
                self.next[axis] += self.stride[axis];
            }
        }
        Some((
            at[1] * self.columns + at[0],
            if self.at.is_some() { exit } else { 1.0 },
        ))
    }
}

/// Lowest and highest x and y of all solids; a unit square at the origin without any.
fn extent(solids: &[Solid]) -> ([f64; 2], [f64; 2]) {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for solid in solids {
        for axis in 0..2 {
            low[axis] = low[axis].min(solid.min[axis]);
            high[axis] = high[axis].max(solid.max[axis]);
        }
    }
    if solids.is_empty() {
        ([0.0; 2], [1.0; 2])
    } else {
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Solid, SolidIndex, SolidKind};

    fn solid() -> impl Strategy<Value = Solid> {
        (
            [0.0..9.0_f64, 0.0..9.0_f64, 0.0..2.0_f64],
            [0.05..3.0_f64, 0.05..3.0_f64, 0.05..2.0_f64],
        )
            .prop_map(|(min, size)| Solid {
                min,
                max: core::array::from_fn(|axis| min[axis] + size[axis]),
                kind: SolidKind::Furniture,
            })
    }

    fn point() -> impl Strategy<Value = [f64; 3]> {
        [0.0..10.0_f64, 0.0..10.0_f64, 0.0..3.0_f64]
    }

    proptest! {
        #[test]
        fn the_grid_finds_the_same_first_hit_as_testing_every_solid(
            mut solids in prop::collection::vec(solid(), 1..12), a in point(), b in point()
        ) {
            let min = [0.0, 0.0, -0.2];
            solids.push(Solid { min, max: [12.0, 12.0, 0.0], kind: SolidKind::Floor });
            let index = SolidIndex::new(&solids);
            let brute = solids.iter().filter_map(|solid| solid.enter(a, b)).min_by(f64::total_cmp);
            prop_assert_eq!(index.first_hit(&solids, a, b).map(|(t, _)| t), brute);
        }
    }
}
