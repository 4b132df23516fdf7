//! A place where the agent looked around, and the polygon it saw from there.

use super::anchor::Anchor;
use crate::angle::wrap;
use crate::exit::ExitReport;
use crate::plane::AffinePlane;
use crate::vector::sub;

/// Number of a site, counted from 0 in the order of scanning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SiteId(pub usize);

/// A scan site.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// Its number.
    pub id: SiteId,
    /// Where the agent was, world.
    pub position: [f64; 3],
    /// The plane of the scan.
    pub plane: AffinePlane,
    /// The star-shaped polygon seen from here: one range per bin of the profile, map units. Openings
    /// reach as far as their jambs, sectors never looked at have range 0.
    pub polygon: Vec<f64>,
    /// Anchors of the position and of the two ends of unit axes in the plane.
    pub(crate) anchors: [Anchor; 3],
}

impl Site {
    /// The polygon of a report: the median range per bin (the neighbours' for an empty bin), cut at
    /// the chord of each exit.
    pub(crate) fn polygon_of(report: &ExitReport) -> Vec<f64> {
        let profile = &report.profile;
        let n = profile.bins.len();
        let cut = |bin: usize| {
            let bearing = profile.centre_of(bin);
            if report.unseen.iter().any(|sector| sector.contains(bearing)) {
                return 0.0;
            }
            let within = report
                .exits
                .iter()
                .find(|exit| exit.sector.contains(bearing));
            let range = nearest_known(profile.bins.len(), bin, |i| profile.bins[i].median);
            match within {
                Some(exit) => {
                    let jamb = |k: usize| {
                        let d = sub(exit.jambs[k], profile.agent);
                        profile
                            .plane
                            .project(crate::vector::add(profile.plane.origin(), d))
                    };
                    let reach = [jamb(0), jamb(1)].map(|q| q[0].hypot(q[1]));
                    range.min(reach[0].min(reach[1]))
                }
                None => range,
            }
        };
        (0..n).map(cut).collect()
    }

    /// Whether a world point lies in the polygon shrunk by `margin` (a length).
    pub fn contains(&self, point: [f64; 3], margin: f64) -> bool {
        let q = self.plane.project(point);
        let centre = self.plane.project(self.position);
        let (dx, dy) = (q[0] - centre[0], q[1] - centre[1]);
        let range = dx.hypot(dy);
        let n = self.polygon.len();
        if !range.is_finite() || n == 0 {
            return false;
        }
        let bin = (wrap(dy.atan2(dx)) / std::f64::consts::TAU * n as f64) as usize;
        range < self.polygon[bin.min(n - 1)] - margin
    }
}

/// Range of the bin or of the nearest one that holds points (up to a quarter turn), else 0.
fn nearest_known(n: usize, bin: usize, range: impl Fn(usize) -> f64) -> f64 {
    (0..=n / 4)
        .flat_map(|k| [(bin + k) % n, (bin + n - k) % n])
        .map(range)
        .find(|range| range.is_finite())
        .unwrap_or(0.0)
}
