//! `explorer emulate`: Tellos on UDP for clients of any kind, until interrupted.

use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

use tello_sdk::emulator::udp::{DroneServer, ServeConfig, ServeError};
use tello_sdk::emulator::{EmulatorConfig, Faults, FloorPad, Summary, VideoSource};
use tello_sdk::video::TestCard;
use tello_sdk::{PadNumber, SdkVersion};

use crate::args::{Emulate, Output};
use crate::failure::Failure;

pub(crate) fn run(arguments: &Emulate, output: &Output) -> Result<(), Failure> {
    let config = configuration(arguments, output.seed)?;
    let stop = Arc::new(AtomicBool::new(false));
    let signal = Arc::clone(&stop);
    ctrlc::set_handler(move || signal.store(true, Ordering::Relaxed)).map_err(Failure::internal)?;
    let server = DroneServer::bind(&config).map_err(unserved)?;
    announce(&config, arguments)?;
    let drones = server.run(&|_| Some(camera()), &stop);
    for (index, drone) in (0_u8..).zip(&drones) {
        report(&config, index, drone)?;
    }
    Ok(())
}

fn configuration(arguments: &Emulate, seed: u64) -> Result<ServeConfig, Failure> {
    let faults = Faults::preset(&arguments.faults, seed)
        .ok_or_else(|| Failure::internal("a preset without faults"))?;
    let drone = EmulatorConfig {
        version: version(&arguments.sdk),
        state_port: arguments.state_port,
        video_port: arguments.video_port,
        pads: pads(),
        faults,
        seed,
        ..EmulatorConfig::default()
    };
    Ok(ServeConfig {
        address: arguments.address,
        command_port: arguments.command_port,
        count: arguments.count,
        binary: arguments.sdk == "binary",
        drone,
    })
}

/// Mission pads 1 to 4, from the place of power-on a metre apart straight ahead.
fn pads() -> Vec<FloorPad> {
    let lie = |number: u8| {
        Some(FloorPad {
            number: PadNumber::from_number(i64::from(number)).ok()?,
            position: [f64::from(number) - 1.0, 0.0],
            yaw_deg: 0.0,
        })
    };
    (1..=4).filter_map(lie).collect()
}

fn version(sdk: &str) -> SdkVersion {
    match sdk {
        "1.3" => SdkVersion::V1_3,
        "3.0" => SdkVersion::V3_0,
        "rmtt" => SdkVersion::Rmtt,
        _ => SdkVersion::V2_0,
    }
}

fn announce(config: &ServeConfig, arguments: &Emulate) -> Result<(), Failure> {
    let first = config.address_of(0).map_err(unserved)?;
    let last = config.address_of(config.count - 1).map_err(unserved)?;
    let which = match config.count {
        1 => format!("a Tello on {first}"),
        count => format!("{count} Tellos on {first} to {}", last.ip()),
    };
    let Emulate { sdk, faults, .. } = arguments;
    say(&format!(
        "{which}, SDK {sdk}, faults {faults}; Ctrl-C ends it"
    ));
    Ok(())
}

/// A test card that shows the time of day, so that a client on this machine can tell how old a picture is.
fn camera() -> Box<dyn VideoSource> {
    #[expect(
        clippy::disallowed_methods,
        reason = "the test card shows the time of day"
    )]
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    Box::new(TestCard::with_clock(now.unwrap_or(Duration::ZERO)))
}

fn report(config: &ServeConfig, index: u8, drone: &Summary) -> Result<(), Failure> {
    let address = config.address_of(index).map_err(unserved)?;
    let where_it_is = if drone.flying {
        "in the air"
    } else {
        "on the ground"
    };
    let Summary {
        commands,
        pictures,
        battery,
        ..
    } = drone;
    say(&format!(
        "{address}: {commands} commands, {pictures} pictures, battery {battery:.0} %, {where_it_is}"
    ));
    Ok(())
}

fn unserved(error: ServeError) -> Failure {
    Failure::new(
        error,
        "choose other addresses or ports with --address and --command-port",
    )
}

fn say(line: &str) {
    // Nobody has to read it.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
