//! What a corner detector could find on the surfaces of a world.

/// A place on a surface where a corner detector can fire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landmark {
    /// On the surface, metres.
    pub position: [f64; 3],
    /// Away from the surface, unit length; at an edge between two faces the bisector.
    pub normal: [f64; 3],
    /// Cosine of the greatest angle between the normal and the direction to a camera that can still see it.
    pub least_cosine: f64,
    /// Contrast, 0 (faint) to 1 (strong); detectors keep the strongest.
    pub strength: f64,
    /// Nearest distance at which it still looks the same, metres.
    pub near: f64,
    /// Farthest distance at which it is still resolved, metres.
    pub far: f64,
}

impl Landmark {
    /// A point 2 mm in front of the surface, so that the surface itself does not hide it.
    pub(crate) fn sight_point(&self) -> [f64; 3] {
        core::array::from_fn(|axis| self.position[axis] + 2e-3 * self.normal[axis])
    }
}
