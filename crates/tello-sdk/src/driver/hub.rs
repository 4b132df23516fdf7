//! Several drones on one state port: all of them send their state to the same port of this machine, so one socket reads
//! it and gives each datagram to the drone with its source address.

use super::error::ConnectError;
use super::worker::Message;
use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use core::net::{IpAddr, SocketAddr};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::sync::mpsc::Sender;
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};

type Drones = Mutex<BTreeMap<IpAddr, Sender<Message>>>;

/// Reads one state port for several drones; give it to [`Drone::connect_through`](super::Drone::connect_through).
#[derive(Debug)]
pub struct StateHub {
    drones: Arc<Drones>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl StateHub {
    /// Binds the port, 0.0.0.0:8890 for drones in station mode.
    ///
    /// # Errors
    /// The port is in use, or no thread can be started.
    pub fn bind(address: SocketAddr) -> Result<Self, ConnectError> {
        let socket =
            UdpSocket::bind(address).map_err(|source| ConnectError::Bind { address, source })?;
        let (drones, stop) = (
            Arc::new(Drones::default()),
            Arc::new(AtomicBool::new(false)),
        );
        let shared = (Arc::clone(&drones), Arc::clone(&stop));
        let thread = Builder::new()
            .name("tello-hub".into())
            .spawn(move || read(&socket, &shared.0, &shared.1))
            .map_err(ConnectError::Thread)?;
        Ok(Self {
            drones,
            stop,
            thread: Some(thread),
        })
    }

    /// Sends what comes from this address to a drone; a drone that is gone is forgotten by itself.
    pub(super) fn register(&self, drone: IpAddr, inbox: Sender<Message>) {
        self.drones
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(drone, inbox);
    }
}

impl Drop for StateHub {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn read(socket: &UdpSocket, drones: &Drones, stop: &AtomicBool) {
    let mut buffer = [0_u8; 2048];
    let _ = socket.set_read_timeout(Some(Duration::from_millis(100)));
    while !stop.load(Ordering::Relaxed) {
        let Ok((length, from)) = socket.recv_from(&mut buffer) else {
            continue;
        };
        let mut drones = drones.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(inbox) = drones.get(&from.ip()) else {
            continue;
        };
        let bytes = buffer.get(..length).unwrap_or_default().to_vec();
        if inbox.send(Message::State(from, bytes)).is_err() {
            drones.remove(&from.ip());
        }
    }
}
