//! From a configuration to a running connection of the text protocol.

use super::config::DroneConfig;
use super::engine::{Answer, Connection};
use super::error::{ConnectError, DriveError, settle};
use super::hub::StateHub;
use super::pilot::{Message, Pilot};
use super::recorder::Recorder;
use super::socket;
use crate::command::Command;
use crate::session::{Event, Session};
use alloc::boxed::Box;
use alloc::string::String;
use core::net::SocketAddr;
use std::net::UdpSocket;
use std::sync::mpsc::{RecvTimeoutError, channel, sync_channel};

/// Binds the sockets, enters the text protocol and waits for the first state line.
pub(super) fn connect(
    config: DroneConfig,
    hub: Option<&StateHub>,
    publish: Box<dyn FnMut(Event) + Send>,
) -> Result<Connection<Message>, ConnectError> {
    let (timeout, drone, state) = (config.connect_timeout, config.drone, config.state_bind);
    let connection = start(config, hub, publish)?;
    let answered = ask(&connection, |answer| {
        Message::Request(Command::EnterSdk, answer)
    });
    let answered = answered.and_then(|outcome| settle(outcome?));
    answered.map_err(|_| ConnectError::NoAnswer { drone })?;
    let (first, told) = channel();
    let answer: Answer<()> = Box::new(move |()| {
        let _ = first.send(());
    });
    let _ = connection.inbox.send(Message::AwaitState(answer));
    match told.recv_timeout(timeout) {
        Err(RecvTimeoutError::Timeout) => Err(ConnectError::NoState { bind: state }),
        _ => Ok(connection),
    }
}

fn start(
    config: DroneConfig,
    hub: Option<&StateHub>,
    publish: Box<dyn FnMut(Event) + Send>,
) -> Result<Connection<Message>, ConnectError> {
    let (drone, state_bind) = (config.drone, config.state_bind);
    let interface = config.interface.as_ref();
    let socket = bind(config.command_bind, interface)?;
    let state = hub.is_none().then(|| bind(state_bind, interface));
    let state = state.transpose()?;
    let replies = socket.try_clone().map_err(ConnectError::Thread)?;
    let session = Session::new(config.session.clone())?;
    let recorder = Recorder::create(config.record.as_deref())?;
    let pilot = Pilot::new(config, session, recorder, publish);
    let mut connection = Connection::start(pilot, socket, drone, || Message::Close)?;
    connection.read(replies, Message::Reply)?;
    if let Some(state) = state {
        connection.read(state, Message::State)?;
    }
    if let Some(hub) = hub {
        hub.register(drone.ip(), connection.inbox.clone());
    }
    Ok(connection)
}

/// Sends a message with a place for the answer, and waits for it.
pub(super) fn ask<M: Send + 'static, T: Send + 'static>(
    connection: &Connection<M>,
    message: impl FnOnce(Answer<T>) -> M,
) -> Result<T, DriveError> {
    let (answer, result) = sync_channel(1);
    let answer: Answer<T> = Box::new(move |value| drop(answer.try_send(value)));
    let sent = connection.inbox.send(message(answer));
    sent.map_err(|_| DriveError::Closed)?;
    result.recv().map_err(|_| DriveError::Closed)
}

pub(super) fn bind(
    address: SocketAddr,
    interface: Option<&String>,
) -> Result<UdpSocket, ConnectError> {
    socket::bind(address, interface).map_err(|source| ConnectError::Bind { address, source })
}
