//! Exits of real room scans next to the openings labelled by eye: as they are, with a random half to four fifths of
//! their points, and from other places in the room. Reads the folder named by EXPLORER_DATA, or the shared
//! data folder beside the project.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/contrast/mod.rs"]
mod contrast;
#[path = "../tests/real/mod.rs"]
mod real;

use exit_finder::{AffinePlane, ExitConfig, ExitReport, ExitView, PlaneError, find_exits};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const UP: [f64; 3] = [0.0, -1.0, 0.0];
const ROUNDS: usize = 100;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rules = [
        ("range-aware", Some(ExitConfig::default())),
        ("paper", Some(ExitConfig::paper())),
        ("paper repaired", Some(ExitConfig::paper_repaired())),
        ("contrast alone", None),
    ];
    for (name, rule) in rules {
        println!(
            "{name}: exits as scanned | right, none of {ROUNDS} with fewer points | from other places"
        );
        for room in real::ROOMS {
            let Some(points) = real::load(room.name) else {
                continue;
            };
            let rounds = vary(&room, &points, rule.as_ref())?;
            println!(
                "  {:10} truth {:?} -> {} | {:3} {:3} | {:3} {:3}",
                room.name,
                room.opening,
                describe(&points, rule.as_ref())?,
                rounds[0].right,
                rounds[0].none,
                rounds[1].right,
                rounds[1].none,
            );
        }
    }
    Ok(())
}

#[derive(Debug, Default, Clone, Copy)]
struct Rounds {
    right: usize,
    none: usize,
}

/// The scan thinned, and from places within 0.3 median ranges.
fn vary(
    room: &real::Room,
    points: &[[f64; 3]],
    rule: Option<&ExitConfig>,
) -> Result<[Rounds; 2], PlaneError> {
    let mut rng = Pcg64::seed_from_u64(3);
    let mut ranges: Vec<f64> = points.iter().map(|p| p[0].hypot(p[2])).collect();
    ranges.sort_by(f64::total_cmp);
    let median = ranges[ranges.len() / 2];
    let mut rounds = [Rounds::default(); 2];
    for _ in 0..ROUNDS {
        let share = rng.random_range(0.5..0.8);
        let kept = points.iter().filter(|_| rng.random_bool(share));
        let thinned: Vec<[f64; 3]> = kept.copied().collect();
        let turn: f64 = rng.random_range(0.0..std::f64::consts::TAU);
        let away = 0.3 * median * rng.random::<f64>().sqrt();
        let place = [away * turn.cos(), 0.0, away * turn.sin()];
        for (round, agent, points) in [(0, [0.0; 3], &thinned[..]), (1, place, points)] {
            match (best(points, agent, rule)?, room.opening) {
                (None, _) => rounds[round].none += 1,
                (Some(bearing), Some(opening)) => {
                    let seen = real::seen_from(opening, 1.3 * median, agent);
                    rounds[round].right += usize::from(real::outside(bearing, seen) <= 3.0);
                }
                (Some(_), None) => {}
            }
        }
    }
    Ok(rounds)
}

fn search(
    points: &[[f64; 3]],
    agent: [f64; 3],
    config: &ExitConfig,
) -> Result<Option<ExitReport>, PlaneError> {
    let plane = AffinePlane::from_up(UP, agent)?;
    Ok(find_exits(points, agent, &plane, &ExitView::default(), config).ok())
}

/// Bearing of the best exit; without a config by contrast alone.
fn best(
    points: &[[f64; 3]],
    agent: [f64; 3],
    rule: Option<&ExitConfig>,
) -> Result<Option<f64>, PlaneError> {
    let Some(config) = rule else {
        let plane = AffinePlane::from_up(UP, agent)?;
        return Ok(contrast::exit(points, agent, &plane).map(|exit| exit.bearing_rad));
    };
    let report = search(points, agent, config)?;
    Ok(report.and_then(|report| report.best().map(|exit| exit.bearing_rad)))
}

fn describe(points: &[[f64; 3]], rule: Option<&ExitConfig>) -> Result<String, PlaneError> {
    let degrees = |rad: f64| (rad.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    let Some(config) = rule else {
        let plane = AffinePlane::from_up(UP, [0.0; 3])?;
        let found = contrast::exit(points, [0.0; 3], &plane);
        return Ok(found.map_or_else(String::new, |exit| {
            format!("{:.0} ratio {:.2}", degrees(exit.bearing_rad), exit.ratio)
        }));
    };
    let Some(report) = search(points, [0.0; 3], config)? else {
        return Ok("too few points".to_owned());
    };
    let exits = report.exits.iter().take(4).map(|e| {
        let (at, half) = (degrees(e.bearing_rad), e.width_rad.to_degrees() / 2.0);
        format!("{at:.0}±{half:.0} {:?} {:.2}", e.kind, e.score)
    });
    let unseen: f64 = report.unseen.iter().map(|sector| sector.width_rad).sum();
    Ok(format!(
        "{} (unseen {:.0}°)",
        exits.collect::<Vec<_>>().join(", "),
        unseen.to_degrees()
    ))
}
