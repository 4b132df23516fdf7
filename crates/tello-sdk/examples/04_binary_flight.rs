//! Takes off, turns and lands in the binary protocol of the maker's app.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone (192.168.10.1:8889) or another program's; without it an emulated drone on
//! 127.0.0.3 is started in this process. Output: how each command ended, then the last attitude and battery.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tello_sdk::binary::{BinaryCommand, BinaryConfig, BinaryEvent, BinaryOutput, BinarySession};
use tello_sdk::emulator::udp::{ServeConfig, serve};
use tello_sdk::{Stick, Sticks};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    if arguments.next().as_deref() == Some("--drone") {
        return fly(arguments
            .next()
            .ok_or("--drone needs an address")?
            .parse()?);
    }
    let emulator = ServeConfig {
        address: [127, 0, 0, 3].into(),
        binary: true,
        ..ServeConfig::default()
    };
    let address = SocketAddr::from((emulator.address, emulator.command_port));
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let server = scope.spawn(|| serve(&emulator, &stop));
        let flown = fly(address);
        stop.store(true, Ordering::Relaxed);
        server.join().map_err(|_| "the emulator panicked")??;
        flown
    })
}

fn fly(drone: SocketAddr) -> Result<(), Box<dyn Error>> {
    let socket = UdpSocket::bind("0.0.0.0:0")?;
    let mut session = BinarySession::new(BinaryConfig::default());
    let start = Instant::now();
    let mut buffer = [0; 2048];
    let mut land_at = None;
    loop {
        let wait = match session.poll_output() {
            BinaryOutput::Send(bytes) => {
                socket.send_to(&bytes, drone)?;
                continue;
            }
            BinaryOutput::Event(BinaryEvent::Connected) if land_at.is_none() => {
                session.command(start.elapsed(), BinaryCommand::TakeOff);
                land_at = Some(start.elapsed() + Duration::from_secs(6));
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
            BinaryOutput::WaitUntil(at) => at.saturating_sub(start.elapsed()),
        };
        socket.set_read_timeout(Some(
            wait.clamp(Duration::from_millis(1), Duration::from_secs(1)),
        ))?;
        match socket.recv_from(&mut buffer) {
            Ok((length, from)) if from.ip() == drone.ip() => {
                session.handle_datagram(start.elapsed(), &buffer[..length]);
            }
            _ => session.handle_timeout(start.elapsed()),
        }
        if land_at.is_some_and(|at| at <= start.elapsed()) {
            session.command(start.elapsed(), BinaryCommand::Land);
            land_at = Some(Duration::MAX);
        } else if land_at.is_some_and(|at| at <= start.elapsed() + Duration::from_secs(2)) {
            session.set_sticks(
                start.elapsed(),
                Sticks {
                    yaw: Stick::MAX,
                    ..Sticks::CENTER
                },
            );
        }
    }
    let telemetry = session.telemetry();
    println!(
        "attitude {:?}",
        telemetry.attitude.map(|reading| reading.value)
    );
    println!(
        "battery {:?}",
        telemetry.battery.map(|reading| reading.value.percent())
    );
    Ok(())
}
