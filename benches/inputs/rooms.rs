//! Points on the walls and furniture of a row of rooms, as a sparse map has them.

use rand::RngExt;
use rand_pcg::Pcg64;

/// `count` points in textured patches on the walls of rooms of 4.2 x 3.6 x 2.6 m, metres.
pub(crate) fn points(count: usize, seed: u64) -> Vec<[f64; 3]> {
    let mut rng = Pcg64::new(seed.into(), 1);
    let patches: Vec<([f64; 3], usize)> = (0..(count / 40).max(1))
        .map(|_| {
            let room = f64::from(rng.random_range(0..6_i32));
            let mut centre = [4.2, 3.6, 2.6].map(|size| size * rng.random::<f64>());
            let wall = rng.random_range(0..2_usize);
            centre[wall] = if rng.random::<bool>() {
                0.0
            } else {
                [4.2, 3.6][wall]
            };
            centre[0] += 4.2 * room;
            (centre, wall)
        })
        .collect();
    (0..count)
        .map(|i| {
            let (centre, wall) = patches[i % patches.len()];
            std::array::from_fn(|axis| {
                let spread = if axis == wall { 0.03 } else { 0.5 };
                centre[axis] + spread * (rng.random::<f64>() - 0.5)
            })
        })
        .collect()
}

/// `count` motions of this length inside the rooms.
pub(crate) fn motions(count: usize, length: f64, seed: u64) -> Vec<([f64; 3], [f64; 3])> {
    let mut rng = Pcg64::new(seed.into(), 1);
    (0..count)
        .map(|_| {
            let a = [25.2, 3.6, 2.6].map(|size| size * rng.random::<f64>());
            let turn = std::f64::consts::TAU * rng.random::<f64>();
            (
                a,
                [a[0] + length * turn.cos(), a[1] + length * turn.sin(), a[2]],
            )
        })
        .collect()
}
