//! A session and an emulated drone on one virtual clock, with every attribution checked against the drone's own log.

use std::net::SocketAddr;
use std::time::Duration;
use tello_sdk::emulator::{Channel, Emulator, EmulatorConfig, Kinematic};
use tello_sdk::*;

pub(crate) struct Flight {
    pub(crate) session: Session,
    pub(crate) drone: Emulator<Kinematic>,
    pub(crate) now: Duration,
    pub(crate) events: Vec<(Duration, Event)>,
    /// Every datagram that the session sent.
    pub(crate) sent: Vec<(Duration, String)>,
    /// The whole session as a recording.
    pub(crate) recording: Vec<u8>,
    /// Every reply that arrived.
    pub(crate) heard: Vec<(Duration, String)>,
    /// Replies attributed to a command that the drone did not answer with them.
    pub(crate) misattributed: Vec<String>,
}

fn client() -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], 8889))
}

impl Flight {
    pub(crate) fn new(session: SessionConfig, drone: EmulatorConfig) -> Self {
        let physics = Kinematic::new(drone.timing);
        Self {
            session: Session::new(session).unwrap(),
            drone: Emulator::new(drone, physics),
            now: Duration::ZERO,
            events: Vec::new(),
            sent: Vec::new(),
            recording: Vec::new(),
            heard: Vec::new(),
            misattributed: Vec::new(),
        }
    }

    /// Lets everything happen until `end`, or until `done` says so after an event.
    pub(crate) fn run(&mut self, end: Duration, mut done: impl FnMut(&Self) -> bool) {
        loop {
            let wait = self.drain(None).max(self.now);
            if done(self) {
                return;
            }
            let next = wait.min(self.drone.next_deadline()).max(self.now);
            if next > end {
                self.now = end;
                self.session.handle_input(Input::Tick(end));
                self.drain(None);
                return;
            }
            self.now = next;
            self.deliver();
            self.session.handle_input(Input::Tick(self.now));
        }
    }

    fn deliver(&mut self) {
        while let Some(transmit) = self.drone.poll(self.now) {
            let (at, bytes) = (self.now, &transmit.bytes[..]);
            let input = match transmit.channel {
                Channel::Reply => Input::Reply {
                    at,
                    origin: Origin::Drone,
                    bytes,
                },
                Channel::ReplyFromOtherPort => Input::Reply {
                    at,
                    origin: Origin::OtherPort,
                    bytes,
                },
                Channel::State => Input::State {
                    at,
                    origin: Origin::Drone,
                    bytes,
                },
                Channel::Video => continue,
            };
            if transmit.channel != Channel::State {
                let question = transmit
                    .answers
                    .and_then(|index| self.drone.log().get(index));
                let question = question.map_or("", |received| &received.text);
                let text = String::from_utf8_lossy(bytes);
                self.heard
                    .push((at, format!("{} to `{question}`", text.trim())));
            }
            match transmit.channel {
                Channel::State => self.record(record::Channel::State, bytes),
                _ => self.record(record::Channel::Reply, bytes),
            }
            self.session.handle_input(input);
            let answered = transmit
                .answers
                .and_then(|index| self.drone.log().get(index));
            let answered = answered.map(|received| received.text.clone());
            self.drain(answered.as_deref());
        }
    }

    /// Takes the session's outputs; `answered` is the command that the drone just answered.
    fn drain(&mut self, answered: Option<&str>) -> Duration {
        loop {
            match self.session.poll_output() {
                Output::WaitUntil(wait) => return wait,
                Output::Send(bytes) => {
                    let text = String::from_utf8(bytes.clone()).unwrap();
                    self.record(record::Channel::Sent, &bytes);
                    self.sent.push((self.now, text));
                    self.drone.receive(self.now, client(), &bytes);
                }
                Output::Event(event) => {
                    self.check(&event, answered);
                    if event != Event::Telemetry {
                        self.events.push((self.now, event));
                    }
                }
            }
        }
    }

    fn check(&mut self, event: &Event, answered: Option<&str>) {
        if let Event::Finished {
            command, outcome, ..
        } = event
        {
            let attributed = matches!(outcome, Outcome::Answered(_) | Outcome::Refused { .. });
            if attributed && answered != Some(&command.to_string()) {
                self.misattributed
                    .push(format!("{command} <- {outcome:?} of {answered:?}"));
            }
        }
    }

    fn record(&mut self, channel: record::Channel, bytes: &[u8]) {
        record::encode(
            &record::Record {
                at: self.now,
                channel,
                bytes,
            },
            &mut self.recording,
        );
    }

    /// Requests a command and runs until it has ended or a long time has passed.
    pub(crate) fn fly(&mut self, text: &str) -> Outcome {
        self.record(record::Channel::Request, text.as_bytes());
        let id = self
            .session
            .request(self.now, Command::parse(text).unwrap())
            .unwrap();
        self.wait(id, Duration::from_secs(120))
            .unwrap_or_else(|| panic!("`{text}` did not end"))
    }

    pub(crate) fn wait(&mut self, id: RequestId, longest: Duration) -> Option<Outcome> {
        let start = self.events.len();
        let ended = |flight: &Self| {
            flight.events[start..]
                .iter()
                .any(|(_, e)| outcome_of(e, id).is_some())
        };
        self.run(self.now + longest, ended);
        self.events[start..]
            .iter()
            .find_map(|(_, e)| outcome_of(e, id))
    }

    /// Everything that was said, for the message of a failed test.
    #[allow(
        dead_code,
        reason = "each test file that includes this module uses a part of it"
    )]
    pub(crate) fn transcript(&self) -> String {
        let mut lines: Vec<(Duration, String)> = Vec::new();
        lines.extend(
            self.sent
                .iter()
                .map(|(at, text)| (*at, format!("> {text}"))),
        );
        lines.extend(
            self.heard
                .iter()
                .map(|(at, text)| (*at, format!("< {text}"))),
        );
        lines.extend(
            self.events
                .iter()
                .map(|(at, event)| (*at, format!("    {event:?}"))),
        );
        lines.sort();
        lines
            .iter()
            .map(|(at, line)| format!("{:9.3} {line}\n", at.as_secs_f64()))
            .collect()
    }

    /// How often a text was sent.
    #[allow(
        dead_code,
        reason = "each test file that includes this module uses a part of it"
    )]
    pub(crate) fn count_sent(&self, text: &str) -> usize {
        self.sent.iter().filter(|(_, sent)| sent == text).count()
    }
}

fn outcome_of(event: &Event, wanted: RequestId) -> Option<Outcome> {
    match event {
        Event::Finished { id, outcome, .. } if *id == wanted => Some(outcome.clone()),
        _ => None,
    }
}
