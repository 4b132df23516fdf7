//! Things that move with a keyframe when the map is corrected.

use crate::vector::{add, cross, distance, dot, is_finite, norm, scale, sub};

/// The pose of a keyframe: `world = rotation · local + position`, and the unit of its surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeyframePose {
    /// Number of the keyframe, the same before and after a correction.
    pub id: u64,
    /// Rotation from the keyframe to the world, rows.
    pub rotation: [[f64; 3]; 3],
    /// Camera centre, world.
    pub position: [f64; 3],
}

impl KeyframePose {
    pub(crate) fn is_rigid(&self) -> bool {
        let [x, y, z] = self.rotation;
        let error = norm(sub(cross(x, y), z)) + (norm(x) - 1.0).abs() + (norm(y) - 1.0).abs();
        is_finite(self.position) && error + dot(x, y).abs() < 1e-6
    }

    fn to_world(self, local: [f64; 3]) -> [f64; 3] {
        add(self.rotation.map(|row| dot(row, local)), self.position)
    }

    fn to_local(self, world: [f64; 3]) -> [f64; 3] {
        let d = sub(world, self.position);
        let [x, y, z] = self.rotation;
        add(add(scale(x, d[0]), scale(y, d[1])), scale(z, d[2]))
    }
}

/// A fixed place relative to a keyframe, or to the world while there is no keyframe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchor {
    /// The keyframe it moves with.
    pub keyframe: Option<u64>,
    local: [f64; 3],
}

impl Anchor {
    /// Anchors a world point to the nearest of the keyframes (the lowest number on a tie); to the world
    /// where there is none.
    pub fn new(world: [f64; 3], keyframes: &[KeyframePose]) -> Self {
        let nearest = keyframes.iter().min_by(|a, b| {
            distance(a.position, world)
                .total_cmp(&distance(b.position, world))
                .then(a.id.cmp(&b.id))
        });
        match nearest {
            Some(pose) => Self {
                keyframe: Some(pose.id),
                local: pose.to_local(world),
            },
            None => Self {
                keyframe: None,
                local: world,
            },
        }
    }

    /// The point under corrected poses; `None` when its keyframe is gone.
    pub fn resolve(&self, keyframes: &[KeyframePose]) -> Option<[f64; 3]> {
        let Some(id) = self.keyframe else {
            return Some(self.local);
        };
        keyframes
            .iter()
            .find(|pose| pose.id == id)
            .map(|pose| pose.to_world(self.local))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_moves_with_its_keyframe() {
        let eye = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let pose = |id, position| KeyframePose {
            id,
            rotation: eye,
            position,
        };
        let before = [pose(7, [0.0; 3]), pose(9, [10.0, 0.0, 0.0])];
        let anchor = Anchor::new([9.0, 1.0, 0.0], &before);
        assert_eq!(anchor.keyframe, Some(9));
        let quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let after = [KeyframePose {
            id: 9,
            rotation: quarter,
            position: [20.0, 0.0, 0.0],
        }];
        // Relative to the keyframe the point is (−1, 1, 0); a quarter turn makes it (−1, −1, 0).
        let moved = anchor.resolve(&after).unwrap();
        assert!(distance(moved, [19.0, -1.0, 0.0]) < 1e-12);
        assert_eq!(anchor.resolve(&before[..1]), None);
        assert!(after[0].is_rigid());
        assert!(
            !KeyframePose {
                id: 1,
                rotation: [[1.0; 3]; 3],
                position: [0.0; 3]
            }
            .is_rigid()
        );
    }
}
