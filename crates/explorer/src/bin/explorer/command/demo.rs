//! `explorer demo`: the default mission, with a report.
use crate::args::{Demo, Output};
use crate::failure::Failure;
pub(crate) fn run(_: &Demo, _: &Output) -> Result<(), Failure> {
    Err(Failure::internal("not yet"))
}
