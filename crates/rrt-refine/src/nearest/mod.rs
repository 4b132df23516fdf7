//! Nearest neighbours in a set of points that only grows.
//!
//! [`KdTree`] answers in a time that hardly depends on how many points there are; [`LinearScan`] is the plain loop that it is
//! tested against. Both give the same answers, ties included: the
//! lowest index wins.

mod kd_tree;
mod linear_scan;

pub use kd_tree::KdTree;
pub use linear_scan::LinearScan;

/// Whether `a` (index, squared distance) comes before `b`; false where a distance is NaN.
fn closer(a: &(usize, f64), b: &(usize, f64)) -> bool {
    a.1 < b.1 || (a.1 == b.1 && a.0 < b.0)
}
