//! Precision and recall on 200 generated rooms each. Run with `--release`; takes about a minute.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/generator/mod.rs"]
mod generator;
#[path = "../tests/scoring/mod.rs"]
mod scoring;

use exit_finder::ExitConfig;
use generator::Kind;
use scoring::{Suite, evaluate};

fn main() {
    let rules = [
        ("range-aware", ExitConfig::default(), true),
        ("range-aware, scale unknown", ExitConfig::default(), false),
        ("paper, repaired", ExitConfig::paper_repaired(), true),
        ("paper", ExitConfig::paper(), true),
    ];
    for (clean, outliers) in [(true, 0.0), (true, 0.1), (true, 0.2), (false, 0.1)] {
        let open = Suite {
            kind: Kind::Plain,
            doors: 1..=3,
            dark: false,
            rooms: 200,
            first_seed: 1,
            outliers,
            clean,
            observed: false,
        };
        let [closed, dark] = [
            Suite {
                doors: 0..=0,
                first_seed: 100_001,
                ..open.clone()
            },
            Suite {
                dark: true,
                first_seed: 200_001,
                ..open.clone()
            },
        ];
        let [open, closed, dark] = [open, closed, dark].map(|suite| suite.scans());
        println!("outliers {:.0} %, cleaned: {clean}", 100.0 * outliers);
        for (name, config, known_scale) in &rules {
            let score = |scans| evaluate(scans, *known_scale, config);
            println!(
                "  {name:27} {}  closed rooms silent {:5.1}  dark doors: precision {:5.1} recall {:5.1}",
                score(&open),
                100.0 * score(&closed).silence(),
                100.0 * score(&dark).precision(),
                100.0 * score(&dark).recall(),
            );
        }
    }
}
