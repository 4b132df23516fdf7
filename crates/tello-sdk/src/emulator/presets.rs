//! Named mixtures of faults, one for each thing that is known to go wrong.

use super::faults::{Faults, Impairment};
use core::time::Duration;

/// Names and meanings of all presets.
pub const PRESETS: [(&str, &str); 24] = [
    ("none", "nothing goes wrong"),
    (
        "wifi",
        "1 % of all datagrams lost, 2 % of commands not answered, as measured on good links",
    ),
    (
        "lossy",
        "8 % lost, 3 % doubled, 5 % delayed, late and missing replies, binary packets",
    ),
    (
        "random",
        "a mixture of every fault of the text protocol, drawn from the seed",
    ),
    (
        "lose-commands",
        "20 % of the commands never reach the drone",
    ),
    ("lose-replies", "20 % of the replies never arrive"),
    ("lose-state", "40 % of the state lines never arrive"),
    ("duplicates", "20 % of all datagrams arrive twice"),
    (
        "reorder",
        "20 % of all datagrams are held back for up to 2 s and overtaken",
    ),
    ("late-ok", "every second reply to a motion comes 9 s late"),
    (
        "unanswered",
        "20 % of the commands are carried out but not answered",
    ),
    ("silent-emergency", "`emergency` is never answered"),
    (
        "binary-packet",
        "a packet of the binary protocol comes 3 ms ahead of every second reply",
    ),
    ("other-port", "replies come from another port"),
    (
        "refusals",
        "30 % of the motions are refused with one of the known errors",
    ),
    ("low-battery", "the battery falls to 4 % after 20 s"),
    ("heat", "the drone is at 98 degrees Celsius from 20 s on"),
    (
        "imu-invalid",
        "motions are refused with `error No valid imu` for the first 20 s",
    ),
    (
        "vision-loss",
        "no texture below from 20 to 35 s: velocity reads zero, motions are refused",
    ),
    (
        "odometry-jump",
        "5 % of the odometry records jump by hundreds of metres (binary protocol)",
    ),
    (
        "video-loss",
        "3 % of the video datagrams and 30 % of the parameter sets are lost",
    ),
    (
        "exact-multiples",
        "every second picture fills its last datagram: 1460 bytes, no short one",
    ),
    ("wifi-gap", "nothing passes from 20 to 28 s"),
    (
        "auto-land",
        "the drone lands by itself after 20 s, and ignores `land` for 3 s after a take-off",
    ),
];

/// When faults with a time begin: a drone has taken off by then.
const BEGIN: Duration = Duration::from_secs(20);

impl Faults {
    /// The faults of a preset of [`PRESETS`]; `seed` draws those of `random`. `None` for another name.
    #[must_use]
    pub fn preset(name: &str, seed: u64) -> Option<Self> {
        match name {
            "none" => Some(Self::default()),
            "wifi" => Some(Self::wifi()),
            "lossy" => Some(Self::lossy()),
            "random" => Some(Self::random(seed)),
            _ => Self::of_link(name)
                .or_else(|| Self::of_replies(name))
                .or_else(|| Self::of_drone(name)),
        }
    }

    fn of_link(name: &str) -> Option<Self> {
        let mut faults = Self::default();
        match name {
            "lose-commands" => faults.commands.loss = 0.2,
            "lose-replies" => faults.replies.loss = 0.2,
            "lose-state" => faults.state.loss = 0.4,
            "duplicates" => {
                faults = Self::on_every_link(Impairment {
                    duplicate: 0.2,
                    duplicate_delay: Duration::from_millis(80),
                    ..Impairment::default()
                });
            }
            "reorder" => {
                faults = Self::on_every_link(Impairment {
                    delay: 0.2,
                    longest_delay: Duration::from_secs(2),
                    ..Impairment::default()
                });
            }
            "video-loss" => (faults.video.loss, faults.parameter_set_loss) = (0.03, 0.3),
            "exact-multiples" => faults.exact_multiples = 0.5,
            "wifi-gap" => faults.gap = Some((BEGIN, Duration::from_secs(28))),
            _ => return None,
        }
        Some(faults)
    }

    fn of_replies(name: &str) -> Option<Self> {
        let mut faults = Self::default();
        match name {
            "late-ok" => (faults.late, faults.late_by) = (0.5, Duration::from_secs(9)),
            "unanswered" => faults.unanswered = 0.2,
            "silent-emergency" => faults.silent_emergency = true,
            "binary-packet" => faults.binary_packet = 0.5,
            "other-port" => faults.other_port = 1.0,
            "refusals" => faults.refusal = 0.3,
            _ => return None,
        }
        Some(faults)
    }

    fn of_drone(name: &str) -> Option<Self> {
        let mut faults = Self::default();
        match name {
            "low-battery" => faults.battery_falls = Some((BEGIN, 4.0)),
            "heat" => faults.heat = Some((BEGIN, 98.0)),
            "imu-invalid" => faults.imu_invalid_until = BEGIN,
            "vision-loss" => faults.vision_loss = Some((BEGIN, Duration::from_secs(35))),
            "odometry-jump" => faults.odometry_jump = 0.05,
            "auto-land" => {
                faults.auto_land_at = Some(BEGIN);
                faults.deaf_to_land = Duration::from_secs(3);
            }
            _ => return None,
        }
        Some(faults)
    }

    fn on_every_link(link: Impairment) -> Self {
        Self {
            commands: link,
            replies: link,
            state: link,
            video: link,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn every_name_is_known_and_all_differ() {
        let all: Vec<Faults> = PRESETS
            .iter()
            .map(|(name, _)| Faults::preset(name, 3).unwrap_or_else(|| panic!("{name}")))
            .collect();
        for (index, faults) in all.iter().enumerate() {
            assert!(
                all.iter().skip(index + 1).all(|other| other != faults),
                "{}",
                PRESETS[index].0
            );
        }
        assert_eq!(Faults::preset("none", 3), Some(Faults::default()));
        assert_eq!(Faults::preset("nonsense", 3), None);
    }
}
