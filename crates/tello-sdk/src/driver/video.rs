//! The video socket: a thread that assembles access units and keeps them for a slow or an impatient reader.

use super::error::ConnectError;
use super::hub::VideoHub;
use crate::video::{AccessUnit, Assembler, AssemblerConfig, VideoCounters};
use alloc::collections::VecDeque;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::net::{IpAddr, SocketAddr};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::{Builder, JoinHandle};
use std::time::Instant;

/// Settings of a [`VideoStream`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VideoConfig {
    /// Local socket. Default any address, port 11111.
    pub bind: SocketAddr,
    /// Only datagrams of this address are taken; `None` takes all.
    pub drone: Option<IpAddr>,
    /// Assembly.
    pub assembler: AssemblerConfig,
    /// How many units wait for a slow reader before the oldest is dropped (and counted). Default 256.
    pub capacity: usize,
}

impl Default for VideoConfig {
    fn default() -> Self {
        Self {
            bind: SocketAddr::from(([0, 0, 0, 0], 11_111)),
            drone: None,
            assembler: AssemblerConfig::default(),
            capacity: 256,
        }
    }
}

/// What waits, and what was seen.
#[derive(Debug, Default)]
struct Waiting {
    units: VecDeque<AccessUnit>,
    counters: VideoCounters,
    overrun: u64,
    last_key: Option<Duration>,
}

#[derive(Debug, Default)]
struct Shared {
    waiting: Mutex<Waiting>,
    arrived: Condvar,
    stop: AtomicBool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        // The data is whole after every statement, so a panic elsewhere spoils nothing.
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Receives the drone's video. Send [`Command::StreamOn`](crate::Command::StreamOn) to start it.
#[derive(Debug)]
pub struct VideoStream {
    shared: Arc<Shared>,
    start: Instant,
    local: SocketAddr,
    thread: Option<JoinHandle<()>>,
}

impl VideoStream {
    /// Binds the socket and starts the thread.
    ///
    /// # Errors
    /// The port is in use, or no thread can be started.
    pub fn open(config: VideoConfig) -> Result<Self, ConnectError> {
        let address = config.bind;
        let fail = |source| ConnectError::Bind { address, source };
        let socket = UdpSocket::bind(address).map_err(fail)?;
        let local = socket.local_addr().map_err(fail)?;
        Self::start(config, Source::Socket(socket), local)
    }

    /// Takes this drone's part of a video port that several drones share ([`VideoConfig::bind`] and
    /// [`VideoConfig::drone`] are not used then). Open it before the drone's stream begins.
    ///
    /// # Errors
    /// No thread can be started.
    pub fn open_through(
        hub: &VideoHub,
        drone: IpAddr,
        config: VideoConfig,
    ) -> Result<Self, ConnectError> {
        let config = VideoConfig {
            drone: None,
            ..config
        };
        Self::start(
            config,
            Source::Hub(hub.register(drone)),
            hub.local_address(),
        )
    }

    fn start(config: VideoConfig, source: Source, local: SocketAddr) -> Result<Self, ConnectError> {
        let (shared, start) = (Arc::new(Shared::default()), Instant::now());
        let receiver = Receiver {
            assembler: Assembler::new(config.assembler),
            shared: Arc::clone(&shared),
            config,
            source,
            start,
        };
        let thread = Builder::new()
            .name("tello-video".into())
            .spawn(move || receiver.run())
            .map_err(ConnectError::Thread)?;
        Ok(Self {
            shared,
            start,
            local,
            thread: Some(thread),
        })
    }

    /// The local address, for a port chosen by the system.
    #[must_use]
    pub fn local_address(&self) -> SocketAddr {
        self.local
    }

    /// The next unit in order; `None` after the timeout. Nothing is left out while fewer than
    /// [`VideoConfig::capacity`] wait.
    #[must_use]
    pub fn next(&self, timeout: Duration) -> Option<AccessUnit> {
        self.wait(timeout).units.pop_front()
    }

    /// The newest unit, dropping those that wait before it; `None` after the timeout.
    ///
    /// A decoder needs every unit from a key frame on: use this only to show key frames or to look at the newest
    /// state, and [`VideoStream::next`] for decoding.
    #[must_use]
    pub fn newest(&self, timeout: Duration) -> Option<AccessUnit> {
        let mut waiting = self.wait(timeout);
        let newest = waiting.units.pop_back();
        waiting.units.clear();
        newest
    }

    /// Time since the stream was opened, on the clock of [`AccessUnit::at`].
    #[must_use]
    pub fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// How long ago the newest decodable key frame came.
    #[must_use]
    pub fn key_frame_age(&self) -> Option<Duration> {
        let last = self.shared.lock().last_key?;
        Some(self.now().saturating_sub(last))
    }

    /// What was seen, and how many units were dropped because nobody took them.
    #[must_use]
    pub fn counters(&self) -> (VideoCounters, u64) {
        let waiting = self.shared.lock();
        (waiting.counters, waiting.overrun)
    }

    fn wait(&self, timeout: Duration) -> MutexGuard<'_, Waiting> {
        let waiting = self.shared.lock();
        let empty = |waiting: &mut Waiting| waiting.units.is_empty();
        let result = self
            .shared
            .arrived
            .wait_timeout_while(waiting, timeout, empty);
        result.unwrap_or_else(PoisonError::into_inner).0
    }
}

impl Drop for VideoStream {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Where datagrams come from.
enum Source {
    Socket(UdpSocket),
    Hub(mpsc::Receiver<Vec<u8>>),
}

impl Source {
    /// The next datagram within `wait`: its sender, if known, and its length in the buffer.
    fn receive(&self, buffer: &mut [u8; 2048], wait: Duration) -> Option<(Option<IpAddr>, usize)> {
        match self {
            Self::Socket(socket) => {
                let _ = socket.set_read_timeout(Some(wait.max(Duration::from_millis(1))));
                let (length, from) = socket.recv_from(buffer).ok()?;
                Some((Some(from.ip()), length))
            }
            Self::Hub(inbox) => {
                let bytes = inbox.recv_timeout(wait).ok()?;
                buffer.get_mut(..bytes.len())?.copy_from_slice(&bytes);
                Some((None, bytes.len()))
            }
        }
    }
}

struct Receiver {
    assembler: Assembler,
    shared: Arc<Shared>,
    config: VideoConfig,
    source: Source,
    start: Instant,
}

impl Receiver {
    fn run(mut self) {
        let mut buffer = [0_u8; 2048];
        while !self.shared.stop.load(Ordering::Relaxed) {
            let idle = self
                .assembler
                .deadline()
                .map(|at| at.saturating_sub(self.start.elapsed()));
            let wait = idle.unwrap_or(Duration::from_millis(100));
            let received = self.source.receive(&mut buffer, wait);
            let now = self.start.elapsed();
            let mut units = [None, None, self.assembler.handle_timeout(now)];
            if let Some((from, length)) = received
                && (self.config.drone.is_none() || self.config.drone == from)
            {
                let bytes = buffer.get(..length).unwrap_or_default();
                let [before, own] = self.assembler.push(now, bytes);
                units = [units[2].take(), before, own];
            }
            self.hand_over(units);
        }
    }

    fn hand_over(&self, units: [Option<AccessUnit>; 3]) {
        let mut waiting = self.shared.lock();
        waiting.counters = self.assembler.counters();
        for unit in units.into_iter().flatten() {
            if unit.is_key && unit.is_decodable {
                waiting.last_key = Some(unit.completed);
            }
            if waiting.units.len() >= self.config.capacity.max(1) {
                waiting.units.pop_front();
                waiting.overrun += 1;
            }
            waiting.units.push_back(unit);
            self.shared.arrived.notify_one();
        }
    }
}
