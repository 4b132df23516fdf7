//! Random worlds of discs in a square of 20 with free corners, and the exact check of a motion among them.

use rand::RngExt;
use rand_pcg::Pcg64;

/// Centres and radii.
pub(crate) type World = Vec<([f64; 2], f64)>;

/// 55 discs of radius 0.5 to 1.2 that leave (0.5, 0.5) and (19.5, 19.5) free.
pub(crate) fn discs(seed: u128) -> World {
    let mut rng = Pcg64::new(seed, 17);
    let mut discs = Vec::new();
    while discs.len() < 55 {
        let centre: [f64; 2] = std::array::from_fn(|_| 20.0 * rng.random::<f64>());
        let radius = 0.5 + 0.7 * rng.random::<f64>();
        let far = |corner: f64| (centre[0] - corner).hypot(centre[1] - corner) > radius + 0.3;
        if far(0.5) && far(19.5) {
            discs.push((centre, radius));
        }
    }
    discs
}

/// Whether the motion of a point stays outside all discs.
pub(crate) fn is_free(discs: &[([f64; 2], f64)], a: &[f64; 2], b: &[f64; 2]) -> bool {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let squared = (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
    discs.iter().all(|(centre, radius)| {
        let t = ((centre[0] - a[0]) * dx + (centre[1] - a[1]) * dy) / squared;
        let t = t.clamp(0.0, 1.0);
        let (gap_x, gap_y) = (a[0] + t * dx - centre[0], a[1] + t * dy - centre[1]);
        gap_x * gap_x + gap_y * gap_y >= radius * radius
    })
}
