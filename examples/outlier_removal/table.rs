//! One row a method: how many points go, how right that is, and how far it agrees with the default.

use std::io::{self, Write};

use explorer::baseline::BaselineError;

use crate::score::{Labelled, agreement, average_precision, precision_recall_f1};
use crate::settings::Candidate;

/// What a method found.
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) removed: Vec<usize>,
    /// One a point, higher is more outlying.
    pub(crate) scores: Vec<f64>,
}

/// Names the columns; `agrees`: points that the method and the default remove, as a share of those that any of them does.
pub(crate) fn heading(out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "{:40} {:>8} {:>10} {:>7} {:>6} {:>6} {:>7}",
        "", "removed", "precision", "recall", "F1", "AP", "agrees"
    )
}

impl Row {
    /// What a baseline finds.
    pub(crate) fn of(candidate: &Candidate, map: &Labelled) -> Result<Self, BaselineError> {
        let found = candidate.remove(&map.points)?;
        Ok(Self {
            name: candidate.name.clone(),
            removed: found.removed,
            scores: found.scores,
        })
    }

    pub(crate) fn write(
        &self,
        out: &mut impl Write,
        map: &Labelled,
        default: &[usize],
    ) -> io::Result<()> {
        let (name, removed) = (format!("  {}", self.name), self.removed.len());
        let agrees = agreement(&self.removed, default);
        if map.count(true) == 0 {
            let (p, r, f, a) = ("-", "-", "-", "-");
            return writeln!(
                out,
                "{name:40} {removed:8} {p:>10} {r:>7} {f:>6} {a:>6} {agrees:7.3}"
            );
        }
        let [precision, recall, f1] = precision_recall_f1(&self.removed, &map.outlier);
        let ap = average_precision(&self.scores, &map.outlier);
        writeln!(
            out,
            "{name:40} {removed:8} {precision:10.3} {recall:7.3} {f1:6.3} {ap:6.3} {agrees:7.3}"
        )
    }
}
