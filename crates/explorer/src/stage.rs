//! The stages of one perception and planning cycle, so that a caller with a clock can time them.

use core::fmt;

/// One stage of the work between a map and a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Outlier removal.
    Clean,
    /// Proven-free space from rays.
    FreeSpace,
    /// K-means and hulls.
    Obstacles,
    /// Range profile and exits.
    Exits,
    /// Reachable places and the choice among them.
    Choose,
    /// RRT.
    Plan,
    /// Path refinement.
    Refine,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Self; 7] = [
        Self::Clean,
        Self::FreeSpace,
        Self::Obstacles,
        Self::Exits,
        Self::Choose,
        Self::Plan,
        Self::Refine,
    ];

    /// One word for tables and JSON.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::FreeSpace => "free_space",
            Self::Obstacles => "obstacles",
            Self::Exits => "exits",
            Self::Choose => "choose",
            Self::Plan => "plan",
            Self::Refine => "refine",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// Hears when stages begin and end. The library reads no clock; whoever has one measures here.
pub trait StageObserver {
    /// A stage begins.
    fn begin(&mut self, stage: Stage);
    /// The stage that began last has ended.
    fn end(&mut self, stage: Stage);
}

/// Hears nothing.
impl StageObserver for () {
    fn begin(&mut self, _: Stage) {}
    fn end(&mut self, _: Stage) {}
}

/// Runs `work` as `stage`.
pub(crate) fn staged<T>(
    observer: &mut dyn StageObserver,
    stage: Stage,
    work: impl FnOnce() -> T,
) -> T {
    observer.begin(stage);
    let result = work();
    observer.end(stage);
    result
}
