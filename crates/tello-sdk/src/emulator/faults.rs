//! What can go wrong between the drone and its client, and inside the drone; every fault is drawn from one seed.

use super::random::Random;
use core::time::Duration;

/// How one direction of one channel treats datagrams.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Impairment {
    /// Probability that a datagram is lost.
    pub loss: f64,
    /// Probability that a datagram arrives twice. The drone answers both copies of a command; neither answer is held
    /// back by `delay` then (a client would otherwise have to pause that long after every command).
    pub duplicate: f64,
    /// How much later the copy comes at most.
    pub duplicate_delay: Duration,
    /// Probability that a datagram is held back, so that later ones overtake it.
    pub delay: f64,
    /// How long it is held back at most.
    pub longest_delay: Duration,
}

/// Faults of a drone and its link. `Default` is none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Faults {
    /// Commands on their way to the drone.
    pub commands: Impairment,
    /// Replies.
    pub replies: Impairment,
    /// State lines.
    pub state: Impairment,
    /// Video datagrams.
    pub video: Impairment,
    /// Probability that the drone does not answer a command that it carries out (about 2 % were measured).
    pub unanswered: f64,
    /// Probability that the reply to a motion is held back by `late_by`.
    pub late: f64,
    /// How long a late reply is held back.
    pub late_by: Duration,
    /// `emergency` is not answered.
    pub silent_emergency: bool,
    /// Probability that a packet of the binary protocol comes 3 ms ahead of a reply.
    pub binary_packet: f64,
    /// Probability that a reply comes from another port.
    pub other_port: f64,
    /// Probability that a motion is refused with one of the known errors instead of being carried out.
    pub refusal: f64,
    /// After a take-off, `land` is ignored for this long.
    pub deaf_to_land: Duration,
    /// Nothing passes in either direction between these times (a Wi-Fi gap).
    pub gap: Option<(Duration, Duration)>,
    /// The attitude is not valid before this time: motions are refused with `error No valid imu`.
    pub imu_invalid_until: Duration,
    /// The drone lands by itself at this time.
    pub auto_land_at: Option<Duration>,
    /// Probability that a datagram that begins with a parameter set is lost (on top of `video`).
    pub parameter_set_loss: f64,
    /// Probability that a picture is padded with zeros so that its last datagram is a full one.
    pub exact_multiples: f64,
    /// From this time on the charge is at most so many percent.
    pub battery_falls: Option<(Duration, f64)>,
    /// From this time on it is at least so hot inside, degrees Celsius.
    pub heat: Option<(Duration, f64)>,
    /// Between these times the downward camera sees no texture: the velocity reads zero, odometry is not valid, and
    /// motions are refused with `error No valid imu`.
    pub vision_loss: Option<(Duration, Duration)>,
    /// Probability, per record, that the visual odometry jumps by hundreds of metres (binary protocol).
    pub odometry_jump: f64,
}

impl Faults {
    /// A good Wi-Fi link: measured round trips come from [`Timing`](super::Timing), here only rare losses.
    #[must_use]
    pub fn wifi() -> Self {
        let link = Impairment {
            loss: 0.01,
            ..Impairment::default()
        };
        Self {
            commands: link,
            replies: link,
            state: link,
            video: link,
            unanswered: 0.02,
            ..Self::default()
        }
    }

    /// A bad link: losses, copies, delays, late and missing replies, binary packets among them.
    #[must_use]
    pub fn lossy() -> Self {
        let link = Impairment {
            loss: 0.08,
            duplicate: 0.03,
            duplicate_delay: Duration::from_millis(40),
            delay: 0.05,
            longest_delay: Duration::from_millis(600),
        };
        Self {
            commands: link,
            replies: link,
            state: link,
            video: Impairment { loss: 0.02, ..link },
            unanswered: 0.05,
            late: 0.05,
            late_by: Duration::from_secs(2),
            silent_emergency: true,
            binary_packet: 0.05,
            other_port: 0.02,
            ..Self::default()
        }
    }

    /// A random mixture of every fault of the text protocol, for scenario tests; the same seed is the same mixture.
    ///
    /// Delays stay below 2.5 s and copies below 80 ms: the bounds that a client may rely on.
    #[must_use]
    pub fn random(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let ms = Duration::from_millis;
        let mut link = |worst: f64| Impairment {
            loss: worst * random.unit(),
            duplicate: 0.2 * random.unit(),
            duplicate_delay: random.up_to(ms(80)),
            delay: 0.2 * random.unit(),
            longest_delay: random.up_to(ms(2000)),
        };
        let (commands, replies, state) = (link(0.3), link(0.3), link(0.4));
        let gap_start = random.up_to(Duration::from_secs(60));
        let gap = (gap_start, gap_start + random.up_to(Duration::from_secs(12)));
        Self {
            commands,
            replies,
            state,
            unanswered: 0.2 * random.unit(),
            late: 0.3 * random.unit(),
            late_by: random.up_to(Duration::from_secs(12)),
            silent_emergency: random.chance(0.5),
            binary_packet: 0.2 * random.unit(),
            other_port: 0.2 * random.unit(),
            refusal: 0.2 * random.unit(),
            deaf_to_land: random.up_to(Duration::from_secs(5)),
            gap: random.chance(0.3).then_some(gap),
            imu_invalid_until: if random.chance(0.2) {
                random.up_to(Duration::from_secs(20))
            } else {
                Duration::ZERO
            },
            auto_land_at: random
                .chance(0.1)
                .then(|| random.up_to(Duration::from_secs(60))),
            ..Self::default()
        }
    }

    /// Whether the downward camera sees nothing at this time.
    pub(crate) fn is_blind(&self, at: Duration) -> bool {
        self.vision_loss
            .is_some_and(|(from, to)| (from..to).contains(&at))
    }

    /// Whether nothing passes at this time.
    pub(crate) fn is_gap(&self, at: Duration) -> bool {
        self.gap.is_some_and(|(from, to)| (from..to).contains(&at))
    }
}
