//! What has been explored: scan sites, the exits seen from them, and which of those still lead anywhere new.
//!
//! An exit is dropped when it leads into what an earlier site already saw or close to where the drone has flown (the paper's
//! "explored areas are closed off"), so every exit is entered at most once and the mission ends after finitely many scans.
//! Everything is in map units of one epoch; a new epoch starts a new atlas.

use exit_finder::{ExitReport, RangeProfile};
use nalgebra::{Point3, Vector3};

/// What became of an exit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortalState {
    /// Nobody has been through.
    Unvisited,
    /// The drone flew through.
    Traversed,
    /// No way through was found.
    Blocked,
}

/// One exit that was seen from a site.
#[derive(Debug, Clone, PartialEq)]
pub struct Portal {
    /// Index of the site that saw it.
    pub site: usize,
    /// The point behind it.
    pub through: Point3<f64>,
    /// Its two sides.
    pub jambs: [Point3<f64>; 2],
    /// The exit finder's score.
    pub score: f64,
    /// What became of it.
    pub state: PortalState,
    /// How often the drone came nearer to look again.
    pub approaches: usize,
    /// Least distance from which the drone has looked at it.
    pub closest: f64,
    /// Flights towards it that ended before they arrived.
    pub failures: usize,
}

/// One place from which the drone looked all around.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// Where.
    pub position: Point3<f64>,
    /// What lay how far in which direction.
    pub profile: RangeProfile,
}

/// Distances in map units that decide what counts as known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownLimits {
    /// Exits nearer than this to the flown path lead to known space.
    pub path: f64,
    /// A site knows what lies this much inside its profile.
    pub shrink: f64,
}

/// All sites and portals of one epoch.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Atlas {
    sites: Vec<Site>,
    portals: Vec<Portal>,
}

impl Atlas {
    /// The sites, oldest first.
    #[must_use]
    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    /// The portals, oldest first.
    #[must_use]
    pub fn portals(&self) -> &[Portal] {
        &self.portals
    }

    /// The portal with this index, to change its state.
    pub fn portal_mut(&mut self, index: usize) -> Option<&mut Portal> {
        self.portals.get_mut(index)
    }

    /// Adds the site at which `report` was made, and those of its exits that do not lead to known places; `trail` is the
    /// flown path. Returns how many exits were new.
    pub fn add_site(
        &mut self,
        position: Point3<f64>,
        report: &ExitReport,
        trail: impl Iterator<Item = Point3<f64>> + Clone,
        limits: &KnownLimits,
    ) -> usize {
        let site = self.sites.len();
        let before = self.portals.len();
        for exit in &report.exits {
            let through = Point3::from(exit.position);
            let flown = trail
                .clone()
                .any(|place| (place - through).norm() < limits.path);
            if flown
                || self.is_known(&through, limits.shrink)
                || self.is_listed(&through, limits.path)
            {
                continue;
            }
            self.portals.push(Portal {
                site,
                through,
                jambs: exit.jambs.map(Point3::from),
                score: exit.score,
                state: PortalState::Unvisited,
                approaches: 0,
                closest: f64::INFINITY,
                failures: 0,
            });
        }
        self.sites.push(Site {
            position,
            profile: report.profile.clone(),
        });
        self.portals.len() - before
    }

    /// Whether an earlier site saw past `place`, by more than `shrink`.
    #[must_use]
    pub fn is_known(&self, place: &Point3<f64>, shrink: f64) -> bool {
        self.sites.iter().any(|site| site.sees(place, shrink))
    }

    /// Whether the same exit was already seen from another site.
    fn is_listed(&self, through: &Point3<f64>, within: f64) -> bool {
        self.portals
            .iter()
            .any(|portal| (portal.through - through).norm() < within)
    }

    /// Marks every unvisited portal near `place` as traversed: the drone is there.
    pub fn arrive(&mut self, place: &Point3<f64>, within: f64) {
        for portal in &mut self.portals {
            if portal.state == PortalState::Unvisited && (portal.through - place).norm() < within {
                portal.state = PortalState::Traversed;
            }
        }
    }

    /// Indices of the portals nobody has been through, those of the newest site first by score, then older ones.
    #[must_use]
    pub fn unvisited(&self) -> Vec<usize> {
        let newest = self.sites.len().saturating_sub(1);
        let mut open: Vec<usize> = (0..self.portals.len())
            .filter(|&index| {
                self.portals
                    .get(index)
                    .is_some_and(|p| p.state == PortalState::Unvisited)
            })
            .collect();
        let rank = |index: &usize| {
            self.portals
                .get(*index)
                .map(|p| (p.site != newest, -p.score))
        };
        open.sort_by(|a, b| match (rank(a), rank(b)) {
            (Some(a), Some(b)) => a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)),
            _ => core::cmp::Ordering::Equal,
        });
        open
    }
}

impl Site {
    /// Whether `place` lies inside this site's range profile, at least `shrink` in front of what was seen there.
    #[must_use]
    pub fn sees(&self, place: &Point3<f64>, shrink: f64) -> bool {
        let plane = &self.profile.plane;
        let offset: Vector3<f64> = place - self.position;
        // Straight above or below the site has no bearing, and is known.
        let Some(bearing) = plane.bearing(offset.into()) else {
            return true;
        };
        let normal = Vector3::from(plane.normal());
        let distance = (offset - normal * normal.dot(&offset)).norm();
        let bin = self.profile.bins.get(self.profile.bin_of(bearing));
        bin.is_some_and(|bin| bin.median.is_finite() && distance < bin.median - shrink)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};

    const LIMITS: KnownLimits = KnownLimits {
        path: 0.6,
        shrink: 0.5,
    };

    /// A room of 6 by 6 with a door of 20 degrees towards each bearing, behind which a wall is seen at range 8.
    fn report(doors_deg: &[f64]) -> ExitReport {
        let points: Vec<[f64; 3]> = (0..720)
            .map(|i| (f64::from(i) * 0.5 + 0.25).to_radians())
            .map(|bearing| {
                let in_door =
                    |door: &f64| (bearing - door.to_radians()).cos() > 10f64.to_radians().cos();
                let range = if doors_deg.iter().any(in_door) {
                    8.0
                } else {
                    3.0 / bearing.cos().abs().max(bearing.sin().abs())
                };
                [range * bearing.cos(), range * bearing.sin(), 0.0]
            })
            .collect();
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let view = ExitView::default();
        find_exits(&points, [0.0; 3], &plane, &view, &ExitConfig::default()).unwrap()
    }

    #[test]
    fn lists_each_exit_once() {
        let (mut atlas, report) = (Atlas::default(), report(&[0.0, 120.0]));
        let none = core::iter::empty();
        assert_eq!(
            atlas.add_site(Point3::origin(), &report, none.clone(), &LIMITS),
            2
        );
        assert_eq!(atlas.add_site(Point3::origin(), &report, none, &LIMITS), 0);
        assert_eq!((atlas.sites().len(), atlas.portals().len()), (2, 2));
    }

    #[test]
    fn leaves_out_an_exit_that_was_flown_through() {
        let (mut atlas, report) = (Atlas::default(), report(&[0.0, 120.0]));
        let through = Point3::from(report.exits[0].position);
        let trail = [Point3::origin(), through].into_iter();
        assert_eq!(atlas.add_site(Point3::origin(), &report, trail, &LIMITS), 1);
    }

    #[test]
    fn leaves_out_an_exit_into_what_an_earlier_site_saw() {
        let mut atlas = Atlas::default();
        let none = core::iter::empty();
        atlas.add_site(Point3::origin(), &report(&[]), none.clone(), &LIMITS);
        // The same room told by a second scan whose doors lie inside the first room: a gap between thin points, not a way out.
        let mut inside = report(&[0.0]);
        inside.exits[0].position = [1.0, 0.0, 0.0];
        assert_eq!(atlas.add_site(Point3::origin(), &inside, none, &LIMITS), 0);
        assert!(atlas.is_known(&Point3::new(-1.0, 0.0, 0.0), LIMITS.shrink));
        assert!(!atlas.is_known(&Point3::new(-2.8, 0.0, 0.0), LIMITS.shrink));
        assert!(!atlas.is_known(&Point3::new(-4.0, 0.0, 0.0), LIMITS.shrink));
    }

    #[test]
    fn a_portal_that_was_arrived_at_is_not_offered_again() {
        let (mut atlas, report) = (Atlas::default(), report(&[0.0, 120.0]));
        atlas.add_site(Point3::origin(), &report, core::iter::empty(), &LIMITS);
        let order = atlas.unvisited();
        let scores = order.iter().map(|&i| atlas.portals()[i].score);
        assert!(order.len() == 2 && scores.is_sorted_by(|a, b| a >= b));
        let first = atlas.portals()[order[0]].through;
        atlas.arrive(&first, 0.3);
        assert_eq!(atlas.unvisited(), [order[1]]);
        assert_eq!(atlas.portals()[order[0]].state, PortalState::Traversed);
        if let Some(portal) = atlas.portal_mut(order[1]) {
            portal.state = PortalState::Blocked;
        }
        assert!(atlas.unvisited().is_empty());
    }
}
