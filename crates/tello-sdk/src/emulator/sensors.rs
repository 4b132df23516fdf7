//! What the drone's sensors make of the truth: whole degrees, decimetres per second, steps of 10 cm.

use super::physics::Physics;
use super::{Channel, Emulator, loses_parameter_set, pad_to_multiple};
use crate::state::StateLine;
use crate::video::datagrams;
use core::net::SocketAddr;
use core::time::Duration;

impl<P: Physics> Emulator<P> {
    /// The state as the wire has it.
    pub(super) fn state_line(&self) -> StateLine {
        let truth = self.body.physics.truth();
        let whole = |value: f64| Some(nearest(value));
        let blind = self.config.faults.is_blind(self.now);
        let velocity = if blind { [0.0; 3] } else { truth.velocity };
        let height = if truth.motors {
            truth.height - self.height_offset
        } else {
            0.0
        };
        let warm = self.body.temperature(&self.config);
        let mut line = StateLine {
            pitch: whole(truth.attitude_deg[0]),
            roll: whole(truth.attitude_deg[1]),
            yaw: whole(truth.attitude_deg[2]),
            velocity: velocity.map(|v| whole(v * 10.0)),
            templ: whole(warm),
            temph: whole(warm + 3.0),
            tof: whole((truth.ground_distance * 100.0).clamp(10.0, 6553.0)),
            h: Some(nearest(height * 10.0 - 0.5) * 10.0),
            bat: Some((self.body.battery as i64) as f64),
            baro: Some(93.0 + truth.height),
            time: Some(self.body.motor_time.as_secs() as f64),
            acceleration: truth.acceleration.map(|a| Some(a / 9.806_65 * 1000.0)),
            ..StateLine::default()
        };
        self.add_pad(&mut line);
        line
    }

    pub(super) fn send_state(&mut self) {
        let Some(client) = self.client else { return };
        let bytes = self.state_line().encode(self.config.version).into_bytes();
        let to = SocketAddr::new(client.ip(), self.config.state_port);
        self.push(to, bytes, Channel::State, Duration::ZERO);
    }

    /// Cuts the next access unit into datagrams as the drone does.
    pub(super) fn send_video(&mut self, at: Duration) {
        let Some(client) = self.client else { return };
        let Some(mut unit) = self.camera.shoot(at, self.target) else {
            return;
        };
        let to = SocketAddr::new(client.ip(), self.config.video_port);
        if self.random.chance(self.config.faults.exact_multiples) {
            pad_to_multiple(&mut unit);
        }
        for datagram in datagrams(&unit) {
            if !loses_parameter_set(datagram, &self.config.faults, &mut self.random) {
                self.push(to, datagram.to_vec(), Channel::Video, Duration::ZERO);
            }
        }
    }
}

fn nearest(value: f64) -> f64 {
    (value + if value < 0.0 { -0.5 } else { 0.5 }) as i64 as f64
}
