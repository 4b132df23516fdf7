//! A lossy way for datagrams: delay, loss, copies, overtaking.

use super::Channel;
use super::faults::Impairment;
use super::random::Random;
use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::time::Duration;

/// A datagram that has reached the drone.
pub(super) struct Packet {
    pub(super) from: SocketAddr,
    pub(super) bytes: Vec<u8>,
    pub(super) is_copy: bool,
    /// Whether there are two copies of it.
    pub(super) doubled: bool,
}

/// Datagrams on their way to the drone, and the order of those that leave it.
#[derive(Default)]
pub(super) struct Channels {
    uplink: BTreeMap<(Duration, u64), Packet>,
    last_up: Duration,
    last_down: [Duration; 3],
    sequence: u64,
}

/// More than this on the way is dropped, like a full socket buffer.
const UPLINK_LIMIT: usize = 1024;

impl Channels {
    /// Puts a datagram on its way.
    pub(super) fn accept(
        &mut self,
        now: Duration,
        latency: Duration,
        link: &Impairment,
        random: &mut Random,
        from: SocketAddr,
        bytes: &[u8],
    ) {
        let mut last = self.last_up;
        let times = arrivals(now + latency, link, random, &mut last);
        self.last_up = last;
        let doubled = times[1].is_some();
        for (index, at) in times.into_iter().flatten().enumerate() {
            if self.uplink.len() < UPLINK_LIMIT {
                let packet = Packet {
                    from,
                    bytes: bytes.to_vec(),
                    is_copy: index > 0,
                    doubled,
                };
                self.sequence += 1;
                self.uplink.insert((at, self.sequence), packet);
            }
        }
    }

    /// When a datagram that leaves now arrives; two times if it is doubled, none if lost.
    pub(super) fn departures(
        &mut self,
        channel: Channel,
        at: Duration,
        link: &Impairment,
        random: &mut Random,
    ) -> [Option<Duration>; 2] {
        let [replies, state, video] = &mut self.last_down;
        let last = match channel {
            Channel::Reply | Channel::ReplyFromOtherPort => replies,
            Channel::State => state,
            Channel::Video => video,
        };
        arrivals(at, link, random, last)
    }

    pub(super) fn next_sequence(&mut self) -> u64 {
        self.sequence += 1;
        self.sequence
    }

    pub(super) fn next_arrival(&self) -> Option<Duration> {
        self.uplink.first_key_value().map(|(&(at, _), _)| at)
    }

    pub(super) fn arrived(&mut self, now: Duration) -> Option<Packet> {
        let first = self.uplink.first_entry()?;
        (first.key().0 <= now).then(|| first.remove())
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
