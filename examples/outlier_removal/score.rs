//! How right a removal is: precision, recall, F1, average precision, and how far two removals agree.

use submodular_minimax::Views;

/// Whether each point is an outlier, where that is known.
pub(crate) type Labels = Vec<Option<bool>>;

/// Points with what is known of them.
pub(crate) struct Labelled {
    pub(crate) name: String,
    pub(crate) points: Vec<[f64; 3]>,
    /// Who saw what, where that is known.
    pub(crate) views: Option<Views>,
    pub(crate) outlier: Labels,
}

impl Labelled {
    /// How many points are known to be of this kind.
    pub(crate) fn count(&self, outlier: bool) -> usize {
        (self.outlier.iter())
            .filter(|known| **known == Some(outlier))
            .count()
    }
}

/// How many of these points are known to be of this kind.
fn among(removed: &[usize], labels: &[Option<bool>], kind: bool) -> f64 {
    removed.iter().filter(|&&v| labels[v] == Some(kind)).count() as f64
}

/// Precision, recall and F1 of the removed set among the labelled points.
pub(crate) fn precision_recall_f1(removed: &[usize], labels: &[Option<bool>]) -> [f64; 3] {
    let (hits, misses) = (among(removed, labels, true), among(removed, labels, false));
    let truth = labels.iter().filter(|known| **known == Some(true)).count() as f64;
    let share = |part: f64, whole: f64| part / whole.max(1.0);
    [
        share(hits, hits + misses),
        share(hits, truth),
        share(2.0 * hits, hits + misses + truth),
    ]
}

/// F1 of the removed set among the labelled points.
pub(crate) fn f1(removed: &[usize], labels: &[Option<bool>]) -> f64 {
    precision_recall_f1(removed, labels)[2]
}

/// Share of the labelled inliers that were removed.
pub(crate) fn false_positive_rate(removed: &[usize], labels: &[Option<bool>]) -> f64 {
    let inliers = labels.iter().filter(|known| **known == Some(false)).count();
    among(removed, labels, false) / inliers.max(1) as f64
}

/// Average precision of a score, higher meaning more outlying; equal scores form one step.
pub(crate) fn average_precision(scores: &[f64], labels: &[Option<bool>]) -> f64 {
    let known = scores.iter().zip(labels);
    let mut known: Vec<(f64, bool)> = known.filter_map(|(&s, o)| o.map(|o| (s, o))).collect();
    known.sort_by(|a, b| b.0.total_cmp(&a.0));
    let truth = known.iter().filter(|k| k.1).count().max(1) as f64;
    let (mut hits, mut before, mut sum) = (0.0, 0.0, 0.0);
    for (i, &(score, outlier)) in known.iter().enumerate() {
        hits += f64::from(u8::from(outlier));
        if known.get(i + 1).is_none_or(|next| next.0 != score) {
            sum += (hits - before) / truth * hits / (i + 1) as f64;
            before = hits;
        }
    }
    sum
}

/// Points that both remove, as a share of those that any of the two removes; 1 where none removes any. Both ascend.
pub(crate) fn agreement(a: &[usize], b: &[usize]) -> f64 {
    let both = a.iter().filter(|v| b.binary_search(v).is_ok()).count();
    let any = a.len() + b.len() - both;
    if any == 0 {
        1.0
    } else {
        both as f64 / any as f64
    }
}
