//! The stick message: four axes of 11 bits, 1024 at rest, plus or minus 660 at the end; one bit for fast mode.

use crate::session::Sticks;
use crate::units::Stick;

/// Counts at full deflection.
const FULL: i32 = 660;
/// Counts at rest.
const REST: i32 = 1024;

/// The content of a stick message: axes, then hour, minute, second and milliseconds of the day.
#[must_use]
pub fn encode_sticks(sticks: Sticks, fast: bool, milliseconds_of_day: u32) -> [u8; 11] {
    let axis = |stick: Stick| (REST + i32::from(stick.percent()) * FULL / 100) as u64 & 0x7FF;
    let packed = axis(sticks.roll)
        | axis(sticks.pitch) << 11
        | axis(sticks.throttle) << 22
        | axis(sticks.yaw) << 33
        | u64::from(fast) << 44;
    let [b0, b1, b2, b3, b4, b5, ..] = packed.to_le_bytes();
    let seconds = milliseconds_of_day / 1000;
    let [m0, m1] = ((milliseconds_of_day % 1000) as u16).to_le_bytes();
    let (hour, minute) = ((seconds / 3600 % 24) as u8, (seconds / 60 % 60) as u8);
    [
        b0,
        b1,
        b2,
        b3,
        b4,
        b5,
        hour,
        minute,
        (seconds % 60) as u8,
        m0,
        m1,
    ]
}

/// Reads the axes, rounded to percent; `None` with fewer than six bytes or an axis beyond its end.
#[must_use]
pub fn decode_sticks(payload: &[u8]) -> Option<(Sticks, bool)> {
    let [b0, b1, b2, b3, b4, b5, ..] = payload else {
        return None;
    };
    let packed = u64::from_le_bytes([*b0, *b1, *b2, *b3, *b4, *b5, 0, 0]);
    let axis = |shift: u32| {
        let counts = ((packed >> shift) & 0x7FF) as i32 - REST;
        let percent = (counts * 100 + counts.signum() * FULL / 2) / FULL;
        Stick::from_percent(i64::from(percent)).ok()
    };
    let sticks = Sticks {
        roll: axis(0)?,
        pitch: axis(11)?,
        throttle: axis(22)?,
        yaw: axis(33)?,
    };
    Some((sticks, packed >> 44 & 1 == 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_percentage_comes_back() {
        for percent in -100..=100 {
            let stick = Stick::from_percent(percent).unwrap();
            let opposite = Stick::from_percent(-percent).unwrap();
            let sticks = Sticks {
                roll: stick,
                pitch: opposite,
                throttle: stick,
                yaw: opposite,
            };
            let payload = encode_sticks(sticks, percent > 0, 12_345_678);
            assert_eq!(decode_sticks(&payload), Some((sticks, percent > 0)));
        }
        assert_eq!(decode_sticks(&[0; 5]), None);
        assert_eq!(decode_sticks(&[0; 11]), None);
    }

    #[test]
    fn the_time_of_day_is_in_it() {
        let payload = encode_sticks(
            Sticks::CENTER,
            false,
            ((13 * 60 + 14) * 60 + 15) * 1000 + 678,
        );
        assert_eq!(payload[6..], [13, 14, 15, 166, 2]);
    }
}
