//! Flight data: height, speeds, battery and flags, about ten times a second.

use crate::telemetry::{Reading, Source, Telemetry, Velocity, VelocityFrame};
use crate::units::Battery;
use core::time::Duration;

/// The 24 bytes of a flight-data message, as far as their meaning is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FlightData {
    /// Height, decimetres.
    pub height_dm: i16,
    /// Speed to the north, decimetres per second (as the name has it; the axes were not verified).
    pub north_speed: i16,
    /// Speed to the east, decimetres per second.
    pub east_speed: i16,
    /// Speed over ground or vertical speed: sources differ.
    pub ground_speed: i16,
    /// Time in the air.
    pub fly_time: i16,
    /// Bits: attitude, pressure, downward camera, power, battery, gravity, -, wind.
    pub state_bits: u8,
    /// State of the attitude sensor's calibration.
    pub calibration: u8,
    /// Charge, percent.
    pub battery_percent: u8,
    /// Flight time left, tenths of a second.
    pub fly_time_left: i16,
    /// Bits: in the air, on the ground, motors open, hovers, records an outage, battery low, battery lower, factory.
    pub flight_bits: u8,
    /// Mode of flight.
    pub fly_mode: u8,
    /// State of the camera.
    pub camera_state: u8,
    /// Too hot.
    pub is_hot: bool,
}

impl FlightData {
    /// Reads the message's content; `None` with fewer than 24 bytes.
    #[must_use]
    pub fn parse(payload: &[u8]) -> Option<Self> {
        let data: &[u8; 24] = payload.first_chunk()?;
        let word = |at: usize| i16::from_le_bytes([data[at], data[at + 1]]);
        Some(Self {
            height_dm: word(0),
            north_speed: word(2),
            east_speed: word(4),
            ground_speed: word(6),
            fly_time: word(8),
            state_bits: data[10],
            calibration: data[11],
            battery_percent: data[12],
            fly_time_left: word(15),
            flight_bits: data[17],
            fly_mode: data[18],
            camera_state: data[20],
            is_hot: data[23] & 1 == 1,
        })
    }

    /// Writes the message's content; unknown bytes are zero.
    #[must_use]
    pub fn encode(&self) -> [u8; 24] {
        let mut data = [0; 24];
        let words = [
            (0, self.height_dm),
            (2, self.north_speed),
            (4, self.east_speed),
            (6, self.ground_speed),
            (8, self.fly_time),
            (15, self.fly_time_left),
        ];
        for (at, word) in words {
            data[at..at + 2].copy_from_slice(&word.to_le_bytes());
        }
        data[10] = self.state_bits;
        data[11] = self.calibration;
        data[12] = self.battery_percent;
        data[17] = self.flight_bits;
        data[18] = self.fly_mode;
        data[20] = self.camera_state;
        data[23] = u8::from(self.is_hot);
        data
    }

    /// Whether the drone says that it is in the air.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.flight_bits & 1 == 1
    }

    /// Whether it asks for a landing because of the battery.
    #[must_use]
    pub fn is_battery_low(&self) -> bool {
        self.flight_bits & 0b0110_0000 != 0
    }

    /// The values with units, received at `at`. The velocity's axes are north, east and none, so its frame is unsettled
    /// and its third component invalid.
    #[must_use]
    pub fn telemetry(&self, at: Duration) -> Telemetry {
        let velocity = Velocity {
            meters_per_s: [
                f64::from(self.north_speed) * 0.1,
                f64::from(self.east_speed) * 0.1,
                0.0,
            ],
            frame: VelocityFrame::Unsettled,
            valid: [true, true, false],
        };
        let reading = Reading::new(velocity, at, Source::FlightData);
        let mut telemetry = Telemetry::builder(at, Source::FlightData)
            .height_m(f64::from(self.height_dm) * 0.1)
            .flying(self.is_flying())
            .build();
        // Bit 2: the downward camera, which measures the velocity, has trouble.
        telemetry.velocity = Some(reading.with_validity(self.state_bits & 0b100 == 0));
        let battery = Battery::from_percent(i64::from(self.battery_percent)).ok();
        telemetry.battery = battery.map(|value| Reading::new(value, at, Source::FlightData));
        telemetry
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_content_comes_back_and_short_ones_are_refused() {
        let data = FlightData {
            height_dm: -3,
            battery_percent: 71,
            flight_bits: 0b0010_0001,
            is_hot: true,
            ..Default::default()
        };
        assert_eq!(FlightData::parse(&data.encode()), Some(data));
        assert!(data.is_flying() && data.is_battery_low());
        assert_eq!(FlightData::parse(&[0; 23]), None);
        let t = data.telemetry(Duration::ZERO);
        assert!((t.height_m.unwrap().value + 0.3).abs() < 1e-12);
        assert_eq!(t.battery.unwrap().value.percent(), 71);
    }
}
