//! Finds drones by asking: `command` to each address, then `sn?` to those that answer.

use super::error::ConnectError;
use crate::reply::{Reply, ReplyKind};
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;
use core::net::{Ipv4Addr, SocketAddr};
use core::time::Duration;
use std::net::UdpSocket;
use std::time::Instant;

/// A drone that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// Its command address.
    pub address: SocketAddr,
    /// Its serial number, if it told (SDK 2.0 and later).
    pub serial_number: Option<String>,
}

/// Asks each candidate and waits up to `timeout` for each of the two answers; the result is in the order of addresses.
///
/// Entering the text protocol ends a session of the binary one: do not ask a drone that another program flies.
///
/// # Errors
/// The local socket cannot be bound.
pub fn discover(
    bind: SocketAddr,
    candidates: &[SocketAddr],
    timeout: Duration,
) -> Result<Vec<Found>, ConnectError> {
    let socket = UdpSocket::bind(bind).map_err(|source| ConnectError::Bind {
        address: bind,
        source,
    })?;
    let is_ok = |reply: &Reply| reply.kind == ReplyKind::Ok;
    let entered = ask(&socket, b"command", candidates, timeout, is_ok);
    let drones: Vec<SocketAddr> = entered.into_keys().collect();
    // A late `ok` of the first round is no serial number.
    let is_name = |reply: &Reply| !is_ok(reply) && reply.refusal().is_none();
    let mut serials = ask(&socket, b"sn?", &drones, timeout, is_name);
    let found = drones.into_iter().map(|address| {
        let serial_number = serials.remove(&address).map(|reply| reply.raw);
        Found {
            address,
            serial_number,
        }
    });
    Ok(found.collect())
}

/// Every address of a network but its first and last, as candidates for [`discover`]: `subnet([192, 168, 1, 0].into(), 24,
/// 8889)` are 254. A prefix shorter than 16 is taken as 16: more is no home network.
#[must_use]
pub fn subnet(network: Ipv4Addr, prefix: u8, port: u16) -> Vec<SocketAddr> {
    let hosts = u32::MAX.checked_shr(u32::from(prefix.clamp(16, 32)));
    let hosts = hosts.unwrap_or(0);
    let first = network.to_bits() & !hosts;
    (1..hosts)
        .map(|host| SocketAddr::from((Ipv4Addr::from_bits(first | host), port)))
        .collect()
}

/// The first fitting reply of each address asked, until all have answered or the time is over; the silent ones are asked
/// four times in all.
fn ask(
    socket: &UdpSocket,
    text: &[u8],
    to: &[SocketAddr],
    timeout: Duration,
    fits: impl Fn(&Reply) -> bool,
) -> BTreeMap<SocketAddr, Reply> {
    let mut replies = BTreeMap::new();
    for _ in 0..4 {
        for address in to.iter().filter(|address| !replies.contains_key(*address)) {
            // An address that cannot be reached does not answer.
            let _ = socket.send_to(text, address);
        }
        collect(socket, to, timeout / 4, &fits, &mut replies);
    }
    replies
}

fn collect(
    socket: &UdpSocket,
    to: &[SocketAddr],
    timeout: Duration,
    fits: &impl Fn(&Reply) -> bool,
    replies: &mut BTreeMap<SocketAddr, Reply>,
) {
    let end = Instant::now() + timeout;
    let mut buffer = [0_u8; 2048];
    while replies.len() < to.len() {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return;
        }
        let _ = socket.set_read_timeout(Some(left));
        if let Ok((length, from)) = socket.recv_from(&mut buffer)
            && to.contains(&from)
        {
            let reply = Reply::parse(buffer.get(..length).unwrap_or_default());
            if fits(&reply) {
                replies.entry(from).or_insert(reply);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn a_network_has_its_hosts() {
        let all = subnet([192, 168, 1, 77].into(), 24, 8889);
        assert_eq!(
            (all.len(), all[0]),
            (254, SocketAddr::from(([192, 168, 1, 1], 8889)))
        );
        assert_eq!(all[253].ip().to_string(), "192.168.1.254");
        assert_eq!(subnet([10, 0, 0, 0].into(), 0, 1).len(), 65_534);
        assert!(subnet([10, 0, 0, 0].into(), 32, 1).is_empty());
    }
}
