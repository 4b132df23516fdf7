//! What the drone's sensors make of the truth: whole degrees, decimetres per second, steps of 10 cm.

use super::physics::Physics;
use super::{Channel, Emulator};
use crate::state::StateLine;
use crate::video::datagrams;
use core::net::SocketAddr;
use core::time::Duration;

impl<P: Physics> Emulator<P> {
    /// The state as the wire has it.
    pub(super) fn state_line(&self) -> StateLine {
        let truth = self.physics.truth();
        let whole = |value: f64| Some(nearest(value));
        let blind = self
            .config
            .faults
            .vision_loss
            .is_some_and(|(from, to)| (from..to).contains(&self.now));
        let velocity = if blind { [0.0; 3] } else { truth.velocity };
        let height = if truth.motors {
            truth.height - self.height_offset
        } else {
            0.0
        };
        let warm = 60.0 + (self.motor_time.as_secs_f64() / 60.0).min(20.0);
        StateLine {
            pitch: whole(truth.attitude_deg[0]),
            roll: whole(truth.attitude_deg[1]),
            yaw: whole(truth.attitude_deg[2]),
            velocity: velocity.map(|v| whole(v * 10.0)),
            templ: whole(warm),
            temph: whole(warm + 3.0),
            tof: whole((truth.ground_distance * 100.0).clamp(10.0, 6553.0)),
            h: Some(nearest(height * 10.0 - 0.5) * 10.0),
            bat: Some((self.battery as i64) as f64),
            baro: Some(93.0 + truth.height),
            time: Some(self.motor_time.as_secs() as f64),
            acceleration: truth.acceleration.map(|a| Some(a / 9.806_65 * 1000.0)),
            ..StateLine::default()
        }
    }

    pub(super) fn send_state(&mut self) {
        let Some(client) = self.client else { return };
        let bytes = self.state_line().encode(self.config.version).into_bytes();
        let to = SocketAddr::new(client.ip(), self.config.state_port);
        self.push(to, bytes, Channel::State, Duration::ZERO);
    }

    /// Cuts the next access unit into datagrams as the drone does.
    pub(super) fn send_video(&mut self, at: Duration) {
        let (Some(client), Some(source)) = (self.client, self.video.as_mut()) else {
            return;
        };
        let to = SocketAddr::new(client.ip(), self.config.video_port);
        let period = source.period().max(Duration::from_millis(1));
        // A camera that is slower than its period skips pictures instead of falling behind for ever.
        let late = at + period * 2 < self.target;
        self.next_video = Some(if late { self.target } else { at } + period);
        let Some(unit) = source.next_unit(at) else {
            return;
        };
        for datagram in datagrams(&unit) {
            let is_parameter_set = crate::video::begins_with_parameter_set(datagram);
            let loss = self.config.faults.parameter_set_loss;
            if !(is_parameter_set && self.random.chance(loss)) {
                self.push(to, datagram.to_vec(), Channel::Video, Duration::ZERO);
            }
        }
    }
}

fn nearest(value: f64) -> f64 {
    (value + if value < 0.0 { -0.5 } else { 0.5 }) as i64 as f64
}
