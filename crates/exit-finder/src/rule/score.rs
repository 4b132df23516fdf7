//! How likely a candidate is an opening: a boosted forest of small trees over the cues, with its parts by cue.
//!
//! A sum of many trees of depth four is a sum of functions of one to four cues: it can say "strays behind a textured
//! wall" or "deep, but the side walls go on", which a weighted sum of the cues cannot. Fitted on generated rooms by
//! `cargo run --release -p examples --example fit_exit_forest`, which prints `forest.rs`.
//! Each split moves the value of a tree from the mean of its leaves below to that of a half; the move is
//! credited to the cue that was asked, so that the parts add up to the log odds exactly.

use super::cues::CUES;
use super::forest::{BASE, TREES};
use super::openings::Opening;
use super::second_forest;
use super::second_look::SecondLook;

/// A complete tree: node k has the children 2k + 1 (cue at most the threshold) and 2k + 2. There is one leaf more than nodes.
pub(super) struct Tree<const NODES: usize, const LEAVES: usize> {
    pub(super) cue: [u8; NODES],
    pub(super) most: [f32; NODES],
    pub(super) leaf: [f32; LEAVES],
}

/// A tree of the first look, of depth four, and one of the second, of depth five.
pub(super) type Shallow = Tree<15, 16>;
pub(super) type Deep = Tree<31, 32>;

/// Where a score comes from: parts of its log odds, by what was asked. All zero for exits of Algorithm 2; an exit of kind
/// [`crate::ExitKind::Empty`] has `support` only.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ScoreParts {
    /// How much farther one sees than in the surroundings.
    pub contrast: f64,
    /// Which share of the points lies beyond the wall, on it and before it.
    pub share: f64,
    /// How many points lie beyond, against what strays and a blank wall would show; for an empty sector, how many a
    /// wall would have shown.
    pub support: f64,
    /// How deep behind the wall they lie, in the middle and at the edges.
    pub depth: f64,
    /// How wide and how far away the opening is.
    pub width: f64,
    /// How well the wall around it is seen.
    pub wall: f64,
    /// Whether the points beyond lie on surfaces and fill the sector.
    pub structure: f64,
    /// Whether the room itself explains them: its back wall past a cabinet, its side walls going on.
    pub room: f64,
    /// What the second look at a cleaned map adds ([`crate::SecondLook`]): whether what is seen among all points is seen among the kept
    /// ones too, and what else is likely there. 0 where there was one look.
    pub agreement: f64,
}

impl Opening {
    /// The parts of the log odds.
    pub(super) fn parts(&self) -> ScoreParts {
        let mut by_cue = [0.0; CUES];
        for tree in &TREES {
            credit(tree, &self.cues, &mut by_cue);
        }
        let mut parts = ScoreParts::default();
        for (part, cue) in PART_OF_CUE.iter().zip(by_cue) {
            *parts.part(*part) += cue;
        }
        parts
    }

    /// Probability that this is a way out, in rooms like those that the forest was fitted on.
    #[must_use]
    pub fn probability(&self) -> f64 {
        self.parts().probability()
    }

    /// The same up to rounding, without the parts: most candidates are told from exits at a fifth of the cost. `bias` is
    /// [`bias`].
    pub(super) fn rough_probability(&self, bias: f64) -> f64 {
        probability(self.odds(bias))
    }

    /// Log odds, in the same way.
    pub(super) fn odds(&self, bias: f64) -> f64 {
        bias + leaves(&TREES, &self.cues)
    }
}

impl SecondLook {
    /// Log odds of a way out. `bias` is [`second_bias`].
    fn odds(&self, bias: f64) -> f64 {
        bias + leaves(&second_forest::TREES, &self.cues)
    }

    /// Probability of a way out.
    pub(super) fn rough_probability(&self, bias: f64) -> f64 {
        probability(self.odds(bias))
    }

    /// The parts of the log odds.
    pub(super) fn parts(&self, bias: f64) -> ScoreParts {
        let parts = self.opening.parts();
        ScoreParts {
            agreement: self.odds(bias) - parts.sum() - BASE,
            ..parts
        }
    }
}

fn probability(odds: f64) -> f64 {
    1.0 / (1.0 + (-odds).exp())
}

/// Sum of the leaves that these cues lead to.
fn leaves<const NODES: usize, const LEAVES: usize>(
    trees: &[Tree<NODES, LEAVES>],
    cues: &[f64],
) -> f64 {
    let leaf = |tree: &Tree<NODES, LEAVES>| f64::from(tree.leaf[leaf_of(tree, cues)]);
    trees.iter().map(leaf).sum()
}

/// The index of the part that each cue belongs to, in the order of the cues.
const PART_OF_CUE: [u8; CUES] = [
    2, 1, 1, 3, 4, 5, 5, 5, 5, 7, 6, 0, 2, 3, 4, 3, 4, 7, 2, 6, 2, 2, 2, 6, 3, 5, 5, 6,
];

impl ScoreParts {
    /// Probability of a way out; the logistic function of the parts' sum.
    #[must_use]
    pub fn probability(&self) -> f64 {
        probability(self.sum() + BASE)
    }

    fn sum(&self) -> f64 {
        let Self {
            contrast,
            share,
            support,
            depth,
            width,
            wall,
            structure,
            room,
            agreement,
        } = self;
        contrast + share + support + depth + width + wall + structure + room + agreement
    }

    fn part(&mut self, index: u8) -> &mut f64 {
        match index {
            0 => &mut self.contrast,
            1 => &mut self.share,
            2 => &mut self.support,
            3 => &mut self.depth,
            4 => &mut self.width,
            5 => &mut self.wall,
            6 => &mut self.structure,
            _ => &mut self.room,
        }
    }

    /// The parts of an exit whose probability has one source.
    pub(super) fn of_support(probability: f64) -> Self {
        Self {
            support: (probability / (1.0 - probability)).ln() - BASE,
            ..Self::default()
        }
    }
}

/// Log odds before any tree was asked.
pub(super) fn bias() -> f64 {
    BASE - means(&TREES)
}

/// The same of the second look.
pub(super) fn second_bias() -> f64 {
    second_forest::BASE - means(&second_forest::TREES)
}

fn means<const NODES: usize, const LEAVES: usize>(trees: &[Tree<NODES, LEAVES>]) -> f64 {
    trees.iter().map(|tree| mean(&tree.leaf)).sum()
}

fn leaf_of<const NODES: usize, const LEAVES: usize>(
    tree: &Tree<NODES, LEAVES>,
    cues: &[f64],
) -> usize {
    let mut node = 0;
    while node < NODES {
        let more = cues[usize::from(tree.cue[node])] > f64::from(tree.most[node]);
        node = 2 * node + 1 + usize::from(more);
    }
    node - NODES
}

fn mean(leaves: &[f32]) -> f64 {
    leaves.iter().map(|&x| f64::from(x)).sum::<f64>() / leaves.len() as f64
}

/// Walks one tree and credits each step to its cue.
fn credit(tree: &Shallow, cues: &[f64; CUES], by_cue: &mut [f64; CUES]) {
    let (mut node, mut leaves) = (0, &tree.leaf[..]);
    let mut value = mean(leaves);
    while leaves.len() > 1 {
        let cue = usize::from(tree.cue[node]);
        let more = cues[cue] > f64::from(tree.most[node]);
        let (low, high) = leaves.split_at(leaves.len() / 2);
        leaves = if more { high } else { low };
        node = 2 * node + 1 + usize::from(more);
        let next = mean(leaves);
        by_cue[cue] += next - value;
        value = next;
    }
}
