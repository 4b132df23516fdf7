//! Cues that count points rather than votes: a vote is capped by bin, which tells walls, and points tell strays.

use super::super::sight::Sight;
use super::super::wall::behind;
use super::Scene;

/// The entries of one layer of a bin, and how many points each stands for.
type Layer = for<'a> fn(&'a Sight, usize) -> (&'a [f64], f64);

impl Scene<'_> {
    /// Points of a layer in the sector whose inverse range, next to the wall's and its tolerance, is as asked.
    fn count(&self, layer: Layer, asked: impl Fn(f64, f64, f64) -> bool) -> f64 {
        let count = |place: usize| {
            let bin = self.stretch.bin(place);
            let at = self
                .stretch
                .wall
                .line
                .inverse_range(self.sight.direction(bin));
            let tolerance = self.sight.tolerance(at);
            let (entries, each) = layer(self.sight, bin);
            let found = entries.iter().filter(|&&entry| asked(entry, at, tolerance));
            each * found.count() as f64
        };
        (self.inner.0..self.inner.1).map(count).sum()
    }

    /// Points of a layer on the wall.
    pub(super) fn points_on(&self, layer: Layer) -> f64 {
        self.count(layer, |entry, at, tolerance| {
            (entry - at).abs() <= tolerance
        })
    }

    /// Points of a layer behind the wall.
    pub(super) fn points_behind(&self, layer: Layer) -> f64 {
        self.count(layer, |entry, at, tolerance| entry < at - tolerance)
    }

    /// Points below the band on the wall.
    pub(super) fn sill(&self) -> f64 {
        let not_below = self.points_on(Sight::seen) + self.points_on(Sight::above);
        (self.points_on(Sight::any_height) - not_below).max(0.0)
    }

    pub(super) fn doubted(&self) -> f64 {
        let usual = self.sight.dirt() * self.points_behind(Sight::any_height);
        ((self.points_behind(Sight::doubtful) + 1.0) / (usual + 1.0)).ln()
    }

    pub(super) fn shallow(&self) -> f64 {
        let away = self.stretch.wall.line.distance();
        let is_shallow = |entry: f64, at: f64| (at / entry - 1.0) * away < SHALLOW;
        let shallow = self.count(Sight::any_height, |entry, at, tolerance| {
            entry < at - tolerance && is_shallow(entry, at)
        });
        shallow / self.points_behind(Sight::any_height).max(1.0)
    }

    pub(super) fn background(&self) -> f64 {
        let stretch = self.stretch;
        let points = |place: usize| {
            let bin = stretch.bin(place);
            let at = stretch.wall.line.inverse_range(self.sight.direction(bin));
            behind(self.sight, bin, at).0
        };
        let here: f64 = (self.inner.0..self.inner.1).map(points).sum();
        let (mut strays, mut bins) = (0.0, 0.0);
        for place in 0..stretch.len {
            let outside = place + 2 < self.inner.0 || place >= self.inner.1 + 2;
            if outside && stretch.votes(place).on >= 1.0 {
                strays += points(place);
                bins += 1.0;
            }
        }
        let usual = (strays + 0.5) / (bins + 1.0) * (self.inner.1 - self.inner.0) as f64;
        ((here + 0.5) / (usual + 0.5)).ln()
    }

    /// Median over the points behind of the median difference from the five before and after.
    pub(super) fn roughness(&self) -> f64 {
        let mut entries: Vec<f64> = Vec::new();
        for place in self.inner.0..self.inner.1 {
            let bin = self.stretch.bin(place);
            let line = &self.stretch.wall.line;
            let at = line.inverse_range(self.sight.direction(bin));
            let least = at - self.sight.tolerance(at);
            let seen = self.sight.any_height(bin).0.iter();
            entries.extend(seen.filter(|&&entry| entry < least));
        }
        let scatter = |k: usize| {
            let near = k.saturating_sub(5)..(k + 6).min(entries.len());
            let (mut apart, mut len) = ([0.0; 10], 0);
            for other in near.filter(|&other| other != k) {
                apart[len] = (entries[other] - entries[k]).abs();
                len += 1;
            }
            apart[..len].sort_unstable_by(f64::total_cmp);
            let middle = len.checked_sub(1).map(|last| apart[last / 2]);
            middle.map_or(ROUGHEST, |apart| apart / self.sight.sigma(entries[k]))
        };
        // A hundred of them tell.
        let places = (0..entries.len()).step_by(entries.len().div_ceil(100).max(1));
        let mut scatters: Vec<f64> = places.map(scatter).collect();
        let scatter = crate::profile::median(&mut scatters).unwrap_or(ROUGHEST);
        scatter.min(ROUGHEST).ln_1p()
    }
}

/// So many median ranges behind the wall, something may still be a niche.
const SHALLOW: f64 = 0.3;
/// Scatter is counted up to so many standard deviations.
const ROUGHEST: f64 = 20.0;
