//! Puts access units together from datagrams, and says how sure it is of each.
//!
//! Text mode: datagrams carry no number. A datagram that begins with the start code of a new picture ends the unit
//! before it; one shorter than [`PAYLOAD`] ends its own unit early. A unit that is an exact multiple of [`PAYLOAD`]
//! looks like one whose last datagram was lost: it is delivered as [`Integrity::Suspect`], at the next start code or
//! after [`AssemblerConfig::idle`]. **A datagram lost from the middle cannot be seen in text mode**: units of several
//! datagrams are [`Integrity::Unverified`] at best, and only a decoder can tell.
//! Binary mode: a two-byte header numbers frame and datagram, so every loss is seen.
//!
//! Memory: one unit of at most [`AssemblerConfig::max_unit`] bytes. Cost: one pass over the bytes.

use super::annex_b::{NalKind, leading_header, nal_units};
use super::datagrams::PAYLOAD;
use alloc::vec::Vec;
use core::time::Duration;

/// How the datagrams are numbered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Framing {
    /// Not at all: the text protocol.
    #[default]
    Text,
    /// Frame number, then datagram number with 0x80 on the last: the binary protocol.
    Binary,
}

/// Settings of an [`Assembler`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AssemblerConfig {
    /// How the datagrams are numbered.
    pub framing: Framing,
    /// Largest access unit, bytes; a longer one is dropped. Default 512 KiB (key frames have about 35 kB).
    pub max_unit: usize,
    /// A unit without a short last datagram is delivered after this long without another. Default 100 ms: the next unit
    /// ends it sooner, and a link that stalls in the middle of a unit must not cut it in two.
    pub idle: Duration,
}

impl Default for AssemblerConfig {
    fn default() -> Self {
        Self {
            framing: Framing::Text,
            max_unit: 512 * 1024,
            idle: Duration::from_millis(100),
        }
    }
}

/// How sure it is that a unit is what was sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Integrity {
    /// All of it is there.
    Intact,
    /// Begin and end are there; a loss in the middle cannot be excluded (text mode).
    Unverified,
    /// The end may be missing.
    Suspect,
    /// Something is missing.
    Damaged,
}

/// One coded picture with what precedes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AccessUnit {
    /// Annex B byte stream.
    pub data: Vec<u8>,
    /// When its first datagram came.
    pub at: Duration,
    /// When it was complete.
    pub completed: Duration,
    /// Whether it can be decoded without earlier ones.
    pub is_key: bool,
    /// How sure it is that this is what was sent.
    pub integrity: Integrity,
    /// Whether parameter sets and a key frame came before it and nothing is known to be missing since.
    pub is_decodable: bool,
}

/// Counts of what was seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct VideoCounters {
    /// Datagrams.
    pub datagrams: u64,
    /// Access units delivered.
    pub units: u64,
    /// Of these, known to be damaged or suspect.
    pub damaged: u64,
    /// Datagrams without a beginning, dropped.
    pub orphans: u64,
    /// Units dropped because they were too long.
    pub oversized: u64,
}

/// Assembles access units.
#[derive(Debug, Clone)]
pub struct Assembler {
    config: AssemblerConfig,
    data: Vec<u8>,
    pieces: u32,
    first: Duration,
    last: Duration,
    picture: Option<NalKind>,
    has_sps: bool,
    has_pps: bool,
    chain: bool,
    lost: bool,
    frame: Option<(u8, u8)>,
    expected: Option<u8>,
    sets: [bool; 2],
    ready: Option<AccessUnit>,
    counters: VideoCounters,
}

impl Assembler {
    /// An assembler that has seen nothing.
    #[must_use]
    pub fn new(config: AssemblerConfig) -> Self {
        Self {
            config,
            data: Vec::new(),
            pieces: 0,
            first: Duration::ZERO,
            last: Duration::ZERO,
            picture: None,
            has_sps: false,
            has_pps: false,
            chain: false,
            lost: false,
            frame: None,
            expected: None,
            sets: [false; 2],
            ready: None,
            counters: VideoCounters::default(),
        }
    }

    /// Takes in a datagram; up to two units come out: the one that it shows to be over, and its own.
    pub fn push(&mut self, at: Duration, datagram: &[u8]) -> [Option<AccessUnit>; 2] {
        self.counters.datagrams += 1;
        self.ready = None;
        let own = match self.config.framing {
            Framing::Text => self.push_text(at, datagram),
            Framing::Binary => self.push_binary(at, datagram),
        };
        [self.ready.take(), own]
    }

    /// Ends a unit that has waited for [`AssemblerConfig::idle`].
    pub fn handle_timeout(&mut self, now: Duration) -> Option<AccessUnit> {
        let due = self.deadline().is_some_and(|deadline| deadline <= now);
        if due {
            self.finish(now, Integrity::Suspect)
        } else {
            None
        }
    }

    /// When [`Assembler::handle_timeout`] has something to do.
    #[must_use]
    pub fn deadline(&self) -> Option<Duration> {
        let waits = self.picture.is_some() && self.config.framing == Framing::Text;
        waits.then(|| self.last.saturating_add(self.config.idle))
    }

    /// What was seen so far.
    #[must_use]
    pub fn counters(&self) -> VideoCounters {
        self.counters
    }

    fn push_text(&mut self, at: Duration, datagram: &[u8]) -> Option<AccessUnit> {
        if datagram.is_empty() {
            return None;
        }
        match leading_header(datagram).and_then(NalKind::from_header) {
            Some(kind) if self.picture.is_some() && begins_unit(kind, datagram) => {
                // No short datagram ended it: an exact multiple, or the end is lost.
                self.ready = self.finish(at, Integrity::Suspect);
            }
            Some(_) => {}
            None if self.data.is_empty() => {
                self.counters.orphans += 1;
                self.lost = true;
                return None;
            }
            None => {}
        }
        if !self.append(at, datagram) {
            return None;
        }
        let sure = if self.pieces == 1 {
            Integrity::Intact
        } else {
            Integrity::Unverified
        };
        let ends = datagram.len() < PAYLOAD && self.picture.is_some();
        if ends { self.finish(at, sure) } else { None }
    }

    fn push_binary(&mut self, at: Duration, datagram: &[u8]) -> Option<AccessUnit> {
        let [frame, index, payload @ ..] = datagram else {
            return None;
        };
        let (number, is_last) = (index & 0x7F, index & 0x80 != 0);
        let same = self
            .frame
            .is_some_and(|(open, next)| open == *frame && next == number);
        if !same {
            if !self.data.is_empty() {
                self.ready = self.finish(at, Integrity::Damaged);
            }
            // A frame of which nothing came.
            self.lost |= self.expected.is_some_and(|expected| expected != *frame);
            self.expected = Some(frame.wrapping_add(1));
            if number != 0 {
                self.counters.orphans += 1;
                self.lost = true;
                self.frame = None;
                return None;
            }
        }
        self.frame = Some((*frame, number.wrapping_add(1)));
        if !self.append(at, payload) || !is_last {
            return None;
        }
        self.frame = None;
        // A parameter set in a frame of its own is kept for the next one.
        self.picture?;
        self.finish(at, Integrity::Intact)
    }

    /// Adds bytes to the open unit; false if that made it too long.
    fn append(&mut self, at: Duration, bytes: &[u8]) -> bool {
        if self.data.is_empty() {
            self.first = at;
        }
        if self.data.len() + bytes.len() > self.config.max_unit {
            self.counters.oversized += 1;
            self.reset();
            self.lost = true;
            return false;
        }
        self.last = at;
        self.data.extend_from_slice(bytes);
        self.note(bytes);
        self.pieces += u32::from(self.picture.is_some());
        true
    }

    fn note(&mut self, bytes: &[u8]) {
        if self.picture.is_some() {
            return;
        }
        for unit in nal_units(bytes) {
            match unit.first().copied().and_then(NalKind::from_header) {
                Some(NalKind::Sps) => (self.has_sps, self.sets[0]) = (true, true),
                Some(NalKind::Pps) => (self.has_pps, self.sets[1]) = (true, true),
                Some(kind) if kind.is_picture() => self.picture = Some(kind),
                _ => {}
            }
        }
    }

    fn finish(&mut self, at: Duration, integrity: Integrity) -> Option<AccessUnit> {
        let is_key = self.picture == Some(NalKind::IdrSlice);
        let integrity = match (is_key, self.sets, integrity) {
            // Parameter sets without their key frame: the picture behind them is lost.
            (false, [true, _] | [_, true], _) => Integrity::Damaged,
            (true, [false, _] | [_, false], Integrity::Intact) => Integrity::Unverified,
            _ => integrity,
        };
        let whole = matches!(integrity, Integrity::Intact | Integrity::Unverified);
        let intact_before = (self.chain && !self.lost) || is_key;
        // A suspect unit is most likely an exact multiple: nothing is known to be missing, the decoder may try.
        let is_decodable = self.has_sps
            && self.has_pps
            && intact_before
            && (whole || integrity == Integrity::Suspect);
        self.chain = is_decodable;
        self.lost = false;
        let (first, data) = (self.first, core::mem::take(&mut self.data));
        self.reset();
        if data.is_empty() {
            return None;
        }
        self.counters.units += 1;
        self.counters.damaged += u64::from(!whole);
        Some(AccessUnit {
            data,
            at: first,
            completed: at,
            is_key,
            integrity,
            is_decodable,
        })
    }

    fn reset(&mut self) {
        self.data.clear();
        self.pieces = 0;
        self.picture = None;
        self.sets = [false; 2];
    }
}

/// Whether a NAL unit at the front of a datagram begins a new access unit: anything that is no slice, or the first
/// slice of a picture (`first_mb_in_slice` is zero, an exp-Golomb code whose first bit is one).
fn begins_unit(kind: NalKind, datagram: &[u8]) -> bool {
    if !kind.is_picture() {
        return true;
    }
    let unit = nal_units(datagram).next().unwrap_or_default();
    unit.get(1).is_none_or(|byte| byte & 0x80 != 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SPS: &[u8] = &[0, 0, 0, 1, 0x67, 1, 2, 3];
    const PPS: &[u8] = &[0, 0, 0, 1, 0x68, 1, 2];

    fn text() -> Assembler {
        Assembler::new(AssemblerConfig::default())
    }

    fn picture(header: u8, length: usize) -> Vec<u8> {
        let mut data = std::vec![0, 0, 0, 1, header, 0x88];
        data.resize(length, 7);
        data
    }

    #[test]
    fn nothing_is_decodable_before_parameter_sets_and_a_key_frame() {
        let mut assembler = text();
        let [_, early] = assembler.push(Duration::ZERO, &picture(0x61, 100));
        assert!(!early.unwrap().is_decodable);
        assembler.push(Duration::ZERO, SPS);
        assembler.push(Duration::ZERO, PPS);
        let [_, key] = assembler.push(Duration::ZERO, &picture(0x65, 100));
        let key = key.unwrap();
        assert!(key.is_key && key.is_decodable);
        assert_eq!(key.data, [SPS, PPS, &picture(0x65, 100)].concat());
        let [_, next] = assembler.push(Duration::ZERO, &picture(0x61, 100));
        assert!(next.unwrap().is_decodable);
    }

    #[test]
    fn an_exact_multiple_is_ended_by_the_next_unit_or_by_time() {
        let mut assembler = text();
        let unit = picture(0x61, 2 * PAYLOAD);
        for datagram in unit.chunks(PAYLOAD) {
            assert_eq!(assembler.push(Duration::ZERO, datagram), [None, None]);
        }
        let [before, own] = assembler.push(Duration::ZERO, &picture(0x61, 50));
        let before = before.unwrap();
        assert_eq!(
            (before.data, before.integrity),
            (unit.clone(), Integrity::Suspect)
        );
        assert_eq!(own.unwrap().integrity, Integrity::Intact);
        for datagram in unit.chunks(PAYLOAD) {
            assembler.push(Duration::ZERO, datagram);
        }
        assert_eq!(assembler.handle_timeout(Duration::from_millis(99)), None);
        assert_eq!(
            assembler
                .handle_timeout(Duration::from_millis(100))
                .unwrap()
                .data,
            unit
        );
    }

    #[test]
    fn a_lost_beginning_breaks_the_chain_until_the_next_key_frame() {
        let mut assembler = text();
        assembler.push(Duration::ZERO, SPS);
        assembler.push(Duration::ZERO, PPS);
        assembler.push(Duration::ZERO, &picture(0x65, 100));
        assembler.push(Duration::ZERO, &[7; 700]);
        assert_eq!(assembler.counters().orphans, 1);
        let [_, after] = assembler.push(Duration::ZERO, &picture(0x61, 100));
        assert!(!after.unwrap().is_decodable);
        let [_, key] = assembler.push(Duration::ZERO, &picture(0x65, 100));
        assert!(key.unwrap().is_decodable);
    }

    #[test]
    fn a_unit_without_end_is_dropped_at_the_limit() {
        let mut assembler = Assembler::new(AssemblerConfig {
            max_unit: 10_000,
            ..Default::default()
        });
        assembler.push(Duration::ZERO, &picture(0x65, PAYLOAD));
        for _ in 0..1000 {
            assembler.push(Duration::ZERO, &[7; PAYLOAD]);
        }
        assert_eq!(assembler.counters().oversized, 1);
        assert!(assembler.data.capacity() < 40_000);
    }

    proptest! {
        #[test]
        fn any_datagrams_are_taken(datagrams in proptest::collection::vec(proptest::collection::vec(0..9u8, 0..40), 0..60), binary: bool) {
            let framing = if binary { Framing::Binary } else { Framing::Text };
            let mut assembler = Assembler::new(AssemblerConfig { framing, max_unit: 300, ..Default::default() });
            for datagram in &datagrams {
                for unit in assembler.push(Duration::ZERO, datagram).into_iter().flatten() {
                    prop_assert!(unit.data.len() <= 300);
                }
            }
        }
    }
}
