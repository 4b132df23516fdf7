//! Settings of the outlier removal and its named readings.

use super::cues::{Cues, DepthSource, ImageNeighbours, Tolerance};
use super::error::OutlierError;
use crate::minimax::Beta;

/// Settings of [`remove_outliers`](super::remove_outliers).
///
/// Lengths are multiples of the cloud's own spacing (the median distance to the fourth neighbour),
/// so no setting has a unit and a map of unknown scale is cleaned the same way in every scale.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlierConfig {
    /// Which score s(u, v) and which cost λ(v) the set function is made of.
    pub reading: Reading,
    /// λ, the cost of letting a point join, above 0. Paper: 0.6; studied readings 0.25; default 0.15.
    pub lambda: f64,
    /// β, the weight of the points already in. Paper: 1. A point joins above (1 + β) λ.
    pub beta: Beta,
    /// k, how many representatives a response may have, at least 1. Paper: 4; here 64. It is lowered
    /// to n · λ_min where needed, so that the function is not negative; n / 4 at λ = 0.25.
    pub max_representatives: usize,
    /// h, how far a representative reaches, in spacings, above 0; 3.5.
    pub reach: f64,
    /// Neighbours a row keeps at most, at least 4; studied 64, default 24.
    pub neighbours: usize,
    /// Support that makes a full representative, above 0; 2.
    pub support: f64,
    /// Points a linked component needs, so that it may represent, at least 1; 15. Half the cloud always does.
    pub min_component: usize,
    /// Adapts λ, reach, support and component size to how dirty and how large the cloud is: a strict
    /// first pass tells the dirt. λ above then holds for a quarter of dirt and more, up to 10,000 points,
    /// support and component size for 12 % and less and 5,000 points and more; the reach follows from the distances between
    /// the suspects, from 6/7 to double the value above, or down to half of it in small clouds. Off in the studied readings.
    pub adaptive: bool,
    /// What is made of the observations in [`Reading::Rays`] and [`Reading::Ranged`].
    pub rays: RayConfig,
    /// Closed form or the iterations of Algorithm 1: the same set.
    pub solver: Solver,
}

/// How observations are used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayConfig {
    /// Half-angle within which a ray passes a point, radians, above 0 and below 1; 0.01, H: 0.03.
    pub angle: f64,
    /// A ray violates a point that it passes if it ends beyond this many times its range; 1.2.
    pub margin: f64,
    /// Cameras whose rays are tested, evenly chosen, at least 1; 100.
    pub max_cameras: usize,
    /// Rise of λ(v) a violation in [`Reading::Rays`], at least 0, counted up to five; 0.05.
    pub violation_cost: f64,
    /// Neighbours whose normalised distances are averaged in [`Reading::Ranged`], at least 4; 20.
    pub neighbours: usize,
    /// Which of the weights below [`Reading::Ranged`] takes.
    pub source: DepthSource,
    /// Weights where points were triangulated; [`Cues::triangulated`].
    pub triangulated: Cues,
    /// Weights where depths were measured; [`Cues::measured`].
    pub measured: Cues,
    /// Weights where all points were seen from one position; [`Cues::from_position`].
    pub one_position: Cues,
}

/// Which score and cost the set function is made of. K = (1 − d/h)₊, d the Euclidean distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reading {
    /// A: s = 1 − 1/d as printed. Nothing can ever join: see the crate's documentation.
    Literal,
    /// D: s = K between different points.
    Nearest,
    /// F: s = w(u) K with the support w(u) = min(1, Σ K(u, ·) / need).
    Supported,
    /// G: F, where representatives in small detached components weigh nothing.
    Connected,
    /// H: G, and each ray that passes through a point raises its λ. Without observations it is G.
    Rays,
    /// Distances divided by viewing ranges, and costs from depth agreement and violations. Without
    /// observations a cloud that thins out away from the origin is taken as seen from there, as maps
    /// are whose frame is that of a camera; any other is read as G at the settings given. The default.
    Ranged,
}

/// How the minimax problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// The set that Algorithm 1 ends with, computed directly; one pass.
    ClosedForm,
    /// Algorithm 1 with a lazy greedy oracle, iteration by iteration.
    IterativeXGrowing,
}

impl Default for RayConfig {
    fn default() -> Self {
        Self {
            angle: 0.01,
            margin: 1.2,
            max_cameras: 100,
            violation_cost: 0.05,
            neighbours: 20,
            source: DepthSource::Observed,
            triangulated: Cues::triangulated(),
            measured: Cues::measured(),
            one_position: Cues::from_position(),
        }
    }
}

impl Default for OutlierConfig {
    fn default() -> Self {
        Self {
            reading: Reading::Ranged,
            lambda: 0.15,
            beta: Beta::Fixed(1.0),
            max_representatives: 64,
            reach: 3.5,
            neighbours: 24,
            support: 2.0,
            min_component: 15,
            adaptive: true,
            rays: RayConfig::default(),
            solver: Solver::ClosedForm,
        }
    }
}

impl OutlierConfig {
    /// The constants as printed: s = 1 − 1/d, λ = 0.6, k = 4, β = 1.
    ///
    /// With them nothing is ever found: s < 1 ≤ (1 + β) λ = 1.2, so no point can join and the
    /// algorithm returns the empty set of outliers after one iteration, for every cloud.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            reading: Reading::Literal,
            lambda: 0.6,
            max_representatives: 4,
            solver: Solver::IterativeXGrowing,
            ..Self::default()
        }
    }

    /// Reading D: a point is kept if it has a neighbour within 1.75 spacings.
    #[must_use]
    pub fn nearest() -> Self {
        Self::studied(Reading::Nearest)
    }

    /// Reading F with its studied constants.
    #[must_use]
    pub fn supported() -> Self {
        Self::studied(Reading::Supported)
    }

    /// Reading G with its studied constants.
    #[must_use]
    pub fn connected() -> Self {
        Self::studied(Reading::Connected)
    }

    /// Reading H with its studied constants.
    #[must_use]
    pub fn rays() -> Self {
        let rays = RayConfig {
            angle: 0.03,
            ..RayConfig::default()
        };
        Self {
            rays,
            ..Self::studied(Reading::Rays)
        }
    }

    fn studied(reading: Reading) -> Self {
        Self {
            reading,
            lambda: 0.25,
            neighbours: 64,
            adaptive: false,
            ..Self::default()
        }
    }

    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), OutlierError> {
        positive("lambda", self.lambda)?;
        if let Beta::Fixed(beta) = self.beta {
            positive("beta", beta)?;
        }
        at_least("max_representatives", self.max_representatives, 1)?;
        positive("reach", self.reach)?;
        at_least("neighbours", self.neighbours, 4)?;
        positive("support", self.support)?;
        at_least("min_component", self.min_component, 1)?;
        if self.reading == Reading::Literal {
            self.validate_literal()?;
        }
        self.rays.validate()
    }

    /// 1 − 1/d is no legal score; it stays harmless as long as nothing can join.
    fn validate_literal(&self) -> Result<(), OutlierError> {
        let value = (1.0 + self.beta.value(0)) * self.lambda;
        let range =
            "at least 1: below, the literal score 1 − 1/d is not submodular; take a reading";
        if value >= 1.0 {
            return Ok(());
        }
        Err(OutlierError::Setting {
            field: "(1 + beta) * lambda",
            value,
            range,
        })
    }
}

impl RayConfig {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), OutlierError> {
        positive("rays.angle", self.angle)?;
        if self.angle >= 1.0 {
            let (field, value) = ("rays.angle", self.angle);
            return Err(OutlierError::Setting {
                field,
                value,
                range: "above 0 and below 1",
            });
        }
        positive("rays.margin", self.margin)?;
        at_least("rays.max_cameras", self.max_cameras, 1)?;
        not_negative("rays.violation_cost", self.violation_cost)?;
        at_least("rays.neighbours", self.neighbours, 4)?;
        for cues in [self.triangulated, self.measured, self.one_position] {
            cues.validate()?;
        }
        Ok(())
    }
}

impl Cues {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), OutlierError> {
        for (field, value) in self.exponents() {
            not_negative(field, value)?;
        }
        let ImageNeighbours { count, rank, .. } = self.depth_neighbours;
        if count < 12 || rank < 1 || rank > count {
            return Err(OutlierError::Setting {
                field: "depth_neighbours",
                value: if count < 12 { count } else { rank } as f64,
                range: "at least 12 neighbours, and a rank from 1 to their number",
            });
        }
        match self.tolerance {
            Tolerance::Fixed(times)
            | Tolerance::BySpread(times)
            | Tolerance::ByDirt { least: times } => positive("tolerance", times),
        }
    }
}

fn positive(field: &'static str, value: f64) -> Result<(), OutlierError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(OutlierError::Setting {
        field,
        value,
        range: "finite and above 0",
    })
}

fn not_negative(field: &'static str, value: f64) -> Result<(), OutlierError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(OutlierError::Setting {
        field,
        value,
        range: "finite and at least 0",
    })
}

fn at_least(field: &'static str, value: usize, least: usize) -> Result<(), OutlierError> {
    if value >= least {
        return Ok(());
    }
    let range = if least == 1 {
        "at least 1"
    } else {
        "at least 4"
    };
    Err(OutlierError::Setting {
        field,
        value: value as f64,
        range,
    })
}
