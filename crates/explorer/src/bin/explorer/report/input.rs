//! What a report shows, as plain data: whoever has flown a mission or read a map fills it in.

/// Everything on the page.
#[derive(Debug, Clone, Default)]
pub(crate) struct ReportInput {
    pub(crate) title: String,
    /// One or two sentences under the title.
    pub(crate) lead: String,
    /// Name and value of each figure of the summary, in order.
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) scene: ViewerScene,
    pub(crate) figures: Vec<ReportFigure>,
    /// When and what, in order.
    pub(crate) story: Vec<(String, String)>,
    /// How to get this report again.
    pub(crate) command: String,
}

/// A picture with its words.
#[derive(Debug, Clone, Default)]
pub(crate) struct ReportFigure {
    /// For example "Figure 3b".
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) svg: String,
}

/// What the 3-D view shows, in the map's frame and unit; empty parts get no switch.
#[derive(Debug, Clone, Default)]
pub(crate) struct ViewerScene {
    /// Unit vector.
    pub(crate) up: [f64; 3],
    /// "m" or "map units".
    pub(crate) unit: String,
    pub(crate) kept: Vec<[f64; 3]>,
    pub(crate) removed: Vec<[f64; 3]>,
    pub(crate) obstacles: Vec<Mesh>,
    /// Centres of voxels that were seen through, and their edge.
    pub(crate) free: Vec<[f64; 3]>,
    pub(crate) voxel: f64,
    pub(crate) exits: Vec<[f64; 3]>,
    /// Paths as planned, before refinement.
    pub(crate) raw_paths: Vec<Vec<[f64; 3]>>,
    /// Paths as refined.
    pub(crate) paths: Vec<Vec<[f64; 3]>>,
    pub(crate) flown: Vec<[f64; 3]>,
}

/// A convex obstacle.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<[f64; 3]>,
    /// Indices of `vertices`.
    pub(crate) triangles: Vec<[usize; 3]>,
}
