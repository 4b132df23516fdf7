//! report.html: one file that opens offline, with a 3-D view, figures and a table.

pub(crate) mod figures;
mod flight;
mod html;
mod input;
mod number;
mod viewer;

pub(crate) use flight::of_flight;
pub(crate) use html::html;
