//! Rays that pass a point: how many end well behind it, and how many well before it?
//!
//! A ray from camera c to a point q that c sees proves the space before q free, and hides what is behind. A point v
//! that c does not see, within `angle` of the ray, stands in free space with |cq| > margin |cv|: a violation. With
//! |cv| > margin |cq| it is hidden.
//! Cost: a few nanoseconds for each tested camera and point that is not in its picture, the rays in
//! nine cells of a grid for each that is; the cameras are capped.

use super::config::RayConfig;
use super::sight::Sight;
use crate::points::{Cloud, squared_distance};

/// What the rays of cameras that do not see a point say of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct PassingRays {
    /// Rays that end well behind it.
    pub(super) violating: u32,
    /// Rays that end well before it; 0 if they were not asked for.
    pub(super) hiding: u32,
}

/// The rays that pass each point. Not to ask for those that hide it costs less.
pub(super) fn passing_rays(
    cloud: &Cloud,
    sight: &Sight<'_>,
    config: &RayConfig,
    hiding: bool,
) -> Vec<PassingRays> {
    let mut passing = vec![PassingRays::default(); cloud.len()];
    let cameras = sight.cameras.len();
    let used = cameras.min(config.max_cameras);
    for camera in (0..used).map(|i| i * cameras / used) {
        count_for_camera((cloud, sight, config), camera, hiding, &mut passing);
    }
    passing
}

fn count_for_camera(
    (cloud, sight, config): (&Cloud, &Sight<'_>, &RayConfig),
    camera: usize,
    hiding: bool,
    passing: &mut [PassingRays],
) {
    let seen = &sight.seen[camera];
    let ray = |&q: &u32| {
        let (direction, length) = sight.bearing(cloud, camera, q as usize);
        Ray { direction, length }
    };
    let rays: Vec<Ray> = seen.iter().map(ray).collect();
    let chord = 2.0 * (config.angle / 2.0).sin();
    let picture = Picture::new(&rays, chord);
    let mut sees = seen.iter().peekable();
    for (v, passing) in passing.iter_mut().enumerate() {
        if sees.next_if(|&&q| q as usize == v).is_some() {
            continue;
        }
        let (direction, range) = sight.bearing(cloud, camera, v);
        let enough = config.margin * range;
        let hides = |length: f64| hiding && range > config.margin * length;
        let Some(cell) = picture.cell(direction) else {
            continue;
        };
        if picture.longest[cell] <= enough && !hides(picture.shortest[cell]) {
            continue;
        }
        for ray in picture.around(cell).flatten() {
            if squared_distance(direction, ray.direction) <= chord * chord {
                passing.violating += u32::from(ray.length > enough);
                passing.hiding += u32::from(hides(ray.length));
            }
        }
    }
}

#[derive(Clone, Copy)]
struct Ray {
    direction: [f64; 3],
    length: f64,
}

/// A camera's rays by where they cross a plane across their mean direction.
///
/// Projection along that mean brings no two directions farther apart: all rays within one cell's side
/// of a direction lie in its cell or in those around it. A margin of two cells
/// surrounds the rays, so that every cell near one has all its neighbours.
struct Picture {
    axes: [[f64; 3]; 2],
    corner: [f64; 2],
    side: f64,
    /// Columns and rows.
    size: [usize; 2],
    /// Where the rays of each cell start, row by row; one more marks the end.
    start: Vec<usize>,
    /// The length of the longest ray in each cell and those around it.
    longest: Vec<f64>,
    /// That of the shortest.
    shortest: Vec<f64>,
    rays: Vec<Ray>,
}

impl Picture {
    /// Cells of side `reach` at least, and not many more than there are rays.
    fn new(rays: &[Ray], reach: f64) -> Self {
        let mut picture = Self::empty(rays, reach);
        let cells: Vec<usize> = rays
            .iter()
            .filter_map(|ray| picture.cell(ray.direction))
            .collect();
        for &cell in &cells {
            picture.start[cell + 1] += 1;
        }
        for cell in 1..picture.start.len() {
            picture.start[cell] += picture.start[cell - 1];
        }
        let mut order: Vec<usize> = (0..cells.len()).collect();
        order.sort_unstable_by_key(|&i| cells[i]);
        picture.rays = order.into_iter().map(|i| rays[i]).collect();
        for (&cell, ray) in cells.iter().zip(rays) {
            for row in [cell - picture.size[0], cell, cell + picture.size[0]] {
                for near in row - 1..row + 2 {
                    picture.longest[near] = picture.longest[near].max(ray.length);
                    picture.shortest[near] = picture.shortest[near].min(ray.length);
                }
            }
        }
        picture
    }

    /// The grid that holds the rays, without them.
    fn empty(rays: &[Ray], reach: f64) -> Self {
        let axes = across(rays);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for ray in rays {
            let [x, y] = axes.map(|axis| dot(axis, ray.direction));
            (low, high) = (
                [low[0].min(x), low[1].min(y)],
                [high[0].max(x), high[1].max(y)],
            );
        }
        let extent = [high[0] - low[0], high[1] - low[1]].map(|extent| extent.max(0.0));
        let least = extent[0].max(extent[1]) / (2.0 * (rays.len() as f64).sqrt() + 1.0);
        let side = (reach * (1.0 + ROUNDING) + ROUNDING).max(least);
        let size = extent.map(|extent| (extent / side) as usize + 6);
        let cells = size[0] * size[1];
        Self {
            axes,
            corner: low.map(|x| x - 2.5 * side),
            side,
            size,
            start: vec![0; cells + 1],
            longest: vec![0.0; cells],
            shortest: vec![f64::INFINITY; cells],
            rays: Vec::new(),
        }
    }

    /// The cell of a direction, unless it is far from every ray.
    #[inline]
    fn cell(&self, direction: [f64; 3]) -> Option<usize> {
        let at = |a: usize| (dot(self.axes[a], direction) - self.corner[a]) / self.side;
        let (column, row) = (at(0), at(1));
        let inside = column >= 0.0 && row >= 0.0;
        let (column, row) = (column as usize, row as usize);
        (inside && column < self.size[0] && row < self.size[1])
            .then_some(row * self.size[0] + column)
    }

    /// The rays in a cell and those around it, a row of cells at a time.
    #[inline]
    fn around(&self, cell: usize) -> impl Iterator<Item = &[Ray]> {
        let rows = [cell - self.size[0], cell, cell + self.size[0]];
        rows.into_iter()
            .map(|row| &self.rays[self.start[row - 1]..self.start[row + 2]])
    }
}

/// Two unit vectors across the mean direction of the rays and each other.
fn across(rays: &[Ray]) -> [[f64; 3]; 2] {
    let mean = [0, 1, 2].map(|axis| rays.iter().map(|ray| ray.direction[axis]).sum::<f64>());
    let length = dot(mean, mean).sqrt();
    if length <= 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    }
    let [x, y, z] = mean.map(|side| side / length);
    // Duff et al., "Building an orthonormal basis, revisited", JCGT 2017.
    let sign = 1.0_f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [
        [1.0 + sign * x * x * a, sign * b, -sign * x],
        [b, sign + y * y * a, -y],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// More than rounding moves a projected direction.
const ROUNDING: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::Views;
    use proptest::prelude::*;

    /// The definition, ray by ray.
    fn by_definition(
        cloud: &Cloud,
        sight: &Sight<'_>,
        config: &RayConfig,
        hiding: bool,
    ) -> Vec<PassingRays> {
        let chord = 2.0 * (config.angle / 2.0).sin();
        let mut passing = vec![PassingRays::default(); cloud.len()];
        for (camera, seen) in sight.seen.iter().enumerate() {
            for v in (0..cloud.len()).filter(|&v| !seen.contains(&(v as u32))) {
                let (direction, range) = sight.bearing(cloud, camera, v);
                for &q in seen {
                    let (ray, length) = sight.bearing(cloud, camera, q as usize);
                    let near = squared_distance(direction, ray) <= chord * chord;
                    let before = near && range > config.margin * length;
                    passing[v].violating += u32::from(near && length > config.margin * range);
                    passing[v].hiding += u32::from(hiding && before);
                }
            }
        }
        passing
    }

    proptest! {
        #[test]
        fn counts_equal_the_definition(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..120),
            cameras in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..4),
            (flat, at_camera, hiding) in any::<(bool, bool, bool)>(),
            angle in prop::sample::select(vec![1e-4, 0.01, 0.05, 0.3, 0.99]),
            seen in prop::collection::vec(0..6usize, 120),
        ) {
            let squash = |p: [f64; 3]| [p[0], 0.1 * p[1], if flat { 1.0 } else { p[2] }];
            let mut points: Vec<[f64; 3]> = points.into_iter().map(squash).collect();
            if at_camera {
                points.push(cameras[0]);
            }
            let rows: Vec<Vec<usize>> = (0..points.len())
                .map(|v| (0..cameras.len()).filter(|&c| seen[v % 120] % 3 > c).collect())
                .collect();
            let views = Views::new(cameras, rows).unwrap();
            let cloud = Cloud::new(&points).ok().unwrap();
            let config = RayConfig { angle, margin: 1.1, ..RayConfig::default() };
            if let Some(sight) = Sight::new(&cloud, &views).unwrap() {
                let found = passing_rays(&cloud, &sight, &config, hiding);
                prop_assert_eq!(found, by_definition(&cloud, &sight, &config, hiding));
            }
        }
    }
}
