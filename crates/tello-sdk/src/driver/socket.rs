//! A UDP socket on an address, and if asked for on one network interface only.

use alloc::string::String;
use core::net::SocketAddr;
use std::io;
use std::net::UdpSocket;

/// Several plain Tellos have the same address: each then needs an adapter of its own and sockets bound to it. Two sockets
/// may have the same port if they are bound to different interfaces.
pub(super) fn bind(address: SocketAddr, interface: Option<&String>) -> io::Result<UdpSocket> {
    let Some(name) = interface else {
        return UdpSocket::bind(address);
    };
    bind_to_interface(address, name)
}

#[cfg(any(target_os = "linux", target_os = "android"))]
fn bind_to_interface(address: SocketAddr, name: &str) -> io::Result<UdpSocket> {
    use socket2::{Domain, Protocol, Socket, Type};
    let socket = Socket::new(
        Domain::for_address(address),
        Type::DGRAM,
        Some(Protocol::UDP),
    )?;
    socket.bind_device(Some(name.as_bytes()))?;
    socket.bind(&address.into())?;
    Ok(socket.into())
}

#[cfg(not(any(target_os = "linux", target_os = "android")))]
fn bind_to_interface(_address: SocketAddr, _name: &str) -> io::Result<UdpSocket> {
    let message = "binding to a network interface is known on Linux only: bind to its address";
    Err(io::Error::new(io::ErrorKind::Unsupported, message))
}
