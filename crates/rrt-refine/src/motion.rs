//! Which straight motions are free: the only thing that planners and refiners ask about the world.

/// Decides whether the straight motion between two points is free over its whole length.
///
/// Every closure `|from: &[f64; D], to: &[f64; D]| -> bool` is one. Write the types of its arguments out, the compiler
/// cannot infer them here.
///
/// The answer must cover the *whole* motion (a swept body), not samples of it: what is asked here is flown. It must
/// depend on nothing but its arguments. `from == to` asks whether a single point is free. Motions are always asked in the
/// direction in which they will be travelled, so a validator may know one-way streets.
///
/// ```
/// use rrt_refine::MotionValidator;
/// // A wall along x = 1 that leaves y > 2 open.
/// let free = |a: &[f64; 2], b: &[f64; 2]| (a[0] < 1.0) == (b[0] < 1.0) || (a[1] > 2.0 && b[1] > 2.0);
/// assert!(!free.is_free(&[0.0, 0.0], &[2.0, 0.0]));
/// ```
pub trait MotionValidator<const D: usize> {
    /// Whether the straight motion from `from` to `to` is free, ends included.
    fn is_free(&self, from: &[f64; D], to: &[f64; D]) -> bool;
}

impl<F, const D: usize> MotionValidator<D> for F
where
    F: Fn(&[f64; D], &[f64; D]) -> bool + ?Sized,
{
    fn is_free(&self, from: &[f64; D], to: &[f64; D]) -> bool {
        self(from, to)
    }
}
