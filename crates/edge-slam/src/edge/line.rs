//! Straight pieces of edge chains: Douglas-Peucker splitting and total least squares.

use super::EdgePoint;

/// A straight line fitted to part of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSegment {
    /// First end, the first point's foot on the line, pixels.
    pub start: [f64; 2],
    /// Other end.
    pub end: [f64; 2],
    /// Unit direction from start to end.
    pub direction: [f64; 2],
    /// Root mean square distance of the points from the line, pixels.
    pub rms: f64,
    /// How many points support it.
    pub points: usize,
}

impl LineSegment {
    /// Distance of the ends, pixels.
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.end[0] - self.start[0]).hypot(self.end[1] - self.start[1])
    }
}

/// Ranges of a chain that stay within `tolerance` pixels of the chord of their ends (Douglas & Peucker 1973),
/// in order; neighbours share their end point. Fewer than two points give no range. Cost: O(n log n) usually.
#[must_use]
pub fn split_chain(points: &[EdgePoint], tolerance: f64) -> Vec<core::ops::Range<usize>> {
    let mut ranges = Vec::new();
    if points.len() < 2 {
        return ranges;
    }
    let mut stack = vec![(0, points.len() - 1)];
    while let Some((first, last)) = stack.pop() {
        let farthest = (first + 1..last)
            .map(|k| (chord_distance(&points[k], &points[first], &points[last]), k))
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        match farthest {
            Some((distance, k)) if distance > tolerance => {
                stack.push((k, last));
                stack.push((first, k));
            }
            _ => ranges.push(first..last + 1),
        }
    }
    ranges
}

/// Distance of p from the stretch between a and b.
fn chord_distance(p: &EdgePoint, a: &EdgePoint, b: &EdgePoint) -> f64 {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let (x, y) = (p.x - a.x, p.y - a.y);
    let square = dx * dx + dy * dy;
    // The chord ends: a chain that turns back lies beside the line through its ends, but not on the chord.
    let share = ((x * dx + y * dy) / square.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (x - share * dx).hypot(y - share * dy)
}

/// The line with the least sum of squared distances from the points; `None` for fewer than two distinct ones.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "chains are short")]
pub fn fit_line(points: &[EdgePoint]) -> Option<LineSegment> {
    let (first, last) = (points.first()?, points.last()?);
    let n = points.len() as f64;
    let (cx, cy) = (
        points.iter().map(|p| p.x).sum::<f64>() / n,
        points.iter().map(|p| p.y).sum::<f64>() / n,
    );
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in points {
        xx += (p.x - cx) * (p.x - cx);
        xy += (p.x - cx) * (p.y - cy);
        yy += (p.y - cy) * (p.y - cy);
    }
    if !(xx + yy > 1e-12) {
        return None;
    }
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (mut dy, mut dx) = angle.sin_cos();
    if (last.x - first.x) * dx + (last.y - first.y) * dy < 0.0 {
        (dx, dy) = (-dx, -dy);
    }
    let least = 0.5 * (xx + yy - (xx - yy).hypot(2.0 * xy));
    let foot = |p: &EdgePoint| {
        let along = (p.x - cx) * dx + (p.y - cy) * dy;
        [cx + along * dx, cy + along * dy]
    };
    Some(LineSegment {
        start: foot(first),
        end: foot(last),
        direction: [dx, dy],
        rms: (least.max(0.0) / n).sqrt(),
        points: points.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(x: f64, y: f64) -> EdgePoint {
        EdgePoint {
            x,
            y,
            normal: [1.0, 0.0],
            strength: 1.0,
        }
    }

    proptest! {
        #[test]
        fn exact_lines_are_found(angle in -3.1..3.1f64, offset in -50.0..50.0f64, n in 2u32..60) {
            let (sin, cos) = angle.sin_cos();
            let points: Vec<_> = (0..n).map(|k| {
                let s = f64::from(k);
                point(s * cos - offset * sin, s * sin + offset * cos)
            }).collect();
            let line = fit_line(&points).unwrap();
            prop_assert!(line.rms < 1e-5);
            prop_assert!((line.direction[0] - cos).abs() + (line.direction[1] - sin).abs() < 1e-6);
            prop_assert!((line.length() - f64::from(n - 1)).abs() < 1e-6);
            prop_assert_eq!(split_chain(&points, 1.5).len(), 1);
        }
    }

    #[test]
    fn a_chain_that_turns_back_is_split_where_it_turns() {
        // Out for 50 pixels and 30 back beside it: the tip lies 1.2 pixels from the line through both ends.
        let there = (0..=50).map(|k| point(f64::from(k), 0.0));
        let back = (1..=30).map(|k| point(50.0 - f64::from(k), 1.0));
        let hairpin: Vec<_> = there.chain(back).collect();
        assert_eq!(split_chain(&hairpin, 1.5), [0..51, 50..81]);
        // All in one place, and one place twice.
        let whole = |points: &[EdgePoint]| split_chain(points, 1.5) == vec![0..points.len(); 1];
        assert!(whole(&[point(3.0, 4.0); 5]));
        let twice = [point(0.0, 0.0), point(9.0, 0.0), point(0.0, 0.0)];
        assert_eq!(split_chain(&twice, 1.5), [0..2, 1..3]);
        assert!(whole(&[point(f64::NAN, 0.0), point(1.0, 0.0)]));
    }

    #[test]
    fn a_closed_square_falls_into_its_sides() {
        let side = |k: u32| match k / 30 {
            0 => point(f64::from(k), 0.0),
            1 => point(30.0, f64::from(k - 30)),
            2 => point(f64::from(90 - k), 30.0),
            _ => point(0.0, f64::from(120 - k)),
        };
        // It begins at a corner and ends beside it; and once in the middle of a side.
        let square: Vec<_> = (0..120).map(side).collect();
        assert_eq!(split_chain(&square, 1.5), [0..31, 30..61, 60..91, 90..120]);
        let turned: Vec<_> = (0..120).map(|k| side((k + 15) % 120)).collect();
        assert_eq!(
            split_chain(&turned, 1.5),
            [0..16, 15..46, 45..76, 75..106, 105..120]
        );
    }

    #[test]
    fn a_bend_splits_at_its_corner() {
        let points: Vec<_> = (0..=20)
            .map(|k| point(f64::from(k), 0.0))
            .chain((1..=20).map(|k| point(20.0, f64::from(k))))
            .collect();
        assert_eq!(split_chain(&points, 1.5), [0..21, 20..41]);
        assert!(split_chain(&points[..1], 1.5).is_empty());
        assert!(fit_line(&[point(1.0, 1.0), point(1.0, 1.0)]).is_none());
        assert!(fit_line(&[]).is_none());
    }
}
