//! Pictures: figures made of layers, drawn as SVG, and as PNG by rendering that SVG.

mod axes;
mod draw;
mod figure;
mod frame;
mod legend;
mod outline;
mod png;
mod save;
pub(crate) mod scene;
mod shapes;
pub(crate) mod trajectory;

pub(crate) use axes::TopView;
pub(crate) use figure::{Color, Figure, Layer, Shape, color};
pub(crate) use png::pixmap;
pub(crate) use save::save;
pub(crate) use trajectory::{AxisPair, Track};
