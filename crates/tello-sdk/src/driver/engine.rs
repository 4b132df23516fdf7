//! The thread that owns a session of either protocol: messages and time go in through one channel, datagrams go out.

use super::error::ConnectError;
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::Instant;

/// Where the answer to a call goes.
pub(super) type Answer<T> = Box<dyn FnOnce(T) + Send>;

/// Messages that wait for a session at most. A flood of datagrams beyond is lost, as in a full socket.
const WAITING: usize = 4096;

/// Hands a datagram over if there is room; false when nobody takes it any more.
pub(super) fn deliver<M>(outbox: &SyncSender<M>, message: M) -> bool {
    !matches!(outbox.try_send(message), Err(TrySendError::Disconnected(_)))
}

/// A session with what surrounds it, without sockets and clock.
pub(super) trait Engine: Send + 'static {
    type Message: Send + 'static;

    fn handle(&mut self, now: Duration, message: Self::Message);

    /// Lets time pass.
    fn tick(&mut self, now: Duration);

    /// Carries out what the session wants and returns its next deadline.
    fn drain(&mut self, now: Duration, send: &mut dyn FnMut(&[u8])) -> Duration;

    /// Lands a drone that may be flying, then ends.
    fn close(&mut self, now: Duration);

    /// Whether a closed connection has nothing more to do.
    fn is_over(&self, now: Duration) -> bool;
}

/// The threads of one connection. Dropping it closes the engine and waits for its end.
pub(super) struct Connection<M> {
    pub(super) inbox: SyncSender<M>,
    stop: Arc<AtomicBool>,
    close: fn() -> M,
    threads: Vec<JoinHandle<()>>,
}

impl<M: Send + 'static> Connection<M> {
    /// Starts the engine's thread; `close` makes the message that ends it.
    pub(super) fn start<E: Engine<Message = M>>(
        engine: E,
        socket: UdpSocket,
        drone: SocketAddr,
        close: fn() -> M,
    ) -> Result<Self, ConnectError> {
        let (inbox, messages) = sync_channel(WAITING);
        let stop = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&stop);
        let thread = spawn("tello-session", move || {
            run(engine, &socket, drone, &messages);
            ended.store(true, Ordering::Relaxed);
        })?;
        Ok(Self {
            inbox,
            stop,
            close,
            threads: Vec::from([thread]),
        })
    }

    /// Starts a thread that passes on what comes on a socket.
    pub(super) fn read(
        &mut self,
        socket: UdpSocket,
        message: fn(SocketAddr, Vec<u8>) -> M,
    ) -> Result<(), ConnectError> {
        let (stop, outbox) = (Arc::clone(&self.stop), self.inbox.clone());
        let thread = spawn("tello-read", move || read(&socket, &stop, &outbox, message))?;
        self.threads.push(thread);
        Ok(())
    }
}

impl<M> core::fmt::Debug for Connection<M> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "connection of {} threads", self.threads.len())
    }
}

impl<M> Drop for Connection<M> {
    fn drop(&mut self) {
        let _ = self.inbox.send((self.close)());
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

fn run<E: Engine>(
    mut engine: E,
    socket: &UdpSocket,
    drone: SocketAddr,
    inbox: &Receiver<E::Message>,
) {
    let start = Instant::now();
    // A dead network is the same as a lost datagram: the session finds out by the silence.
    let mut send = |bytes: &[u8]| drop(socket.send_to(bytes, drone));
    let mut orphaned = false;
    loop {
        let deadline = engine.drain(start.elapsed(), &mut send);
        if engine.is_over(start.elapsed()) {
            return;
        }
        let wait = deadline
            .saturating_sub(start.elapsed())
            .min(Duration::from_millis(100));
        match inbox.recv_timeout(wait) {
            Ok(message) => engine.handle(start.elapsed(), message),
            // The owner is gone without a word.
            Err(RecvTimeoutError::Disconnected) if !orphaned => {
                orphaned = true;
                engine.close(start.elapsed());
            }
            Err(_) => engine.tick(start.elapsed()),
        }
    }
}

fn read<M>(
    socket: &UdpSocket,
    stop: &AtomicBool,
    outbox: &SyncSender<M>,
    message: fn(SocketAddr, Vec<u8>) -> M,
) {
    let mut buffer = [0_u8; 2048];
    let _ = socket.set_read_timeout(Some(Duration::from_millis(100)));
    while !stop.load(Ordering::Relaxed) {
        if let Ok((length, from)) = socket.recv_from(&mut buffer) {
            let bytes = buffer.get(..length).unwrap_or_default().to_vec();
            if !deliver(outbox, message(from, bytes)) {
                return;
            }
        }
    }
}

fn spawn(name: &str, run: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, ConnectError> {
    Builder::new()
        .name(name.into())
        .spawn(run)
        .map_err(ConnectError::Thread)
}
