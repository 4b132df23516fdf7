//! Is there an edge? The seen range against the wall beside the opening, continued.
//!
//! A plane wall at distance d in direction φ has inverse range u(θ) = cos(θ − φ) / d: nearly linear
//! in θ over a few degrees. The wall beside an edge is fitted by the median slope of its inverse
//! ranges (Theil–Sen) and continued across the edge; at the far end of a long room the continued wall
//! meets what was seen, at a door it does not.

use crate::profile::median;

/// The inverse range that the wall on one side predicts at `target` (in bins from the edge, negative
/// inside), or `None` with fewer than two known bins.
///
/// `wall[k]` is the range k bins outside the edge.
pub(super) fn continued_wall(wall: &[Option<f64>], target: f64) -> Option<f64> {
    let known: Vec<(f64, f64)> = wall
        .iter()
        .enumerate()
        .filter_map(|(k, range)| range.map(|range| (k as f64 + 0.5, 1.0 / range)))
        .collect();
    let mut slopes: Vec<f64> = Vec::new();
    for (i, a) in known.iter().enumerate() {
        for b in known.iter().skip(i + 1 + known.len() / 3) {
            slopes.push((b.1 - a.1) / (b.0 - a.0));
        }
    }
    let slope = median(&mut slopes)?;
    let mut offsets: Vec<f64> = known.iter().map(|(k, u)| u - slope * k).collect();
    Some(median(&mut offsets)? + slope * target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_continues_along_itself() {
        // Wall y = 1 seen from the origin, bins of one degree starting at 20 degrees and going up.
        let wall: Vec<Option<f64>> = (0..15)
            .map(|k| Some(1.0 / (20.5 + f64::from(k)).to_radians().sin()))
            .collect();
        let u = continued_wall(&wall, -5.0).unwrap();
        assert!((u - 15f64.to_radians().sin()).abs() < 0.01);
        assert_eq!(continued_wall(&[Some(1.0)], -1.0), None);
        assert_eq!(continued_wall(&[], -1.0), None);
    }
}
