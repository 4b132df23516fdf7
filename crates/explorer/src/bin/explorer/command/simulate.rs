//! `explorer simulate`: missions in the simulator.
use crate::args::{Output, Simulate};
use crate::failure::Failure;
pub(crate) fn run(_: &Simulate, _: &Output) -> Result<(), Failure> {
    Err(Failure::internal("not yet"))
}
