//! The outline of an obstacle seen from above: the convex hull of its corners in the plane.

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chain, O(n log n)). Fewer than
/// three corners for points on a line.
pub(crate) fn outline(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    corners.retain(|corner| corner.iter().all(|x| x.is_finite()));
    corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    corners.dedup();
    if corners.len() < 3 {
        return corners;
    }
    let mut ring = half(corners.iter().copied());
    ring.pop();
    let mut upper = half(corners.iter().rev().copied());
    upper.pop();
    ring.append(&mut upper);
    ring
}

fn half(corners: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut chain: Vec<[f64; 2]> = Vec::new();
    for corner in corners {
        while let [.., a, b] = chain[..] {
            let turn = (b[0] - a[0]) * (corner[1] - a[1]) - (b[1] - a[1]) * (corner[0] - a[0]);
            if turn > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(corner);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inner_and_edge_points_are_left_out() {
        let square = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [0.0, 2.0],
            [1.0, 1.0],
            [1.0, 0.0],
        ];
        let ring = outline(square.to_vec());
        assert_eq!(ring, [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    }

    #[test]
    fn a_line_has_two_ends() {
        assert_eq!(outline(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).len(), 2);
        assert_eq!(outline(vec![[f64::NAN, 0.0]]).len(), 0);
    }
}
