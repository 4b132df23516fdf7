//! Several drones on one port: all of them send their state, and their video, to the same ports of this machine, so one
//! socket reads a port and gives each datagram to the drone with its source address.

use super::engine::deliver;
use super::error::ConnectError;
use super::pilot::Message;
use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::net::{IpAddr, SocketAddr};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};

/// Takes a datagram; false when its drone is gone.
type Take = Box<dyn Fn(SocketAddr, &[u8]) -> bool + Send>;
type Takers = Mutex<BTreeMap<IpAddr, Take>>;

/// One socket, one thread, and who takes what comes from which address.
struct Demultiplexer {
    takers: Arc<Takers>,
    stop: Arc<AtomicBool>,
    local: SocketAddr,
    thread: Option<JoinHandle<()>>,
}

/// Reads one state port for several drones; give it to [`Drone::connect_through`](super::Drone::connect_through).
#[derive(Debug)]
pub struct StateHub(Demultiplexer);

/// Reads one video port for several drones; give it to [`VideoStream::open_through`](super::VideoStream::open_through).
#[derive(Debug)]
pub struct VideoHub(Demultiplexer);

/// Video datagrams that wait for a drone's stream at most; more are lost, as in a full socket.
const WAITING: usize = 1024;

impl StateHub {
    /// Binds the port, 0.0.0.0:8890 for drones in station mode.
    ///
    /// # Errors
    /// The port is in use, or no thread can be started.
    pub fn bind(address: SocketAddr) -> Result<Self, ConnectError> {
        Demultiplexer::bind(address).map(Self)
    }

    /// Sends what comes from this address to a drone; a drone that is gone is forgotten by itself.
    pub(super) fn register(&self, drone: IpAddr, inbox: SyncSender<Message>) {
        self.0.register(
            drone,
            Box::new(move |from, bytes| deliver(&inbox, Message::State(from, bytes.to_vec()))),
        );
    }
}

impl VideoHub {
    /// Binds the port, 0.0.0.0:11111 by default of the drones.
    ///
    /// # Errors
    /// The port is in use, or no thread can be started.
    pub fn bind(address: SocketAddr) -> Result<Self, ConnectError> {
        Demultiplexer::bind(address).map(Self)
    }

    /// The local address, for a port chosen by the system.
    #[must_use]
    pub fn local_address(&self) -> SocketAddr {
        self.0.local
    }

    /// What comes from this address from now on.
    pub(super) fn register(&self, drone: IpAddr) -> Receiver<Vec<u8>> {
        let (outbox, inbox): (SyncSender<Vec<u8>>, _) = sync_channel(WAITING);
        let take = move |_, bytes: &[u8]| deliver(&outbox, bytes.to_vec());
        self.0.register(drone, Box::new(take));
        inbox
    }
}

impl Demultiplexer {
    fn bind(address: SocketAddr) -> Result<Self, ConnectError> {
        let fail = |source| ConnectError::Bind { address, source };
        let socket = UdpSocket::bind(address).map_err(fail)?;
        let local = socket.local_addr().map_err(fail)?;
        let (takers, stop) = (
            Arc::new(Takers::default()),
            Arc::new(AtomicBool::new(false)),
        );
        let shared = (Arc::clone(&takers), Arc::clone(&stop));
        let thread = Builder::new()
            .name("tello-hub".into())
            .spawn(move || read(&socket, &shared.0, &shared.1))
            .map_err(ConnectError::Thread)?;
        Ok(Self {
            takers,
            stop,
            local,
            thread: Some(thread),
        })
    }

    fn register(&self, drone: IpAddr, take: Take) {
        self.takers
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(drone, take);
    }
}

impl core::fmt::Debug for Demultiplexer {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "hub on {}", self.local)
    }
}

impl Drop for Demultiplexer {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn read(socket: &UdpSocket, takers: &Takers, stop: &AtomicBool) {
    let mut buffer = [0_u8; 2048];
    let _ = socket.set_read_timeout(Some(Duration::from_millis(100)));
    while !stop.load(Ordering::Relaxed) {
        let Ok((length, from)) = socket.recv_from(&mut buffer) else {
            continue;
        };
        let bytes = buffer.get(..length).unwrap_or_default();
        let mut takers = takers.lock().unwrap_or_else(PoisonError::into_inner);
        if takers
            .get(&from.ip())
            .is_some_and(|take| !take(from, bytes))
        {
            takers.remove(&from.ip());
        }
    }
}
