//! The binary session against the emulated drone in virtual time.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::net::SocketAddr;
use std::time::Duration;
use tello_sdk::binary::*;
use tello_sdk::emulator::{EmulatorConfig, Kinematic, Timing};
use tello_sdk::{Stick, Sticks};

struct Flight {
    session: BinarySession,
    drone: BinaryEmulator<Kinematic>,
    now: Duration,
    events: Vec<BinaryEvent>,
    sent: Vec<u16>,
    /// Every n-th datagram of either direction is lost; zero for none.
    lose: u64,
    count: u64,
}

impl Flight {
    fn new(lose: u64) -> Self {
        Self {
            session: BinarySession::new(BinaryConfig::default()),
            drone: BinaryEmulator::new(
                EmulatorConfig::default(),
                Kinematic::new(Timing::default()),
            ),
            now: Duration::ZERO,
            events: Vec::new(),
            sent: Vec::new(),
            lose,
            count: 0,
        }
    }

    fn is_lost(&mut self) -> bool {
        self.count += 1;
        self.lose > 0 && self.count.is_multiple_of(self.lose)
    }

    fn run(&mut self, span: Duration) {
        let end = self.now + span;
        loop {
            let wait = self.drain();
            let next = wait.min(self.drone.next_deadline()).max(self.now);
            if next > end {
                self.now = end;
                return;
            }
            self.now = next;
            while let Some(transmit) = self.drone.poll(self.now) {
                if !self.is_lost() {
                    self.session.handle_datagram(self.now, &transmit.bytes);
                    self.drain();
                }
            }
            self.session.handle_timeout(self.now);
        }
    }

    fn drain(&mut self) -> Duration {
        loop {
            match self.session.poll_output() {
                BinaryOutput::WaitUntil(at) => return at,
                BinaryOutput::Event(BinaryEvent::Telemetry) => {}
                BinaryOutput::Event(event) => self.events.push(event),
                BinaryOutput::Send(bytes) => {
                    self.sent
                        .extend(Frame::parse(&bytes).map(|frame| frame.message));
                    if !self.is_lost() {
                        let client = SocketAddr::from(([127, 0, 0, 1], 9000));
                        self.drone.receive(self.now, client, &bytes);
                    }
                }
            }
        }
    }

    fn ending(&self, wanted: CommandId) -> Option<Ending> {
        self.events.iter().find_map(|event| match event {
            BinaryEvent::Finished { id, ending, .. } if *id == wanted => Some(*ending),
            _ => None,
        })
    }
}

fn seconds(s: u64) -> Duration {
    Duration::from_secs(s)
}

#[test]
fn a_flight_with_sticks_and_log_records() {
    let mut flight = Flight::new(0);
    flight.run(seconds(1));
    assert_eq!(flight.events[0], BinaryEvent::Connected);
    let take_off = flight
        .session
        .command(flight.now, BinaryCommand::TakeOff)
        .unwrap();
    flight.run(seconds(5));
    assert_eq!(flight.ending(take_off), Some(Ending::Acknowledged));
    assert!(flight.session.telemetry().flying.unwrap().value);
    for _ in 0..10 {
        let turn = Sticks {
            yaw: Stick::MAX,
            ..Sticks::CENTER
        };
        flight.session.set_sticks(flight.now, turn);
        flight.run(Duration::from_millis(100));
    }
    flight.run(seconds(1));
    assert!(flight.events.contains(&BinaryEvent::SticksCentered));
    let telemetry = *flight.session.telemetry();
    let yaw = telemetry.attitude.unwrap().value.yaw_deg;
    // 90 degrees per second for a second, and half a second until the watchdog.
    assert!((100.0..150.0).contains(&yaw), "{yaw}");
    assert!(telemetry.position_m.unwrap().valid && telemetry.velocity.unwrap().valid);
    assert!(telemetry.battery.unwrap().value.percent() > 80);
    let land = flight
        .session
        .command(flight.now, BinaryCommand::Land)
        .unwrap();
    flight.run(seconds(5));
    assert_eq!(flight.ending(land), Some(Ending::Confirmed));
    assert!(!flight.drone.is_flying());
    assert_eq!(flight.session.rejected(), 0);
}

#[test]
fn with_loss_no_motion_is_sent_twice_and_it_lands() {
    for lose in 2..12 {
        let mut flight = Flight::new(lose);
        flight.run(seconds(4));
        flight
            .session
            .command(flight.now, BinaryCommand::TakeOff)
            .unwrap();
        flight.run(seconds(6));
        flight
            .session
            .command(flight.now, BinaryCommand::Flip(0))
            .unwrap();
        flight.run(seconds(3));
        let land = flight
            .session
            .command(flight.now, BinaryCommand::Land)
            .unwrap();
        flight.run(seconds(60));
        assert_eq!(
            flight.ending(land),
            Some(Ending::Confirmed),
            "every {lose}th lost"
        );
        assert!(!flight.drone.is_flying());
        let count = |message: Message| flight.sent.iter().filter(|&&m| m == message as u16).count();
        assert_eq!((count(Message::TakeOff), count(Message::Flip)), (1, 1));
    }
}

#[test]
fn a_dead_link_ends_the_landing_in_time() {
    let mut flight = Flight::new(1);
    let land = flight
        .session
        .command(flight.now, BinaryCommand::Land)
        .unwrap();
    flight.run(seconds(61));
    assert_eq!(flight.ending(land), Some(Ending::Unknown));
    assert_eq!(
        flight
            .sent
            .iter()
            .filter(|&&m| m == Message::Land as u16)
            .count(),
        60
    );
}
