//! The drone's replies: values of queries, and the faulty way back.

use super::physics::Physics;
use super::{Channel, Departure, Emulator, Lane, Transmit};
use crate::command::{Command, Query, SdkVersion};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::time::Duration;

impl<P: Physics> Emulator<P> {
    pub(super) fn answer_query(&mut self, command: &Command, from: SocketAddr) {
        if let Command::Query(query) = command {
            let text = self.value(*query);
            self.answer(from, &text);
        }
    }

    /// Values as reported by users: with units, with CR LF.
    fn value(&self, query: Query) -> String {
        let line = self.state_line();
        let cm = |value: Option<f64>| value.unwrap_or(0.0) as i64;
        match query {
            Query::Speed => format!("{:.1}\r\n", self.speed * 100.0),
            Query::Battery => format!("{}\r\n", self.body.battery as i64),
            Query::MotorTime => format!("{}s\r\n", self.body.motor_time.as_secs()),
            Query::Wifi => "90\r\n".into(),
            Query::Height => format!("{}dm\r\n", cm(line.h) / 10),
            Query::Temperature => format!("{}~{}C\r\n", cm(line.templ), cm(line.temph)),
            Query::Attitude => format!(
                "pitch:{};roll:{};yaw:{};\r\n",
                cm(line.pitch),
                cm(line.roll),
                cm(line.yaw)
            ),
            Query::Barometer => format!("{:.6}\r\n", line.baro.unwrap_or(0.0)),
            Query::Acceleration => {
                let [x, y, z] = line.acceleration.map(|a| a.unwrap_or(0.0));
                format!("agx:{x:.2};agy:{y:.2};agz:{z:.2};\r\n")
            }
            Query::Tof => format!("{}mm\r\n", cm(line.tof) * 10),
            Query::Sdk => format!("{}\r\n", self.version_text()),
            Query::SerialNumber => format!("{}\r\n", self.config.serial_number),
            Query::Hardware if self.config.version == SdkVersion::Rmtt => "RMTT".into(),
            Query::Hardware => "TELLO".into(),
            Query::WifiVersion => "wifiv1.0.0.33".into(),
            Query::AccessPoint => "emulated-ap".into(),
            Query::Ssid => "TELLO-EMULATED".into(),
            Query::ExtTof => format!("tof {}", cm(line.tof) * 10),
            Query::ExtVersion => "esp32v1.0.0.33".into(),
        }
    }

    /// A reply without extra delay.
    pub(super) fn answer(&mut self, to: SocketAddr, text: &str) {
        self.reply(to, text, Duration::ZERO);
    }

    /// A reply with the faults of replies.
    pub(super) fn reply(&mut self, to: SocketAddr, text: &str, late: Duration) {
        if self.random.chance(self.config.faults.unanswered) {
            return;
        }
        let other = self.random.chance(self.config.faults.other_port);
        let channel = if other {
            Channel::ReplyFromOtherPort
        } else {
            Channel::Reply
        };
        if self.random.chance(self.config.faults.binary_packet) {
            self.push(to, FLIGHT_DATA.to_vec(), Channel::Reply, late);
        }
        self.say(to, text, late + Duration::from_millis(3), channel);
    }

    /// Sends a text on a channel.
    pub(super) fn say(&mut self, to: SocketAddr, text: &str, late: Duration, channel: Channel) {
        self.push(to, text.to_string().into_bytes(), channel, late);
    }

    pub(super) fn push(
        &mut self,
        to: SocketAddr,
        bytes: Vec<u8>,
        channel: Channel,
        late: Duration,
    ) {
        let lane = match channel {
            Channel::Reply | Channel::ReplyFromOtherPort => Lane::Reply,
            Channel::State => Lane::State,
            Channel::Video => Lane::Video,
        };
        let transmit = Transmit {
            answers: self.answering.filter(|_| lane != Lane::State),
            ..Transmit::new(channel, to, bytes)
        };
        let departure = Departure {
            lane,
            transmit,
            late,
            prompt: self.answers_doubled,
        };
        let (timing, faults) = (&self.config.timing, &self.config.faults);
        self.link
            .send(self.now, timing, faults, &mut self.random, departure);
    }
}

/// A captured shape: a flight-data packet of the binary protocol, 35 bytes, message 0x0056 (the content is zero).
const FLIGHT_DATA: [u8; 35] = {
    let mut packet = [0; 35];
    packet[0] = 0xCC;
    packet[1] = (35_u16 << 3) as u8;
    packet[2] = ((35_u16 << 3) >> 8) as u8;
    packet[4] = 0x88;
    packet[5] = 0x56;
    packet
};
