//! Picks corners that cover the image: a quadtree whose leaves keep their best corner (as ORB-SLAM does).

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Corner;

/// Indices of at most `count` corners spread over the image, the best of each leaf by `responses`, ascending.
///
/// A corner without a response counts as the worst.
/// The fullest leaf is split in four until there are `count` leaves or no leaf can be split; up to three more
/// than `count` may then exist, of which the weakest are dropped. Ties go to the lower index. Cost: O(n log n).
#[must_use]
pub fn spread_corners(corners: &[Corner], responses: &[f32], count: usize) -> Vec<usize> {
    if corners.len() <= count {
        return (0..corners.len()).collect();
    }
    if count == 0 {
        return Vec::new();
    }
    let mut leaves = BinaryHeap::from(roots(corners));
    let mut finished = Vec::new();
    while leaves.len() + finished.len() < count {
        let Some(fullest) = leaves.pop() else { break };
        if fullest.members.len() == 1 || fullest.side <= 1 {
            finished.push(fullest);
        } else {
            leaves.extend(fullest.split(corners));
        }
    }
    let mut chosen: Vec<usize> = leaves
        .iter()
        .chain(&finished)
        .filter_map(|leaf| leaf.best(responses))
        .collect();
    chosen.sort_unstable_by(|&a, &b| better(responses, b, a));
    chosen.truncate(count);
    chosen.sort_unstable();
    chosen
}

/// A square of the image. The order is that of the heap: number of corners, then position, so that it is total.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Leaf {
    size: usize,
    corner: core::cmp::Reverse<(u32, u32)>,
    side: u32,
    members: Vec<usize>,
}

impl Leaf {
    fn new(x: u32, y: u32, side: u32, members: Vec<usize>) -> Self {
        Self {
            size: members.len(),
            corner: core::cmp::Reverse((y, x)),
            side,
            members,
        }
    }

    fn split(self, corners: &[Corner]) -> impl Iterator<Item = Self> {
        let (y, x) = self.corner.0;
        let half = self.side.div_ceil(2);
        let mut parts: [Vec<usize>; 4] = Default::default();
        for index in self.members {
            let corner = &corners[index];
            let right = usize::from(corner.x - x >= half);
            let lower = usize::from(corner.y - y >= half);
            parts[lower * 2 + right].push(index);
        }
        let origins = [(x, y), (x + half, y), (x, y + half), (x + half, y + half)];
        parts
            .into_iter()
            .zip(origins)
            .filter(|(members, _)| !members.is_empty())
            .map(move |(members, (x, y))| Self::new(x, y, half, members))
    }

    fn best(&self, responses: &[f32]) -> Option<usize> {
        self.members
            .iter()
            .copied()
            .max_by(|&a, &b| better(responses, a, b))
    }
}

/// Greater response first, lower index on a tie.
fn better(responses: &[f32], a: usize, b: usize) -> Ordering {
    let response = |index: usize| responses.get(index).copied().unwrap_or(f32::NEG_INFINITY);
    response(a).total_cmp(&response(b)).then(b.cmp(&a))
}

/// One square per aspect ratio: a wide image starts with several squares side by side.
fn roots(corners: &[Corner]) -> Vec<Leaf> {
    let bounds = |value: fn(&Corner) -> u32| {
        let low = corners.iter().map(value).min().unwrap_or(0);
        let high = corners.iter().map(value).max().unwrap_or(0);
        (low, high - low + 1)
    };
    let ((x0, width), (y0, height)) = (bounds(|c| c.x), bounds(|c| c.y));
    let side = width.min(height).max(1);
    let columns = width.div_ceil(side);
    let rows = height.div_ceil(side);
    let tiles = usize::try_from(u64::from(columns) * u64::from(rows)).unwrap_or(usize::MAX);
    if tiles > corners.len() {
        // A sliver of an image: one square over everything does as well.
        return vec![Leaf::new(
            x0,
            y0,
            width.max(height),
            (0..corners.len()).collect(),
        )];
    }
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); tiles];
    for (index, corner) in corners.iter().enumerate() {
        members[((corner.y - y0) / side * columns + (corner.x - x0) / side) as usize].push(index);
    }
    let tile = |(index, members): (u32, Vec<usize>)| {
        Leaf::new(
            x0 + index % columns * side,
            y0 + index / columns * side,
            side,
            members,
        )
    };
    (0..)
        .zip(members)
        .filter(|(_, members)| !members.is_empty())
        .map(tile)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn scores(corners: &[Corner]) -> Vec<f32> {
        corners.iter().map(|c| f32::from(c.score)).collect()
    }

    fn corners() -> impl Strategy<Value = Vec<Corner>> {
        let corner = (0u32..640, 0u32..480, 1u8..).prop_map(|(x, y, score)| Corner { x, y, score });
        prop::collection::vec(corner, 0..200)
    }

    proptest! {
        #[test]
        fn gives_as_many_as_asked(corners in corners(), count in 0usize..150) {
            let chosen = spread_corners(&corners, &scores(&corners), count);
            prop_assert!(chosen.len() <= count);
            prop_assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
            let mut places: Vec<_> = corners.iter().map(|c| (c.x, c.y)).collect();
            places.sort_unstable();
            places.dedup();
            if places.len() == corners.len() {
                prop_assert_eq!(chosen.len(), count.min(corners.len()));
            }
        }
    }

    #[test]
    fn a_lonely_weak_corner_survives_a_crowd() {
        let mut corners: Vec<Corner> = (0..100)
            .map(|i| Corner {
                x: i % 10,
                y: i / 10,
                score: 200,
            })
            .collect();
        corners.push(Corner {
            x: 600,
            y: 450,
            score: 1,
        });
        assert!(spread_corners(&corners, &scores(&corners), 5).contains(&100));
    }

    #[test]
    fn extreme_places_do_not_overflow() {
        let far = u32::MAX - 1;
        let corners: Vec<Corner> = [(0, 0), (far, 0), (0, far), (far, far)]
            .map(|(x, y)| Corner { x, y, score: 1 })
            .into();
        assert!(!spread_corners(&corners, &[], 2).is_empty());
        let line: Vec<Corner> = (0..50).map(|x| Corner { x, y: 5, score: 1 }).collect();
        assert_eq!(spread_corners(&line, &[], 10).len(), 10);
    }
}
