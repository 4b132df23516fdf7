//! Gradient boosting of small complete trees for a yes-or-no answer (Friedman 2001, with Newton steps as in XGBoost).

/// The share of each Newton step that is taken.
const RATE: f64 = 0.1;
/// Thresholds that are tried for a cue: its quantiles.
const CELLS: usize = 32;
/// Pull of the leaves to zero, and the weight that a child needs.
const PULL: f64 = 2.0;
const MIN_WEIGHT: f64 = 8.0;

/// A complete tree: node k has the children 2k + 1 (cue at most the threshold) and 2k + 2. There is one leaf more than nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tree<const NODES: usize, const LEAVES: usize> {
    pub(crate) cue: [u8; NODES],
    pub(crate) most: [f32; NODES],
    pub(crate) leaf: [f32; LEAVES],
}

pub(crate) struct Forest<const NODES: usize, const LEAVES: usize> {
    bias: f64,
    pub(crate) trees: Vec<Tree<NODES, LEAVES>>,
}

/// Gradient and curvature of the log likelihood.
#[derive(Debug, Clone, Copy, Default)]
struct Slope {
    first: f64,
    second: f64,
}

impl Slope {
    fn add(&mut self, other: Self) {
        self.first += other.first;
        self.second += other.second;
    }

    fn without(self, other: Self) -> Self {
        Self {
            first: self.first - other.first,
            second: self.second - other.second,
        }
    }

    fn gain(self) -> f64 {
        self.first * self.first / (self.second + PULL)
    }
}

impl<const NODES: usize, const LEAVES: usize> Forest<NODES, LEAVES> {
    pub(crate) fn fit<const CUES: usize>(
        cues: &[[f64; CUES]],
        right: &[bool],
        trees: usize,
    ) -> Self {
        let thresholds = thresholds(cues);
        let cells: Vec<[u8; CUES]> = cues
            .iter()
            .map(|row| std::array::from_fn(|c| cell(&thresholds[c], row[c])))
            .collect();
        let share = right.iter().filter(|&&yes| yes).count() as f64 / right.len() as f64;
        let bias = (share / (1.0 - share)).ln();
        let mut odds = vec![bias; cues.len()];
        let mut forest = Vec::new();
        for _ in 0..trees {
            let slopes: Vec<Slope> = odds.iter().zip(right).map(|(z, y)| slope(*z, *y)).collect();
            let (tree, leaf_of) = grow::<CUES, NODES, LEAVES>(cues, &cells, &slopes, &thresholds);
            for (z, leaf) in odds.iter_mut().zip(leaf_of) {
                *z += f64::from(tree.leaf[leaf]);
            }
            forest.push(tree);
        }
        Self {
            bias,
            trees: forest,
        }
    }

    /// Log odds of a candidate about which no tree was asked.
    pub(crate) fn base(&self) -> f64 {
        let mean = |tree: &Tree<NODES, LEAVES>| {
            tree.leaf.iter().map(|&x| f64::from(x)).sum::<f64>() / LEAVES as f64
        };
        self.bias + self.trees.iter().map(mean).sum::<f64>()
    }
}

fn slope(odds: f64, right: bool) -> Slope {
    let p = 1.0 / (1.0 + (-odds).exp());
    Slope {
        first: f64::from(u8::from(right)) - p,
        second: p * (1.0 - p),
    }
}

fn thresholds<const CUES: usize>(cues: &[[f64; CUES]]) -> Vec<Vec<f32>> {
    let quantiles = |c: usize| {
        let mut values: Vec<f64> = cues.iter().map(|row| row[c]).collect();
        values.sort_by(f64::total_cmp);
        let at = |k: usize| values[k * values.len() / CELLS] as f32;
        let mut quantiles: Vec<f32> = (1..CELLS).map(at).collect();
        quantiles.dedup();
        quantiles
    };
    (0..CUES).map(quantiles).collect()
}

fn cell(thresholds: &[f32], value: f64) -> u8 {
    thresholds.partition_point(|&t| f64::from(t) < value) as u8
}

/// One tree, and the leaf that each example falls into.
fn grow<const CUES: usize, const NODES: usize, const LEAVES: usize>(
    cues: &[[f64; CUES]],
    cells: &[[u8; CUES]],
    slopes: &[Slope],
    thresholds: &[Vec<f32>],
) -> (Tree<NODES, LEAVES>, Vec<usize>) {
    let mut tree = Tree {
        cue: [0; NODES],
        most: [f32::MAX; NODES],
        leaf: [0.0; LEAVES],
    };
    let mut place = vec![0usize; cues.len()];
    for level in 0..LEAVES.ilog2() {
        let first = (1 << level) - 1;
        let width = 1 << level;
        let mut sums = vec![[[Slope::default(); CELLS]; CUES]; width];
        for ((node, row), slope) in place.iter().zip(cells).zip(slopes) {
            for c in 0..CUES {
                sums[*node][c][usize::from(row[c])].add(*slope);
            }
        }
        for (node, sums) in sums.iter().enumerate() {
            if let Some((c, t)) = best_split(sums, thresholds) {
                tree.cue[first + node] = c as u8;
                tree.most[first + node] = thresholds[c][t];
            }
        }
        for (node, row) in place.iter_mut().zip(cues) {
            let k = first + *node;
            let more = row[usize::from(tree.cue[k])] > f64::from(tree.most[k]);
            *node = 2 * *node + usize::from(more);
        }
    }
    let mut sums = [Slope::default(); LEAVES];
    for (leaf, slope) in place.iter().zip(slopes) {
        sums[*leaf].add(*slope);
    }
    // Four digits are printed, and used from here on.
    let round = |x: f64| ((x * 1e4).round() / 1e4) as f32;
    tree.leaf = sums.map(|sum| round(RATE * sum.first / (sum.second + PULL)));
    (tree, place)
}

/// The cue and the threshold of the largest gain.
fn best_split(sums: &[[Slope; CELLS]], thresholds: &[Vec<f32>]) -> Option<(usize, usize)> {
    let mut all = Slope::default();
    sums[0].iter().for_each(|sum| all.add(*sum));
    let mut best = None;
    let mut most = 1e-6;
    for (c, cells) in sums.iter().enumerate() {
        let mut low = Slope::default();
        for (t, cell) in cells.iter().take(thresholds[c].len()).enumerate() {
            low.add(*cell);
            let high = all.without(low);
            let gain = low.gain() + high.gain() - all.gain();
            if low.second.min(high.second) >= MIN_WEIGHT && gain > most {
                most = gain;
                best = Some((c, t));
            }
        }
    }
    best
}
