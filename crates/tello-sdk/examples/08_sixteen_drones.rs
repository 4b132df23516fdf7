//! Sixteen drones with video over one state port and one video port: does anything get lost, and what does it cost?
//!
//! Input: an optional number of seconds (default 20). The drones run in a process of their own. Output: for each drone
//! the pictures sent and received, then the CPU time of this side. Exit code 1 if a picture was lost.
//! `taskset -c 0 ...` keeps everything on one core.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command as Process, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tello_sdk::emulator::EmulatorConfig;
use tello_sdk::emulator::udp::{DroneServer, ServeConfig};
use tello_sdk::video::TestCard;
use tello_sdk::{Command, Drone, DroneConfig, StateHub, VideoConfig, VideoHub, VideoStream};

const DRONES: u8 = 16;
const STATE_PORT: u16 = 28_890;
const VIDEO_PORT: u16 = 21_111;

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    if argument.as_deref() == Some("serve") {
        return serve();
    }
    let seconds = argument.map_or(Ok(20), |text| text.parse())?;
    let mut drones = Process::new(std::env::current_exe()?)
        .arg("serve")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()?;
    let counted = receive(&mut drones, seconds);
    let _ = drones.kill();
    counted
}

fn config() -> ServeConfig {
    ServeConfig {
        address: [127, 0, 0, 100].into(),
        count: DRONES,
        drone: EmulatorConfig {
            state_port: STATE_PORT,
            video_port: VIDEO_PORT,
            ..EmulatorConfig::default()
        },
        ..ServeConfig::default()
    }
}

/// The drones' process: until a line comes, then says how many pictures each has sent.
fn serve() -> Result<(), Box<dyn Error>> {
    let (server, stop) = (DroneServer::bind(&config())?, AtomicBool::new(false));
    println!("ready");
    let summaries = std::thread::scope(|scope| {
        let drones = scope.spawn(|| server.run(&|_| Some(Box::new(TestCard::new())), &stop));
        let read = std::io::stdin().read_line(&mut String::new());
        stop.store(true, Ordering::Relaxed);
        read.map(|_| drones.join())
    })?;
    for summary in summaries.map_err(|_| "a drone panicked")? {
        println!("{}", summary.pictures);
    }
    Ok(())
}

fn receive(drones: &mut Child, seconds: u64) -> Result<(), Box<dyn Error>> {
    let mut words = BufReader::new(drones.stdout.take().ok_or("no pipe")?).lines();
    words.next().ok_or("the drones did not start")??;
    let states = StateHub::bind(([127, 0, 0, 1], STATE_PORT).into())?;
    let videos = VideoHub::bind(([127, 0, 0, 1], VIDEO_PORT).into())?;
    let mut flights = Vec::new();
    for index in 0..DRONES {
        let address = config().address_of(index)?;
        let video = VideoStream::open_through(&videos, address.ip(), VideoConfig::default())?;
        let drone = Drone::connect_through(&states, DroneConfig::at(address))?;
        drone.execute(Command::StreamOn)?;
        flights.push((drone, video, 0_u64));
    }
    let (start, cpu) = (Instant::now(), cpu_seconds());
    while start.elapsed() < Duration::from_secs(seconds) {
        count(&mut flights);
    }
    let used = cpu_seconds() - cpu;
    let elapsed = start.elapsed().as_secs_f64();
    for (drone, ..) in &flights {
        drone.execute(Command::StreamOff)?;
    }
    // What is still on its way.
    let end = Instant::now() + Duration::from_millis(500);
    while Instant::now() < end {
        count(&mut flights);
    }
    writeln!(drones.stdin.as_mut().ok_or("no pipe")?)?;
    let mut lost = 0;
    for (index, ((_, video, received), sent)) in flights.iter().zip(words).enumerate() {
        let sent: u64 = sent?.parse()?;
        let (counters, overrun) = video.counters();
        println!(
            "drone {index}: {sent} sent, {received} received, {} damaged, {overrun} not taken",
            counters.damaged
        );
        lost += sent.abs_diff(*received) + counters.orphans;
    }
    println!(
        "{lost} lost; this side used {:.1} % of a core",
        used / elapsed * 100.0
    );
    if lost > 0 {
        Err("pictures were lost".into())
    } else {
        Ok(())
    }
}

fn count(flights: &mut [(Drone, VideoStream, u64)]) {
    for (_, video, received) in flights {
        while video.next(Duration::from_millis(1)).is_some() {
            *received += 1;
        }
    }
}

/// User and system time of this process, from `/proc` (100 ticks a second); zero elsewhere.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace();
    let ticks: f64 = fields
        .skip(11)
        .take(2)
        .filter_map(|field| field.parse::<f64>().ok())
        .sum();
    ticks / 100.0
}
