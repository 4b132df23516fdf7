//! Takes off, turns and lands in the binary protocol of the maker's app.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone (192.168.10.1:8889) or another program's; without it an emulated drone on
//! 127.0.0.3 is started in this process. Output: how each command ended, then the last battery.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tello_sdk::binary::{BinaryCommand, BinaryConfig, BinaryEvent, BinaryOutput, BinarySession};
use tello_sdk::emulator::udp::{ServeConfig, serve};
use tello_sdk::{Stick, Sticks};

fn main() -> Result<(), Box<dyn Error>> {
    if let Some(address) = std::env::args().skip_while(|word| word != "--drone").nth(1) {
        return fly(address.parse()?);
    }
    let address = [127, 0, 0, 3].into();
    let emulator = ServeConfig {
        address,
        binary: true,
        ..ServeConfig::default()
    };
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| serve(&emulator, &stop));
        let flown = fly(SocketAddr::from((address, emulator.command_port)));
        stop.store(true, Ordering::Relaxed);
        flown
    })
}

fn fly(drone: SocketAddr) -> Result<(), Box<dyn Error>> {
    let socket = UdpSocket::bind("0.0.0.0:0")?;
    let mut session = BinarySession::new(BinaryConfig::default());
    let (start, mut buffer, mut took_off) = (Instant::now(), [0; 2048], None);
    loop {
        let now = start.elapsed();
        let wait = match session.poll_output() {
            BinaryOutput::WaitUntil(at) => at.saturating_sub(now),
            BinaryOutput::Send(bytes) => {
                socket.send_to(&bytes, drone)?;
                continue;
            }
            BinaryOutput::Event(BinaryEvent::Connected) if took_off.is_none() => {
                session.command(now, BinaryCommand::TakeOff);
                took_off = Some(now);
                continue;
            }
            BinaryOutput::Event(BinaryEvent::Finished {
                command, ending, ..
            }) => {
                println!("{command:?}: {ending:?}");
                if command == BinaryCommand::Land {
                    break;
                }
                continue;
            }
            BinaryOutput::Event(_) => continue,
        };
        socket.set_read_timeout(Some(wait.max(Duration::from_millis(1))))?;
        match socket.recv_from(&mut buffer) {
            Ok((length, _)) => session.handle_datagram(start.elapsed(), &buffer[..length]),
            Err(_) => session.handle_timeout(start.elapsed()),
        }
        match took_off.map(|at| now.saturating_sub(at).as_secs()) {
            Some(4 | 5) => session.set_sticks(
                now,
                Sticks {
                    yaw: Stick::MAX,
                    ..Sticks::CENTER
                },
            ),
            Some(6) => {
                session.command(now, BinaryCommand::Land);
                took_off = Some(Duration::MAX);
            }
            _ => {}
        }
    }
    let battery = session.telemetry().battery;
    println!(
        "battery {:?}",
        battery.map(|reading| reading.value.percent())
    );
    Ok(())
}
