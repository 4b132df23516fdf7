//! Vector arithmetic on `[f64; 3]`, the only point type inside this crate.

pub(crate) type Vec3 = [f64; 3];

#[inline]
pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
pub(crate) fn scale(a: Vec3, factor: f64) -> Vec3 {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

#[inline]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline]
pub(crate) fn norm_squared(a: Vec3) -> f64 {
    dot(a, a)
}

#[inline]
pub(crate) fn norm(a: Vec3) -> f64 {
    norm_squared(a).sqrt()
}

#[inline]
pub(crate) fn distance_squared(a: Vec3, b: Vec3) -> f64 {
    #[cfg(test)]
    DISTANCES.with(|count| count.set(count.get() + 1));
    norm_squared(sub(a, b))
}

#[inline]
pub(crate) fn distance(a: Vec3, b: Vec3) -> f64 {
    distance_squared(a, b).sqrt()
}

#[inline]
pub(crate) fn lerp(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    add(a, scale(sub(b, a), t))
}

#[inline]
pub(crate) fn min(a: Vec3, b: Vec3) -> Vec3 {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].min(b[2])]
}

#[inline]
pub(crate) fn max(a: Vec3, b: Vec3) -> Vec3 {
    [a[0].max(b[0]), a[1].max(b[1]), a[2].max(b[2])]
}

/// The direction of `a`, or `None` where it has no length.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| scale(a, 1.0 / length))
}

/// A unit vector at a right angle to the unit vector `a`.
pub(crate) fn orthogonal(a: Vec3) -> Vec3 {
    let axis = if a[0].abs() <= a[1].abs() && a[0].abs() <= a[2].abs() {
        [1.0, 0.0, 0.0]
    } else if a[1].abs() <= a[2].abs() {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    unit(cross(a, axis)).unwrap_or([0.0, 0.0, 1.0])
}

#[cfg(test)]
thread_local! {
    /// How many squared distances this thread has computed: what K-means costs, on any machine.
    pub(crate) static DISTANCES: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}
