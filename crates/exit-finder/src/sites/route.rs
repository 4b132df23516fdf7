//! The nearest unvisited portal along known connections (Dijkstra over the sites).

use super::error::SiteError;
use super::graph::SiteGraph;
use super::portal::{Portal, PortalId, PortalState};
use super::site::SiteId;
use crate::vector::distance;

/// Where to go next.
#[derive(Debug, Clone, PartialEq)]
pub struct NextPortal {
    /// The portal to enter.
    pub portal: PortalId,
    /// The sites to pass, from the start to the portal's own site; one entry when it is here.
    pub route: Vec<SiteId>,
    /// Length of the way to the middle of the portal, map units, as the crow flies between sites.
    pub length: f64,
}

impl SiteGraph {
    /// The best unvisited portal of `from`; when it has none, the best one of the nearest site that
    /// has. `None`: nothing is left, the reachable space is explored. O(sites² + links + portals).
    ///
    /// # Errors
    /// [`SiteError::UnknownSite`].
    pub fn next_portal(&self, from: SiteId) -> Result<Option<NextPortal>, SiteError> {
        let count = self.sites.len();
        if from.0 >= count {
            return Err(SiteError::UnknownSite {
                site: from.0,
                count,
            });
        }
        let (lengths, previous) = self.shortest_ways(from);
        let open = self.portals.iter().filter(|portal| {
            portal.state == PortalState::Unvisited && lengths[portal.from.0].is_finite()
        });
        let best = open.min_by(|a, b| {
            lengths[a.from.0]
                .total_cmp(&lengths[b.from.0])
                .then(b.score.total_cmp(&a.score))
                .then(a.id.cmp(&b.id))
        });
        Ok(best.map(|portal| self.way_to(portal, &lengths, &previous)))
    }

    fn way_to(&self, portal: &Portal, lengths: &[f64], previous: &[usize]) -> NextPortal {
        let mut route = vec![portal.from];
        let mut at = portal.from.0;
        while previous[at] != at {
            at = previous[at];
            route.push(SiteId(at));
        }
        route.reverse();
        let last = distance(self.sites[portal.from.0].position, portal.middle());
        NextPortal {
            portal: portal.id,
            route,
            length: lengths[portal.from.0] + last,
        }
    }

    /// Lengths of the shortest ways from a site, and the site before each on its way.
    fn shortest_ways(&self, from: SiteId) -> (Vec<f64>, Vec<usize>) {
        let n = self.sites.len();
        let mut lengths = vec![f64::INFINITY; n];
        let mut previous: Vec<usize> = (0..n).collect();
        let mut done = vec![false; n];
        lengths[from.0] = 0.0;
        for _ in 0..n {
            let open = (0..n).filter(|&i| !done[i] && lengths[i].is_finite());
            let Some(at) = open.min_by(|&a, &b| lengths[a].total_cmp(&lengths[b])) else {
                break;
            };
            done[at] = true;
            for (other, cost) in self.neighbours(at) {
                if lengths[at] + cost < lengths[other] {
                    lengths[other] = lengths[at] + cost;
                    previous[other] = at;
                }
            }
        }
        (lengths, previous)
    }

    fn neighbours(&self, site: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.links.iter().filter_map(move |&(a, b, portal)| {
            let other = if a.0 == site { b.0 } else { a.0 };
            let touches = a.0 == site || b.0 == site;
            let [here, there] = [site, other].map(|i| self.sites[i].position);
            let cost = match portal {
                Some(id) => {
                    let middle = self.portals[id.0].middle();
                    distance(here, middle) + distance(middle, there)
                }
                None => distance(here, there),
            };
            touches.then_some((other, cost))
        })
    }
}
