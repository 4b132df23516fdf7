//! A figure before it is drawn: a title, a plane seen from above, and layers of shapes in it.

/// Red, green, blue.
pub(crate) type Color = (u8, u8, u8);

/// Colours with one meaning in all figures.
pub(crate) mod color {
    use super::Color;

    pub(crate) const POINT: Color = (52, 86, 122);
    pub(crate) const OUTSIDE: Color = (198, 206, 216);
    pub(crate) const UNSEEN: Color = (206, 208, 212);
    pub(crate) const REMOVED: Color = (214, 72, 26);
    pub(crate) const SPOKE: Color = (64, 160, 80);
    pub(crate) const AGENT: Color = (214, 30, 42);
    pub(crate) const EXIT: Color = (240, 178, 0);
    pub(crate) const EXIT_RIM: Color = (110, 78, 0);
    pub(crate) const OBSTACLE: Color = (122, 92, 160);
    pub(crate) const FREE: Color = (150, 206, 214);
    pub(crate) const RAW_PATH: Color = (236, 130, 38);
    pub(crate) const PATH: Color = (24, 100, 210);
    pub(crate) const WALL: Color = (70, 74, 82);
}

/// A picture of things in one plane, equal scale on both axes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Figure {
    /// What is shown.
    pub(crate) title: String,
    /// Second line, smaller: counts, and what to look at.
    pub(crate) subtitle: String,
    /// Names of the two axes, with unit.
    pub(crate) axes: [String; 2],
    /// From bottom to top.
    pub(crate) layers: Vec<Layer>,
}

/// Shapes of one kind and colour, with one line in the legend.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    /// The legend's words; none for no line.
    pub(crate) label: Option<String>,
    pub(crate) color: Color,
    /// 0 transparent to 1.
    pub(crate) opacity: f64,
    pub(crate) shape: Shape,
    /// Whether the picture must reach as far as this layer.
    pub(crate) demand: Demand,
}

/// What a layer is made of, coordinates in the plane; widths and radii in pixels.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    Dots {
        at: Vec<[f64; 2]>,
        radius: f64,
    },
    Crosses {
        at: Vec<[f64; 2]>,
        arm: f64,
        width: f64,
    },
    Segments {
        ends: Vec<[[f64; 2]; 2]>,
        width: f64,
    },
    Line {
        through: Vec<[f64; 2]>,
        width: f64,
        dashed: bool,
    },
    Polygons {
        rings: Vec<Vec<[f64; 2]>>,
        rim: f64,
    },
}

/// How much of a layer a picture must show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Demand {
    All,
    /// All but the farthest of a cloud.
    Most,
    /// Whatever lies where the rest is.
    Nothing,
}

impl Layer {
    pub(crate) fn new(label: impl Into<String>, color: Color, shape: Shape) -> Self {
        Self {
            label: Some(label.into()),
            color,
            opacity: 1.0,
            shape,
            demand: Demand::All,
        }
    }

    /// The same without a line in the legend.
    pub(crate) fn unlabelled(mut self) -> Self {
        self.label = None;
        self
    }

    pub(crate) fn opacity(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }

    /// Lets the picture end before this layer does: for clouds, whose far points would shrink all else.
    pub(crate) fn may_leave_frame(mut self) -> Self {
        self.demand = Demand::Most;
        self
    }

    /// Lets the picture end wherever the other layers do: for what was found to be wrong.
    pub(crate) fn may_be_cut(mut self) -> Self {
        self.demand = Demand::Nothing;
        self
    }

    /// Every coordinate of the layer.
    pub(crate) fn coordinates(&self) -> Vec<[f64; 2]> {
        match &self.shape {
            Shape::Dots { at, .. } | Shape::Crosses { at, .. } => at.clone(),
            Shape::Segments { ends, .. } => ends.iter().flatten().copied().collect(),
            Shape::Line { through, .. } => through.clone(),
            Shape::Polygons { rings, .. } => rings.iter().flatten().copied().collect(),
        }
    }

    /// Whether there is anything to draw.
    pub(crate) fn is_empty(&self) -> bool {
        self.coordinates().is_empty()
    }
}
