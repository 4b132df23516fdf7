//! Picks the strongest corners, but not too many from one place.
//!
//! The image is cut into tiles; in the order of their responses corners are taken while their tile holds less than
//! twice its share. What is still missing then is filled with the strongest that are left.

use super::Corner;

/// Tiles across the image's shorter side.
const TILES: usize = 6;
/// How many times its share a tile may hold.
const SURPLUS: f64 = 2.0;

/// Indices of at most `count` corners of an image of this size (width, height), ascending.
///
/// A corner without a response counts as the worst; ties go to the lower index. Cost: O(n log n).
#[must_use]
pub fn balanced_corners(
    corners: &[Corner],
    responses: &[f32],
    count: usize,
    [width, height]: [usize; 2],
) -> Vec<usize> {
    if corners.len() <= count {
        return (0..corners.len()).collect();
    }
    let response = |index: usize| responses.get(index).copied().unwrap_or(f32::NEG_INFINITY);
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_by(|&a, &b| response(b).total_cmp(&response(a)));
    let side = (width.min(height) / TILES).max(1);
    let (columns, rows) = (width.div_ceil(side).max(1), height.div_ceil(side).max(1));
    let tile = |corner: &Corner| {
        let (x, y) = (corner.x as usize / side, corner.y as usize / side);
        y.min(rows - 1) * columns + x.min(columns - 1)
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "small counts"
    )]
    let limit = (SURPLUS * count as f64 / (columns * rows) as f64).ceil() as usize;
    let mut held = vec![0_usize; columns * rows];
    let (mut chosen, mut left) = (Vec::with_capacity(count), Vec::new());
    for index in order {
        let tile = tile(&corners[index]);
        if held[tile] < limit && chosen.len() < count {
            held[tile] += 1;
            chosen.push(index);
        } else {
            left.push(index);
        }
    }
    let missing = count - chosen.len();
    chosen.extend(left.into_iter().take(missing));
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn gives_exactly_as_many_as_asked_and_the_strongest_of_each_tile(
            places in prop::collection::vec((0u32..160, 0u32..120, 0u8..), 0..200), count in 0usize..150,
        ) {
            let corners: Vec<Corner> =
                places.iter().map(|&(x, y, score)| Corner { x, y, score }).collect();
            let responses: Vec<f32> = corners.iter().map(|c| f32::from(c.score)).collect();
            let chosen = balanced_corners(&corners, &responses, count, [160, 120]);
            prop_assert_eq!(chosen.len(), count.min(corners.len()));
            prop_assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
            // Tiles are 20 pixels wide: what was left out is weaker than all that its tile holds.
            let tile = |c: &Corner| (c.x / 20, c.y / 20);
            for (index, corner) in corners.iter().enumerate().filter(|(i, _)| !chosen.contains(i)) {
                for &other in chosen.iter().filter(|&&k| tile(&corners[k]) == tile(corner)) {
                    prop_assert!(responses[other] >= responses[index]);
                }
            }
        }
    }

    #[test]
    fn a_crowd_leaves_room_for_others() {
        let crowd = (0..100).map(|i| Corner {
            x: i % 10,
            y: i / 10,
            score: 200,
        });
        let weak = (0..6).map(|i| Corner {
            x: 20 + 20 * i,
            y: 100,
            score: 9,
        });
        let corners: Vec<Corner> = crowd.chain(weak).collect();
        let responses: Vec<f32> = corners.iter().map(|c| f32::from(c.score)).collect();
        let chosen = balanced_corners(&corners, &responses, 50, [160, 120]);
        assert_eq!(chosen.iter().filter(|&&index| index >= 100).count(), 6);
        assert!(balanced_corners(&corners, &[], 3, [0, 0]).len() == 3);
    }
}
