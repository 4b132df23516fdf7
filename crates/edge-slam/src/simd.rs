//! Runs a loop compiled for the widest vectors that the processor has.
//!
//! The loops are ordinary Rust that the compiler vectorises; integers and unfused floats give the same bits
//! whatever the width, so results do not depend on the machine.

use std::sync::OnceLock;

/// Calls `kernel`, compiled for the processor at hand. Kernels must be inlined into the closure to profit.
#[inline]
pub(crate) fn widest<R>(kernel: impl FnOnce() -> R) -> R {
    // Asking the processor once is cheaper than asking for every row of every image.
    static ARCH: OnceLock<pulp::Arch> = OnceLock::new();
    ARCH.get_or_init(pulp::Arch::new).dispatch(kernel)
}
