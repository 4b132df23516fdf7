//! Point features: FAST corners, orientation, rotated BRIEF, ORB over a pyramid, matching, and KLT tracking.

mod align;
mod balance;
mod brief;
mod config;
mod fast;
mod harris;
mod klt;
mod matching;
mod orb;
mod orientation;
mod spread;

pub use align::{AlignConfig, AlignedMatch, align_matches};
pub use balance::balanced_corners;
pub use brief::Descriptor;
pub use config::{OrbConfig, OrbConfigError, Selection};
pub use fast::{Corner, fast_corners};
pub use klt::{KltConfig, klt_pyramid, track_points};
pub use matching::{
    BagOfWords, DirectIndex, GuidedConfig, Match, MatchConfig, MultiIndex, Prediction, Vocabulary,
    VocabularyConfig, VocabularyError, match_by_node, match_descriptors, match_guided,
    match_indexed,
};
pub use orb::{Features, Keypoint, OrbExtractor};
pub use spread::spread_corners;
