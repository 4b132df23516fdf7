//! The radio link of one drone: delay, loss, copies and overtaking in both directions, each channel by itself.

use super::faults::{Faults, Impairment};
use super::random::Random;
use super::{Channel, Timing, Transmit};
use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::time::Duration;

/// A datagram that has reached the drone.
pub(crate) struct Packet {
    pub(crate) from: SocketAddr,
    pub(crate) bytes: Vec<u8>,
    pub(crate) is_copy: bool,
    /// Whether there are two copies of it.
    pub(crate) doubled: bool,
}

/// What a datagram from the drone is, for the faults: the binary protocol sends all but video from one socket.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lane {
    Reply,
    State,
    Video,
}

/// A datagram about to leave the drone.
pub(crate) struct Departure {
    pub(crate) lane: Lane,
    pub(crate) transmit: Transmit,
    /// How long the drone itself holds it back.
    pub(crate) late: Duration,
    /// It answers a doubled command: not held back by the link's delay fault.
    pub(crate) prompt: bool,
}

/// Datagrams on their way.
#[derive(Debug, Default)]
pub(crate) struct Link {
    uplink: BTreeMap<(Duration, u64), Packet>,
    downlink: BTreeMap<(Duration, u64), Transmit>,
    last_up: Duration,
    last_down: [Duration; 3],
    sequence: u64,
}

impl core::fmt::Debug for Packet {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} bytes from {}", self.bytes.len(), self.from)
    }
}

/// More than this on the way in one direction is dropped, like a full socket buffer.
const LIMIT: usize = 1024;
/// A reply held back by the drone for longer than this does not hold back the others.
const HELD: Duration = Duration::from_millis(200);

impl Link {
    /// Puts a datagram on its way to the drone.
    pub(crate) fn accept(
        &mut self,
        now: Duration,
        timing: &Timing,
        faults: &Faults,
        random: &mut Random,
        from: SocketAddr,
        bytes: &[u8],
    ) {
        if faults.is_gap(now) {
            return;
        }
        let latency = timing.one_way(random.unit());
        let times = arrivals(now + latency, &faults.commands, random, &mut self.last_up);
        let doubled = times[1].is_some();
        for (index, at) in times.into_iter().flatten().enumerate() {
            if self.uplink.len() < LIMIT {
                let (bytes, is_copy) = (bytes.to_vec(), index > 0);
                self.sequence += 1;
                let packet = Packet {
                    from,
                    bytes,
                    is_copy,
                    doubled,
                };
                self.uplink.insert((at, self.sequence), packet);
            }
        }
    }

    /// Puts a datagram on its way to the client.
    pub(crate) fn send(
        &mut self,
        now: Duration,
        timing: &Timing,
        faults: &Faults,
        random: &mut Random,
        departure: Departure,
    ) {
        let leaves = now + departure.late;
        if faults.is_gap(leaves) {
            return;
        }
        let (mut link, last) = match departure.lane {
            Lane::Reply => (faults.replies, 0),
            Lane::State => (faults.state, 1),
            Lane::Video => (faults.video, 2),
        };
        if departure.prompt {
            link.delay = 0.0;
        }
        let latency = match departure.lane {
            Lane::Video => Duration::ZERO,
            _ => timing.one_way(random.unit()),
        };
        let times = if departure.late < HELD {
            arrivals(leaves + latency, &link, random, &mut self.last_down[last])
        } else {
            [Some(leaves + latency), None]
        };
        for at in times.into_iter().flatten() {
            if self.downlink.len() < LIMIT {
                self.sequence += 1;
                self.downlink
                    .insert((at, self.sequence), departure.transmit.clone());
            }
        }
    }

    /// The next datagram that has reached the drone.
    pub(crate) fn arrived(&mut self, now: Duration) -> Option<Packet> {
        let first = self.uplink.first_entry()?;
        (first.key().0 <= now).then(|| first.remove())
    }

    /// The next datagram that has reached the client.
    pub(crate) fn delivered(&mut self, now: Duration) -> Option<Transmit> {
        let first = self.downlink.first_entry()?;
        (first.key().0 <= now).then(|| first.remove())
    }

    pub(crate) fn next_arrival(&self) -> Option<Duration> {
        self.uplink.first_key_value().map(|(&(at, _), _)| at)
    }

    pub(crate) fn next_delivery(&self) -> Option<Duration> {
        self.downlink.first_key_value().map(|(&(at, _), _)| at)
    }
}

impl Transmit {
    /// A datagram that answers nothing.
    pub(crate) fn new(channel: Channel, to: SocketAddr, bytes: Vec<u8>) -> Self {
        Self {
            channel,
            to,
            bytes,
            answers: None,
        }
    }
}

/// Ordinary datagrams keep their order; a delayed one is overtaken.
fn arrivals(
    due: Duration,
    link: &Impairment,
    random: &mut Random,
    last: &mut Duration,
) -> [Option<Duration>; 2] {
    if random.chance(link.loss) {
        return [None, None];
    }
    let at = if random.chance(link.delay) {
        due + random.up_to(link.longest_delay)
    } else {
        *last = due.max(*last);
        *last
    };
    let copy = random
        .chance(link.duplicate)
        .then(|| at + random.up_to(link.duplicate_delay));
    [Some(at), copy]
}
