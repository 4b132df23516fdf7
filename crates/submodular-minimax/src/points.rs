//! Points in, finite columns inside: the only place that sees the caller's point type.

/// A point in space: anything cheap to copy that converts to `[f64; 3]`.
///
/// Arrays, tuples, nalgebra and glam points and your own type with `impl From<Yours> for [f64; 3]`
/// all qualify; there is nothing to implement.
pub trait PointLike: Copy + Into<[f64; 3]> {}

impl<P: Copy + Into<[f64; 3]>> PointLike for P {}

/// Finite points scaled by a power of two so that no squared distance overflows.
///
/// A power of two changes exponents only, so every decision made on the scaled points is the one
/// that exact arithmetic on the caller's points would lead to. Coordinates beyond 10¹⁰⁰ times the median
/// size are drawn in to that, lest the others' squared distances vanish beside theirs.
pub(crate) struct Cloud {
    /// The scaled points; coordinates lie in [-1, 1], or [-2, 2] at the end of what numbers can tell.
    pub(crate) points: Vec<[f64; 3]>,
    /// Caller's units per scaled unit, a power of two.
    pub(crate) unit: f64,
}

/// The largest coordinate that is told from larger ones, in median sizes of the points.
const MOST_MEDIANS: f64 = 1e100;

/// The index of a point with a NaN or infinite coordinate.
pub(crate) struct NonFiniteAt(pub(crate) usize);

impl Cloud {
    /// Checks and scales the points.
    pub(crate) fn new<P: PointLike>(points: &[P]) -> Result<Self, NonFiniteAt> {
        let mut points: Vec<[f64; 3]> = points.iter().map(|&point| point.into()).collect();
        let mut sizes = Vec::with_capacity(points.len());
        for (index, point) in points.iter().enumerate() {
            if !point.iter().all(|coordinate| coordinate.is_finite()) {
                return Err(NonFiniteAt(index));
            }
            sizes.push(point.iter().fold(0.0_f64, |size, x| size.max(x.abs())));
        }
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        sizes.retain(|&size| size > 0.0);
        let unit = power_of_two_above(largest.min(MOST_MEDIANS * median(&mut sizes)));
        for point in &mut points {
            *point = scaled(*point, unit).map(|x| x.clamp(-2.0, 2.0));
        }
        Ok(Self { points, unit })
    }

    /// How many points there are.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }
}

/// `point / unit`, coordinate by coordinate.
pub(crate) fn scaled(point: [f64; 3], unit: f64) -> [f64; 3] {
    point.map(|coordinate| coordinate / unit)
}

/// Squared Euclidean distance.
pub(crate) fn squared_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (x, y, z) = (a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    x * x + y * y + z * z
}

/// The middle of the points by their medians, and the median distance from there.
pub(crate) fn extent(points: &[[f64; 3]]) -> ([f64; 3], f64) {
    let along = |axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<_>>();
    let middle = [0, 1, 2].map(|axis| median(&mut along(axis)));
    let away = |&point: &[f64; 3]| squared_distance(point, middle).sqrt();
    (
        middle,
        median(&mut points.iter().map(away).collect::<Vec<_>>()),
    )
}

/// The median, the mean of the middle two for an even count; 0 for an empty slice. Reorders.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    let odd = values.len() % 2 == 1;
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if odd {
        return upper;
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 * lower + 0.5 * upper
}

/// The smallest normal power of two not below `value`; 1 for zero.
fn power_of_two_above(value: f64) -> f64 {
    if value == 0.0 {
        return 1.0;
    }
    let exponent = value.log2().ceil().clamp(-1022.0, 1023.0);
    2.0_f64.powi(exponent as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_coordinates_stay_finite_after_scaling() {
        for size in [1e-300, 1e-12, 1.0, 3.0, 1e12, 1e308] {
            let cloud = Cloud::new(&[[size, 0.0, 0.0], [-size, size, 0.0]])
                .ok()
                .unwrap();
            let d = squared_distance(cloud.points[0], cloud.points[1]);
            assert!(d.is_finite() && d > 0.0, "size {size}: {d}");
            assert!((d.sqrt() / (size / cloud.unit) - 5.0_f64.sqrt()).abs() < 1e-9);
        }
    }

    #[test]
    fn one_absurd_point_does_not_merge_the_others() {
        let cloud = Cloud::new(&[[1.0; 3], [1.001; 3], [1.002; 3], [1e300, -1e300, 0.0]]);
        let points = cloud.ok().unwrap().points;
        let near = squared_distance(points[0], points[1]);
        assert!(near > 0.0 && near < squared_distance(points[0], points[2]));
        assert!(squared_distance(points[0], points[3]) / near > 1e100);
    }

    #[test]
    fn first_non_finite_point_is_named() {
        let points = [[0.0; 3], [0.0, f64::NAN, 0.0], [f64::INFINITY, 0.0, 0.0]];
        assert!(matches!(Cloud::new(&points), Err(NonFiniteAt(1))));
    }

    #[test]
    fn median_of_even_and_odd_counts() {
        assert_eq!(median(&mut []), 0.0);
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
