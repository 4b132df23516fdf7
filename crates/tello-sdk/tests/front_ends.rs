//! The blocking and the asynchronous front end fly the same scenario and say the same to the drone; the binary driver.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tello_sdk::emulator::udp::{DroneServer, ServeConfig};
use tello_sdk::emulator::{EmulatorConfig, Summary, Timing};
use tello_sdk::*;

fn free_port(ip: Ipv4Addr) -> u16 {
    let socket = UdpSocket::bind((ip, 0)).unwrap();
    socket.local_addr().unwrap().port()
}

fn local(port: u16) -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, port))
}

/// Serves a fast drone while `body` runs with its address.
fn serve(last: u8, binary: bool, state_port: u16, body: impl FnOnce(SocketAddr)) -> Summary {
    let address = Ipv4Addr::new(127, 0, 0, last);
    let config = ServeConfig {
        address,
        command_port: free_port(address),
        binary,
        drone: EmulatorConfig {
            timing: Timing::fast(),
            state_port,
            ..EmulatorConfig::default()
        },
        ..ServeConfig::default()
    };
    let (server, stop) = (DroneServer::bind(&config).unwrap(), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let drone = scope.spawn(|| server.run(&|_| Some(Box::new(video::TestCard::new())), &stop));
        let body = std::panic::AssertUnwindSafe(|| body(config.address_of(0).unwrap()));
        let result = std::panic::catch_unwind(body);
        stop.store(true, Ordering::Relaxed);
        if let Err(panic) = result {
            std::panic::resume_unwind(panic);
        }
        drone.join().unwrap()[0]
    })
}

/// What a recording says was sent, without keep-alives (a question for the battery that nobody asked).
#[cfg(feature = "tokio")]
fn transcript(path: &std::path::Path) -> Vec<String> {
    let bytes = std::fs::read(path).unwrap();
    let sent = record::Records::new(&bytes)
        .filter(|record| record.channel == record::Channel::Sent)
        .map(|record| String::from_utf8(record.bytes.to_vec()).unwrap());
    let mut sent: Vec<String> = sent.filter(|text| text != "battery?").collect();
    // `land` is repeated until the telemetry shows a standstill: how often is a matter of time.
    sent.dedup();
    sent
}

#[cfg(feature = "tokio")]
#[test]
fn the_same_scenario_gives_the_same_transcript() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let config = |drone, port, name: &str| DroneConfig {
        state_bind: local(port),
        command_bind: local(0),
        record: Some(folder.join(name)),
        ..DroneConfig::at(drone)
    };
    let cm = |cm| Distance::from_cm(cm).unwrap();
    let port = free_port(Ipv4Addr::LOCALHOST);
    serve(61, false, port, |address| {
        let drone = Drone::connect(config(address, port, "blocking.tello")).unwrap();
        drone.take_off().unwrap();
        drone.forward(cm(50)).unwrap();
        drone.clockwise(Turn::from_degrees(90).unwrap()).unwrap();
        assert_eq!(drone.query(Query::Sdk).unwrap(), "20");
        assert!(drone.execute(Command::Up(cm(40))).is_ok());
        drop(drone);
    });
    let port = free_port(Ipv4Addr::LOCALHOST);
    serve(62, false, port, |address| {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        runtime.block_on(async {
            let config = config(address, port, "asynchronous.tello");
            let mut drone = AsyncDrone::connect(config).await.unwrap();
            drone.take_off().await.unwrap();
            drone.forward(cm(50)).await.unwrap();
            drone
                .clockwise(Turn::from_degrees(90).unwrap())
                .await
                .unwrap();
            assert_eq!(drone.query(Query::Sdk).await.unwrap(), "20");
            assert!(drone.execute(Command::Up(cm(40))).await.is_ok());
            assert!(drone.next_event().await.is_some());
            assert!(drone.may_be_flying().await.unwrap());
            drone.close().await;
        });
    });
    let blocking = transcript(&folder.join("blocking.tello"));
    assert_eq!(blocking, transcript(&folder.join("asynchronous.tello")));
    assert_eq!(
        blocking,
        [
            "command",
            "takeoff",
            "forward 50",
            "cw 90",
            "sdk?",
            "up 40",
            "land"
        ]
    );
}

#[cfg(feature = "tokio")]
#[test]
fn an_asynchronous_drone_that_is_not_there_is_an_error() {
    let address = SocketAddr::from(([127, 0, 0, 63], free_port(Ipv4Addr::LOCALHOST)));
    let mut config = DroneConfig::at(address);
    config.state_bind = local(0);
    config.session.setting_timeout = Duration::from_millis(100);
    let runtime = tokio::runtime::Builder::new_current_thread()
        .build()
        .unwrap();
    let result = runtime.block_on(AsyncDrone::connect(config));
    assert!(matches!(result, Err(ConnectError::NoAnswer { .. })));
}

#[test]
fn the_binary_driver_flies_sees_and_lands_by_being_dropped() {
    let stream = VideoStream::open(VideoConfig {
        bind: local(0),
        assembler: video::AssemblerConfig {
            framing: video::Framing::Binary,
            ..video::AssemblerConfig::default()
        },
        ..VideoConfig::default()
    })
    .unwrap();
    let summary = serve(64, true, 0, |address| {
        let mut config = BinaryDroneConfig {
            bind: local(0),
            ..BinaryDroneConfig::at(address)
        };
        config.session.video_port = stream.local_address().port();
        let drone = BinaryDrone::connect(config).unwrap();
        drone.take_off().unwrap();
        drone.set_video(true);
        let first = stream.next(Duration::from_secs(5)).unwrap();
        assert!(first.is_key && first.is_decodable);
        assert_eq!(first.integrity, video::Integrity::Intact);
        // Sticks count when the take-off is over; the watchdog is served by every event with telemetry.
        let turned = (0..400).any(|_| {
            let yaw = Stick::MAX;
            drone.set_sticks(Sticks {
                yaw,
                ..Sticks::CENTER
            });
            let _ = drone.next_event(Duration::from_millis(100));
            let (telemetry, _) = drone.telemetry().unwrap();
            telemetry.attitude.is_some_and(|a| a.value.yaw_deg > 30.0)
        });
        assert!(turned);
        let (telemetry, age) = drone.telemetry().unwrap();
        assert!(age < Duration::from_secs(1), "{age:?}");
        assert!(telemetry.velocity.is_some() && telemetry.quaternion.is_some());
        assert!(drone.may_be_flying().unwrap());
        drop(drone);
    });
    assert!(!summary.flying);
    assert_eq!(stream.counters().0.damaged, 0);
}

#[test]
fn a_binary_drone_that_is_not_there_is_an_error() {
    let address = SocketAddr::from(([127, 0, 0, 65], free_port(Ipv4Addr::LOCALHOST)));
    let config = BinaryDroneConfig {
        connect_timeout: Duration::from_millis(300),
        ..BinaryDroneConfig::at(address)
    };
    let result = BinaryDrone::connect(config);
    assert!(matches!(result, Err(ConnectError::NoAnswer { .. })));
}
