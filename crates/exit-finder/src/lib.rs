#![doc = include_str!("../README.md")]

mod angle;
mod config;
mod error;
mod exit;
mod finder;
mod passage;
mod plane;
mod plane_fit;
mod points;
mod profile;
mod rule;
mod sector;
pub mod sites;
mod vector;
mod view;

pub use config::{
    ExitConfig, GapTopology, HeightBand, Numbering, PaperReading, RangeAware, RangeFrom, Rule,
};
pub use error::{ExitError, PlaneError};
pub use exit::{Exit, ExitKind, ExitReport, Rejected, Rejection};
pub use finder::{candidates_of_cleaned, find_exits};
pub use passage::{BandReading, BandState, Passage, Shape};
pub use plane::{AffinePlane, BASIS_TOLERANCE, MIN_SPREAD_RATIO};
pub use plane_fit::PlaneFit;
pub use points::PointLike;
pub use profile::{BinStats, LiveProfile, PointCounts, RangeProfile, Strip};
pub use rule::{
    CUE_NAMES, CUES, Opening, SECOND_CUES, ScoreParts, SecondLook, candidates_of_profile,
    exits_of_profile,
};
pub use sector::Sector;
pub use view::{ExitView, Gaze, Ray};
