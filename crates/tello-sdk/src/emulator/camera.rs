//! The camera: when the next picture is due, and what becomes of it on its way into datagrams.

use super::faults::Faults;
use super::random::Random;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::time::Duration;

use crate::video::{PAYLOAD, datagrams, is_parameter_set};

/// Where the pictures come from: access units in Annex B byte-stream format, one per call.
pub trait VideoSource: Send {
    /// The next access unit, or `None` to skip this frame. Called every [`VideoSource::period`].
    fn next_unit(&mut self, now: Duration) -> Option<Vec<u8>>;

    /// The stream begins anew: the next unit should be a key frame.
    fn restart(&mut self) {}

    /// Time between frames.
    fn period(&self) -> Duration {
        Duration::from_nanos(33_333_333)
    }
}

/// A camera that is on or off, or none at all.
#[derive(Default)]
pub(crate) struct Camera {
    pub(crate) source: Option<Box<dyn VideoSource>>,
    pub(crate) next: Option<Duration>,
    /// Only every n-th picture is taken (`setfps`).
    pub(crate) every: u32,
    pub(crate) units: u64,
}

impl Camera {
    /// Begins a stream, or begins it anew with a key frame.
    pub(crate) fn start(&mut self, now: Duration) {
        if let Some(source) = &mut self.source {
            source.restart();
            self.next = self.next.or(Some(now));
        }
    }

    /// The unit that is due at `at`; `target` is how far the caller wants to get.
    pub(crate) fn shoot(&mut self, at: Duration, target: Duration) -> Option<Vec<u8>> {
        self.next.filter(|next| *next <= at)?;
        let source = self.source.as_mut()?;
        let period = source.period().max(Duration::from_millis(1)) * self.every.max(1);
        // A camera that is slower than its period skips pictures instead of falling behind for ever.
        let late = at + period * 2 < target;
        self.next = Some(if late { target } else { at } + period);
        let unit = source.next_unit(at)?;
        self.units += 1;
        Some(unit)
    }
}

/// Pads a unit with zeros, which a byte stream may end with, so that its last datagram is a full one.
pub(crate) fn pad_to_multiple(unit: &mut Vec<u8>) {
    let sets: usize = datagrams(unit)
        .take_while(|datagram| is_parameter_set(datagram))
        .map(<[u8]>::len)
        .sum();
    let length = (unit.len() - sets).next_multiple_of(PAYLOAD);
    unit.resize(sets + length, 0);
}

/// Whether a datagram gets lost because it holds parameter sets.
pub(crate) fn loses_parameter_set(datagram: &[u8], faults: &Faults, random: &mut Random) -> bool {
    is_parameter_set(datagram) && random.chance(faults.parameter_set_loss)
}
