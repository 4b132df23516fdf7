//! Hamming matching within the nodes of a vocabulary tree (the direct index of Gálvez-López & Tardós 2012).
//!
//! Near descriptors mostly go down a tree together, so that only those of the same node are compared. Those that part on the way
//! are lost, and a second nearest in another node is not seen by the ratio test: figures in `docs/measurements.md`.

use super::{Match, MatchConfig, Nearest};
use crate::feature::Descriptor;

/// An image's descriptors by the node of a [`super::Vocabulary`] that they go through.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DirectIndex {
    /// (node, index, descriptor), ascending.
    members: Vec<(usize, usize, Descriptor)>,
}

impl DirectIndex {
    pub(super) fn new(descriptors: &[Descriptor], nodes: impl Iterator<Item = usize>) -> Self {
        let pairs = nodes.zip(descriptors).enumerate();
        let member = |(index, (node, &descriptor))| (node, index, descriptor);
        let mut members: Vec<_> = pairs.map(member).collect();
        members.sort_unstable();
        Self { members }
    }
}

/// For each descriptor of `first` its nearest of the same node in `second`, where that is a match; ascending by `first`.
///
/// Both sides must come from the same vocabulary and level; otherwise the nodes mean different things. Ties go to the lower index.
/// Cost: the pairs that share a node.
#[must_use]
pub fn match_by_node(
    first: &DirectIndex,
    second: &DirectIndex,
    config: &MatchConfig,
) -> Vec<Match> {
    let mut matches = Vec::new();
    let mut rest = &second.members[..];
    for ours in first.members.chunk_by(|a, b| a.0 == b.0) {
        let node = ours[0].0;
        rest = &rest[rest.partition_point(|member| member.0 < node)..];
        let (theirs, after) = rest.split_at(rest.partition_point(|member| member.0 == node));
        rest = after;
        match_group(ours, theirs, config, &mut matches);
    }
    matches.sort_unstable_by_key(|found| found.first);
    matches
}

/// Compares all pairs of a node.
fn match_group(
    ours: &[(usize, usize, Descriptor)],
    theirs: &[(usize, usize, Descriptor)],
    config: &MatchConfig,
    matches: &mut Vec<Match>,
) {
    let mut reverse = vec![Nearest::default(); theirs.len()];
    let mut forward = vec![Nearest::default(); ours.len()];
    for ((_, index, query), best) in ours.iter().zip(&mut forward) {
        for (slot, ((_, _, candidate), back)) in theirs.iter().zip(&mut reverse).enumerate() {
            let distance = query.distance(candidate);
            best.offer(slot, distance);
            back.offer(*index, distance);
        }
    }
    for ((_, index, _), nearest) in ours.iter().zip(forward) {
        let Some(found) = nearest.accept(*index, config) else {
            continue;
        };
        if !config.mutual || reverse[found.second].index == *index {
            let second = theirs[found.second].1;
            matches.push(Match { second, ..found });
        }
    }
}
