//! A session and an emulated drone on one virtual clock: no socket, no thread, no waiting.
//!
//! Input: none. Output: what was sent and how each command ended, over a link that loses 8 % and delays 5 %.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::time::Duration;
use tello_sdk::emulator::{Channel, Emulator, EmulatorConfig, Faults, Kinematic, Timing};
use tello_sdk::{Command, Event, Input, Origin, Output, Session, SessionConfig};

fn main() -> Result<(), Box<dyn Error>> {
    let config = EmulatorConfig {
        faults: Faults::lossy(),
        seed: 11,
        ..EmulatorConfig::default()
    };
    let mut drone = Emulator::new(config, Kinematic::new(Timing::default()));
    let mut session = Session::new(SessionConfig::default())?;
    let client = SocketAddr::from(([127, 0, 0, 1], 8889));
    let mut now = Duration::ZERO;
    let mut script = ["command", "takeoff", "forward 100", "cw 90", "land"].into_iter();
    loop {
        if session.is_idle() {
            let Some(text) = script.next() else { break };
            session.request(now, Command::parse(text)?)?;
        }
        let wait = loop {
            match session.poll_output() {
                Output::WaitUntil(at) => break at,
                Output::Send(bytes) => {
                    println!(
                        "{:7.3} > {}",
                        now.as_secs_f64(),
                        String::from_utf8_lossy(&bytes)
                    );
                    drone.receive(now, client, &bytes);
                }
                Output::Event(Event::Finished {
                    command, outcome, ..
                }) => {
                    println!("{:7.3}   {command}: {outcome:?}", now.as_secs_f64());
                }
                Output::Event(_) => {}
            }
        };
        now = wait.min(drone.next_deadline()).max(now);
        while let Some(datagram) = drone.poll(now) {
            let (at, origin, bytes) = (now, Origin::Drone, &datagram.bytes[..]);
            session.handle_input(match datagram.channel {
                Channel::State => Input::State { at, origin, bytes },
                _ => Input::Reply { at, origin, bytes },
            });
        }
        session.handle_input(Input::Tick(now));
    }
    Ok(())
}
