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

impl Faults {
    /// The faults of a preset of [`PRESETS`]; `seed` draws those of `random`. `None` for another name.
    #[must_use]
    pub fn preset(name: &str, seed: u64) -> Option<Self> {
        let seconds = Duration::from_secs;
        let none = Self::default();
        let lose = |loss| Impairment {
            loss,
            ..Impairment::default()
        };
        Some(match name {
            "none" => none,
            "wifi" => Self::wifi(),
            "lossy" => Self::lossy(),
            "random" => Self::random(seed),
            "lose-commands" => Self {
                commands: lose(0.2),
                ..none
            },
            "lose-replies" => Self {
                replies: lose(0.2),
                ..none
            },
            "lose-state" => Self {
                state: lose(0.4),
                ..none
            },
            "duplicates" => Self::on_every_link(Impairment {
                duplicate: 0.2,
                duplicate_delay: Duration::from_millis(80),
                ..Impairment::default()
            }),
            "reorder" => Self::on_every_link(Impairment {
                delay: 0.2,
                longest_delay: seconds(2),
                ..Impairment::default()
            }),
            "late-ok" => Self {
                late: 0.5,
                late_by: seconds(9),
                ..none
            },
            "unanswered" => Self {
                unanswered: 0.2,
                ..none
            },
            "silent-emergency" => Self {
                silent_emergency: true,
                ..none
            },
            "binary-packet" => Self {
                binary_packet: 0.5,
                ..none
            },
            "other-port" => Self {
                other_port: 1.0,
                ..none
            },
            "refusals" => Self {
                refusal: 0.3,
                ..none
            },
            "low-battery" => Self {
                battery_falls: Some((seconds(20), 4.0)),
                ..none
            },
            "heat" => Self {
                heat: Some((seconds(20), 98.0)),
                ..none
            },
            "imu-invalid" => Self {
                imu_invalid_until: seconds(20),
                ..none
            },
            "vision-loss" => Self {
                vision_loss: Some((seconds(20), seconds(35))),
                ..none
            },
            "odometry-jump" => Self {
                odometry_jump: 0.05,
                ..none
            },
            "video-loss" => Self {
                video: lose(0.03),
                parameter_set_loss: 0.3,
                ..none
            },
            "exact-multiples" => Self {
                exact_multiples: 0.5,
                ..none
            },
            "wifi-gap" => Self {
                gap: Some((seconds(20), seconds(28))),
                ..none
            },
            "auto-land" => Self {
                auto_land_at: Some(seconds(20)),
                deaf_to_land: seconds(3),
                ..none
            },
            _ => return None,
        })
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
