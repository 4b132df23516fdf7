//! Exits of generated rooms after the project's own outlier removal: precision, recall and silence at three outlier rates.
//! Of a bare map, of which all that is known is the agent's position, and of one that tells which keyframe observes which point.
//!
//! `cargo run --release -p examples --example exits_of_generated_rooms [-- FIRST_SEED [ROOMS [bare|observed]]]`
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../crates/exit-finder/tests/generator/mod.rs"]
mod generator;
#[path = "../crates/exit-finder/tests/scoring/mod.rs"]
mod scoring;

use exit_finder::ExitConfig;
use generator::{Kind, Scan};
use scoring::{Suite, evaluate};
use submodular_minimax::{Cues, OutlierConfig, Views, remove_outliers};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// How a cloud is cleaned before the search.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cleaning {
    name: &'static str,
    knowing: Knowing,
    /// Whether the search is told what was taken out.
    told: bool,
}

/// What a cleaning goes by.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Knowing {
    /// There is none.
    NotCleaned,
    /// The agent's place is the viewpoint; distances are divided by this power of the range.
    Position(f64),
    /// The observations.
    Observations,
}

use Knowing::{NotCleaned, Observations, Position};

/// By default, and with a higher power: far points behind doors are sparser than near ones.
const OF_BARE_MAPS: [Cleaning; 5] = [
    cleaning("none", NotCleaned, false),
    cleaning("from position", Position(0.8), false),
    cleaning("the same, told", Position(0.8), true),
    cleaning("for exits", Position(1.4), false),
    cleaning("the same, told", Position(1.4), true),
];
const OF_OBSERVED: [Cleaning; 3] = [
    cleaning("none", NotCleaned, false),
    cleaning("observations", Observations, false),
    cleaning("the same, told", Observations, true),
];

const fn cleaning(name: &'static str, knowing: Knowing, told: bool) -> Cleaning {
    Cleaning {
        name,
        knowing,
        told,
    }
}

/// What is measured: rooms of a kind at a rate of outliers, cleaned in some ways.
#[derive(Debug, Clone, Copy)]
struct Task {
    kind: Kind,
    outliers: f64,
    observed: bool,
    cleanings: &'static [Cleaning],
}

fn main() -> Outcome<()> {
    let argument = |k: usize, otherwise: u64| {
        let given = std::env::args().nth(k);
        given.map_or(Ok(otherwise), |text| text.parse::<u64>())
    };
    let (first_seed, rooms) = (argument(1, 1)?, argument(2, 200)?);
    let only = std::env::args().nth(3);
    println!(
        "percent                                  |  scale known          |  scale unknown        | found of   |        | found of | sectors | closed rooms"
    );
    println!(
        "rooms   map      outliers  cleaning      |  P      R      best   |  P      R      best   | 20 1 m off | oracle | oracle's | agree   | silent"
    );
    for (kind, observed, cleanings) in [
        (Kind::Plain, false, &OF_BARE_MAPS[..]),
        (Kind::Curved, false, &OF_BARE_MAPS[4..]),
        (Kind::Counter, false, &OF_BARE_MAPS[4..]),
        (Kind::Tall, false, &OF_BARE_MAPS[4..]),
        (Kind::Plain, true, &OF_OBSERVED[..]),
        (Kind::Curved, true, &OF_OBSERVED[2..]),
        (Kind::Counter, true, &OF_OBSERVED[2..]),
        (Kind::Tall, true, &OF_OBSERVED[2..]),
    ] {
        let maps = if observed { "observed" } else { "bare" };
        if only.as_ref().is_some_and(|only| only != maps) {
            continue;
        }
        let tables = std::thread::scope(|scope| {
            let table = |outliers| {
                let task = Task {
                    kind,
                    outliers,
                    observed,
                    cleanings,
                };
                scope.spawn(move || task.table(first_seed, rooms))
            };
            [0.0, 0.1, 0.2]
                .map(table)
                .map(std::thread::ScopedJoinHandle::join)
        });
        for table in tables {
            print!("{}", table.map_err(|_| "a thread failed")??);
        }
    }
    Ok(())
}

impl Task {
    fn table(self, first_seed: u64, rooms: u64) -> Result<String, String> {
        let suite = |doors, first_seed| Suite {
            kind: self.kind,
            doors,
            dark: false,
            rooms,
            first_seed,
            outliers: self.outliers,
            clean: false,
            observed: self.observed,
        };
        let mut table = String::new();
        for cleaning in self.cleanings {
            let scans =
                |suite: Suite| cleaned(suite.scans(), *cleaning).map_err(|error| error.to_string());
            let open = scans(suite(1..=3, first_seed))?;
            let closed = scans(suite(0..=0, first_seed + 100_000))?;
            table += &self.line(cleaning, &open, &closed);
        }
        Ok(table)
    }

    fn line(self, cleaning: &Cleaning, open: &[Scan], closed: &[Scan]) -> String {
        let config = ExitConfig::default();
        let [known, unknown] = [true, false].map(|known| evaluate(open, known, &config));
        format!(
            "{:8} {:8} {:3.0} {:16} {} {} {:6.1} {:6.1} {:6.1} {:6.1} {:6.1}\n",
            format!("{:?}", self.kind),
            if self.observed { "observed" } else { "bare" },
            100.0 * self.outliers,
            cleaning.name,
            row(&known),
            row(&unknown),
            100.0 * known.recall_seen_through(),
            100.0 * known.oracle(),
            100.0 * known.recall_evident(),
            100.0 * known.agreement(),
            100.0 * evaluate(closed, true, &config).silence(),
        )
    }
}

fn row(score: &scoring::Score) -> String {
    let [p, r, b] = [score.precision(), score.recall(), score.best()].map(|x| 100.0 * x);
    format!("{p:6.1} {r:6.1} {b:6.1} ")
}

fn cleaned(mut scans: Vec<Scan>, cleaning: Cleaning) -> Outcome<Vec<Scan>> {
    let mut config = OutlierConfig::default();
    match cleaning.knowing {
        NotCleaned => return Ok(scans),
        Position(exponent) => {
            config.rays.one_position = Cues::one_position();
            config.rays.one_position.range_exponent = exponent;
        }
        Observations => {}
    }
    for scan in &mut scans {
        let views = match cleaning.knowing {
            Position(_) => Views::from_position(scan.agent, scan.points.len())?,
            _ => Views::new(scan.viewpoints(), scan.observers.clone())?,
        };
        let kept = remove_outliers(&scan.points, Some(&views), &config)?.kept;
        if cleaning.told {
            scan.keep_and_doubt(&kept);
        } else {
            scan.keep(&kept);
        }
    }
    Ok(scans)
}
