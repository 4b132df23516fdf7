//! A link that dies in the air, and one whose port is closed: `land` is attempted again and again, and the process ends.
//!
//! The flights run in processes of their own, this test's program started again with a task in its environment.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};
use tello_sdk::{Distance, Drone, DroneConfig, SessionConfig};

/// `how@drone@state port`.
const TASK: &str = "TELLO_DEAD_LINK_TASK";

/// Not a test by itself: what the child processes do.
#[test]
fn flight_of_the_child() {
    let Ok(task) = std::env::var(TASK) else {
        return;
    };
    let mut parts = task.split('@');
    let how = parts.next().unwrap();
    let address: SocketAddr = parts.next().unwrap().parse().unwrap();
    let port: u16 = parts.next().unwrap().parse().unwrap();
    let drone = Drone::connect(DroneConfig {
        state_bind: SocketAddr::from((Ipv4Addr::LOCALHOST, port)),
        command_bind: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
        landing_timeout: Duration::from_secs(5),
        session: SessionConfig {
            motion_timeout: Duration::from_secs(6),
            ..SessionConfig::default()
        },
        ..DroneConfig::at(address)
    })
    .unwrap();
    drone.take_off().unwrap();
    match how {
        "panic" => panic!("the mission fails while the link is dead"),
        "fly" => assert!(drone.forward(Distance::MIN).is_err()),
        _ => {}
    }
}

/// A drone that answers and tells its state until it has taken off.
fn dying_drone(address: Ipv4Addr, how: &str, closes: bool) -> (Vec<Duration>, bool) {
    let command = UdpSocket::bind((address, 0)).unwrap();
    let wait = Duration::from_millis(100);
    command.set_read_timeout(Some(wait)).unwrap();
    let state = UdpSocket::bind((address, 0)).unwrap();
    let listens = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let state_port = listens.local_addr().unwrap().port();
    drop(listens);
    let task = format!("{how}@{}@{state_port}", command.local_addr().unwrap());
    let mut child = Process::new(std::env::current_exe().unwrap())
        .args(["--exact", "flight_of_the_child"])
        .env(TASK, task)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let (mut command, mut alive, start) = (Some(command), true, Instant::now());
    let (mut lands, mut buffer) = (Vec::new(), [0; 200]);
    // Far more than the landing's timeout: a child that hangs fails the test instead of stopping it.
    while start.elapsed() < Duration::from_secs(60) {
        if let Some(status) = child.try_wait().unwrap() {
            return (lands, status.success());
        }
        if alive {
            let line = format!(
                "pitch:0;roll:0;yaw:0;h:0;bat:90;time:{};\r\n",
                start.elapsed().as_secs()
            );
            let _ = state.send_to(line.as_bytes(), (Ipv4Addr::LOCALHOST, state_port));
        }
        let Some(socket) = &command else {
            let _ = child.wait().unwrap();
            continue;
        };
        let Ok((length, from)) = socket.recv_from(&mut buffer) else {
            continue;
        };
        let text = String::from_utf8_lossy(&buffer[..length]).into_owned();
        if text == "land" {
            lands.push(start.elapsed());
        }
        if alive {
            let answer = if text.ends_with('?') { "90" } else { "ok" };
            socket.send_to(answer.as_bytes(), from).unwrap();
        }
        if text == "takeoff" {
            alive = false;
            if closes {
                command = None;
            }
        }
    }
    let _ = child.kill();
    let _ = child.wait();
    panic!("the process did not end: {lands:?}");
}

#[test]
fn on_a_dead_link_land_is_attempted_on_schedule_and_the_process_ends() {
    std::thread::scope(|scope| {
        for (last, how, ends_well) in [(51, "drop", true), (52, "panic", false), (53, "fly", true)]
        {
            scope.spawn(move || {
                let (lands, success) = dying_drone(Ipv4Addr::new(127, 0, 0, last), how, false);
                let gap = |two: &[Duration]| (two[1] - two[0]).as_millis();
                let gaps: Vec<u128> = lands.windows(2).map(gap).collect();
                println!(
                    "{how}: {} times `land`, after each other by {gaps:?} ms",
                    lands.len()
                );
                assert!(lands.len() >= 4, "{how}: {lands:?}");
                assert_eq!(success, ends_well, "{how}");
            });
        }
    });
}

#[test]
fn on_a_blocked_link_the_process_ends_too() {
    let (_, success) = dying_drone(Ipv4Addr::new(127, 0, 0, 54), "fly", true);
    assert!(success);
}
