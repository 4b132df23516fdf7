//! The graph: admission of exits as portals, their states, map corrections.

use super::anchor::KeyframePose;
use super::correction::{check_poses, hang, site_marks};
use super::error::SiteError;
use super::portal::{Portal, PortalId, PortalState};
use super::site::{Site, SiteId};
use crate::exit::{Exit, ExitReport};
use crate::vector::{add, distance, is_finite, scale, sub};

/// Distances of the graph, all in map units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SiteConfig {
    /// How far inside an earlier polygon an exit point counts as explored. Metric maps: 0.3 m.
    pub shrink: f64,
    /// Exits whose middles are nearer than this are one portal; positive. Metric maps: 0.5 m.
    pub merge: f64,
    /// Exit points nearer than this to the flown trajectory lead back. Metric maps: 0.75 m.
    pub flown: f64,
    /// Exit points with `crowd` keyframes within this distance lead back. Metric maps: 1 m.
    pub near_keyframes: f64,
    /// How many keyframes make a crowd; 3. Zero switches the cue off.
    pub crowd: usize,
    /// Distance of virtual points on a closed portal. Metric maps: 2 cm.
    pub spacing: f64,
    /// Bins of the profile the virtual points are for: at least two points fall into each; 360.
    pub bins: usize,
}

impl SiteConfig {
    /// The metric distances above for a map of `units_per_metre`. While the scale is unknown, pass
    /// half the median range of the first scan: rooms are some metres wide.
    pub fn for_scale(units_per_metre: f64) -> Self {
        Self {
            shrink: 0.3 * units_per_metre,
            merge: 0.5 * units_per_metre,
            flown: 0.75 * units_per_metre,
            near_keyframes: units_per_metre,
            crowd: 3,
            spacing: 0.02 * units_per_metre,
            bins: 360,
        }
    }

    fn validate(&self) -> Result<(), SiteError> {
        let distances = [
            ("shrink", self.shrink, 0.0),
            ("merge", self.merge, f64::MIN_POSITIVE),
            ("flown", self.flown, 0.0),
            ("near_keyframes", self.near_keyframes, 0.0),
            ("spacing", self.spacing, f64::MIN_POSITIVE),
            ("bins", self.bins as f64, 8.0),
        ];
        for (field, value, least) in distances {
            if !(value >= least && value.is_finite()) {
                let range = "non-negative; merge and spacing positive; bins from 8";
                return Err(SiteError::Config {
                    field,
                    value,
                    range,
                });
            }
        }
        Ok(())
    }
}

/// What the agent did and where the map's keyframes are, when a site is added.
#[derive(Debug, Clone, Copy, Default)]
pub struct History<'a> {
    /// Epoch of the map, see [`SiteGraph::reset`].
    pub epoch: u64,
    /// Positions flown before this scan, world. May be empty.
    pub trajectory: &'a [[f64; 3]],
    /// Keyframes of the map. May be empty, then nothing can be re-anchored.
    pub keyframes: &'a [KeyframePose],
}

/// What became of the exits of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Admission {
    /// The new site.
    pub site: SiteId,
    /// The new portals, best exit first.
    pub portals: Vec<PortalId>,
    /// Exits that are no new portals: index in the report and reason.
    pub refused: Vec<(usize, Refusal)>,
    /// Older portals that this scan showed to lead here: now exhausted.
    pub exhausted: Vec<PortalId>,
}

/// Why an exit is not a new portal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// The exit point lies in the polygon of an earlier site.
    Explored(SiteId),
    /// It is this portal, seen again.
    Known(PortalId),
    /// The exit point lies on the flown trajectory.
    Flown,
    /// The exit point lies among keyframes.
    AmongKeyframes,
}

/// Sites, portals and the connections flown.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteGraph {
    pub(super) config: SiteConfig,
    pub(super) epoch: u64,
    pub(super) sites: Vec<Site>,
    pub(super) portals: Vec<Portal>,
    /// Flown connections between sites, with the portal they lead through.
    pub(super) links: Vec<(SiteId, SiteId, Option<PortalId>)>,
    /// The portal that was entered since the last scan.
    entered: Option<PortalId>,
}

impl Default for SiteGraph {
    /// An empty graph of epoch 0 for a map in metres.
    fn default() -> Self {
        Self::empty(SiteConfig::for_scale(1.0))
    }
}

impl SiteGraph {
    /// An empty graph of epoch 0.
    ///
    /// # Errors
    /// [`SiteError::Config`].
    pub fn new(config: SiteConfig) -> Result<Self, SiteError> {
        config.validate()?;
        Ok(Self::empty(config))
    }

    fn empty(config: SiteConfig) -> Self {
        Self {
            config,
            epoch: 0,
            sites: Vec::new(),
            portals: Vec::new(),
            links: Vec::new(),
            entered: None,
        }
    }

    /// Takes other distances from now on: the scale of a monocular map is known better with every metre flown. What was admitted
    /// stays.
    ///
    /// # Errors
    /// [`SiteError::Config`]; the former distances stay then.
    pub fn set_config(&mut self, config: SiteConfig) -> Result<(), SiteError> {
        config.validate()?;
        self.config = config;
        Ok(())
    }

    /// The epoch all coordinates belong to.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// All sites in the order of scanning.
    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    /// All portals in the order of discovery.
    pub fn portals(&self) -> &[Portal] {
        &self.portals
    }

    /// The portals nobody went through, in the order of discovery: for a caller that knows the true lengths of the ways and chooses
    /// by itself. [`Self::next_portal`] chooses by lengths as the crow flies.
    pub fn unvisited(&self) -> impl Iterator<Item = &Portal> {
        let open = |portal: &&Portal| portal.state == PortalState::Unvisited;
        self.portals.iter().filter(open)
    }

    /// Whether an earlier site saw past this place by more than the shrinkage: it is explored.
    pub fn is_explored(&self, place: [f64; 3]) -> bool {
        self.explorer_of(place).is_some()
    }

    /// Adds the place of a report as a site, linked to the site the agent came from, and its exits as
    /// portals. O(exits · (sites + portals + trajectory + keyframes)).
    ///
    /// # Errors
    /// [`SiteError::Epoch`], [`SiteError::Pose`].
    pub fn add_site(
        &mut self,
        report: &ExitReport,
        history: &History<'_>,
    ) -> Result<Admission, SiteError> {
        if history.epoch != self.epoch {
            return Err(SiteError::Epoch {
                graph: self.epoch,
                given: history.epoch,
            });
        }
        check_poses(history.keyframes)?;
        let site = SiteId(self.sites.len());
        let refusals: Vec<Option<Refusal>> = report
            .exits
            .iter()
            .map(|exit| self.refusal(exit, history))
            .collect();
        self.link_to(site);
        self.sites.push(new_site(site, report, history.keyframes));
        let exhausted = self.exhaust_portals_into(site);

        let (mut portals, mut refused) = (Vec::new(), Vec::new());
        for (index, (exit, refusal)) in report.exits.iter().zip(refusals).enumerate() {
            // Two exits of one report can be nearer than the merge distance, too.
            match refusal.or_else(|| self.known(exit).map(Refusal::Known)) {
                Some(reason) => refused.push((index, reason)),
                None => portals.push(self.push_portal(site, exit, history.keyframes)),
            }
        }
        Ok(Admission {
            site,
            portals,
            refused,
            exhausted,
        })
    }

    /// Marks a portal as entered. Call it before flying; the next site lies behind it.
    ///
    /// # Errors
    /// [`SiteError::UnknownPortal`], [`SiteError::Used`].
    pub fn traverse(&mut self, portal: PortalId) -> Result<(), SiteError> {
        self.leave_unvisited(portal, PortalState::Traversed)?;
        self.entered = Some(portal);
        Ok(())
    }

    /// Marks a portal as impassable: planning failed twice, or no progress for twenty seconds. A
    /// portal whose passage failed after [`SiteGraph::traverse`] may be blocked, too.
    ///
    /// # Errors
    /// [`SiteError::UnknownPortal`], [`SiteError::Used`] when it is exhausted, blocked, or leads to a
    /// site.
    pub fn block(&mut self, portal: PortalId) -> Result<(), SiteError> {
        if self.entered == Some(portal) {
            self.entered = None;
            self.portals[portal.0].state = PortalState::Blocked;
            return Ok(());
        }
        self.leave_unvisited(portal, PortalState::Blocked)
    }

    /// Points that close the used portals within twice `radius` of the agent, for
    /// [`crate::ExitView::virtual_points`]. They must never reach an obstacle builder.
    pub fn virtual_points(&self, agent: [f64; 3], radius: f64) -> Vec<[f64; 3]> {
        let near = |portal: &&Portal| {
            portal.is_closed() && distance(portal.middle(), agent) <= 2.0 * radius
        };
        self.portals
            .iter()
            .filter(near)
            .flat_map(|portal| self.closing(portal, agent))
            .collect()
    }

    /// Starts a new epoch: the map was reset and all coordinates are void.
    pub fn reset(&mut self, epoch: u64) {
        self.epoch = epoch;
        self.sites.clear();
        self.portals.clear();
        self.links.clear();
        self.entered = None;
    }

    fn refusal(&self, exit: &Exit, history: &History<'_>) -> Option<Refusal> {
        let config = &self.config;
        let known = self.known(exit).map(Refusal::Known);
        let explored = || self.explorer_of(exit.position).map(Refusal::Explored);
        let within = |reach: f64| move |p: [f64; 3]| distance(p, exit.position) < reach;
        let flown = || {
            history
                .trajectory
                .iter()
                .copied()
                .any(within(config.flown))
                .then_some(Refusal::Flown)
        };
        let crowded = || {
            let near = history.keyframes.iter().map(|pose| pose.position);
            let count = near.filter(|&p| within(config.near_keyframes)(p)).count();
            (config.crowd > 0 && count >= config.crowd).then_some(Refusal::AmongKeyframes)
        };
        known.or_else(explored).or_else(flown).or_else(crowded)
    }

    /// The first site whose shrunk polygon holds the place.
    fn explorer_of(&self, place: [f64; 3]) -> Option<SiteId> {
        let mut sites = self.sites.iter();
        let site = sites.find(|site| site.contains(place, self.config.shrink))?;
        Some(site.id)
    }

    fn known(&self, exit: &Exit) -> Option<PortalId> {
        let middle = scale(add(exit.jambs[0], exit.jambs[1]), 0.5);
        let same = |portal: &&Portal| distance(portal.middle(), middle) < self.config.merge;
        self.portals.iter().find(same).map(|portal| portal.id)
    }

    fn link_to(&mut self, site: SiteId) {
        let entered = self.entered.take();
        if let Some(portal) = entered.and_then(|id| self.portals.get_mut(id.0)) {
            portal.to = Some(site);
            self.links.push((portal.from, site, Some(portal.id)));
        } else if let Some(last) = self.sites.last() {
            self.links.push((last.id, site, None));
        }
    }

    fn exhaust_portals_into(&mut self, site: SiteId) -> Vec<PortalId> {
        let Some(polygon) = self.sites.get(site.0) else {
            return Vec::new();
        };
        let mut exhausted = Vec::new();
        for portal in &mut self.portals {
            let inside = polygon.contains(portal.exit, self.config.shrink);
            if inside && portal.state == PortalState::Unvisited {
                portal.state = PortalState::Exhausted;
                exhausted.push(portal.id);
            }
        }
        exhausted
    }

    fn push_portal(&mut self, from: SiteId, exit: &Exit, keyframes: &[KeyframePose]) -> PortalId {
        let id = PortalId(self.portals.len());
        let [a, b] = exit.jambs;
        self.portals.push(Portal {
            id,
            from,
            to: None,
            jambs: exit.jambs,
            exit: exit.position,
            score: exit.score,
            state: PortalState::Unvisited,
            anchors: hang([a, b, exit.position], keyframes),
        });
        id
    }

    fn leave_unvisited(&mut self, id: PortalId, state: PortalState) -> Result<(), SiteError> {
        let count = self.portals.len();
        let portal = self.portals.get_mut(id.0).ok_or(SiteError::UnknownPortal {
            portal: id.0,
            count,
        })?;
        if portal.state != PortalState::Unvisited {
            return Err(SiteError::Used {
                portal: id.0,
                state: portal.state,
            });
        }
        portal.state = state;
        Ok(())
    }

    fn closing(&self, portal: &Portal, agent: [f64; 3]) -> Vec<[f64; 3]> {
        let [a, b] = portal.jambs;
        let length = distance(a, b);
        if !(is_finite(a) && is_finite(b)) {
            return Vec::new();
        }
        let nearest = distance(a, agent)
            .min(distance(b, agent))
            .min(distance(portal.middle(), agent));
        let per_bin = 0.5 * nearest * std::f64::consts::TAU / self.config.bins as f64;
        let step = self
            .config
            .spacing
            .min(per_bin)
            .max(length / MOST_VIRTUAL as f64);
        let count = (length / step).ceil().max(1.0) as usize;
        (0..=count)
            .map(|k| add(a, scale(sub(b, a), k as f64 / count as f64)))
            .collect()
    }
}

/// Virtual points of one portal, at most.
const MOST_VIRTUAL: usize = 4096;

fn new_site(id: SiteId, report: &ExitReport, keyframes: &[KeyframePose]) -> Site {
    let (position, plane) = (report.profile.agent, report.profile.plane);
    let anchors = hang(site_marks(position, &plane), keyframes);
    Site {
        id,
        position,
        plane,
        polygon: Site::polygon_of(report),
        anchors,
    }
}
