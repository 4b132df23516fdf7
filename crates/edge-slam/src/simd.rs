//! Runs a loop compiled for the widest vectors that the processor has.
//!
//! The loops are ordinary Rust that the compiler vectorises; integers and unfused floats give the same bits
//! whatever the width, so results do not depend on the machine.

use std::sync::OnceLock;

/// A loop with what it works on.
///
/// `run` must be marked `#[inline(always)]`, and so must all that it spends its time in: a function that stays outside is
/// compiled for the oldest processor. A closure would not do, nor a function passed by name: nothing can force these in.
pub(crate) trait Kernel {
    type Output;

    fn run(self) -> Self::Output;
}

/// Runs a kernel compiled for the processor at hand.
#[inline]
pub(crate) fn widest<K: Kernel>(kernel: K) -> K::Output {
    // Asking the processor once is cheaper than asking for every row of every image.
    static ARCH: OnceLock<pulp::Arch> = OnceLock::new();
    ARCH.get_or_init(pulp::Arch::new).dispatch(Widest(kernel))
}

struct Widest<K>(K);

impl<K: Kernel> pulp::WithSimd for Widest<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> K::Output {
        self.0.run()
    }
}
