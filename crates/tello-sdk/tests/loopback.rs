//! The blocking driver against emulated drones on loopback sockets.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tello_sdk::emulator::udp::{ServeConfig, serve, serve_with_cameras};
use tello_sdk::emulator::{EmulatorConfig, Timing, VideoSource};
use tello_sdk::*;

fn free_port(ip: Ipv4Addr) -> u16 {
    UdpSocket::bind((ip, 0))
        .unwrap()
        .local_addr()
        .unwrap()
        .port()
}

/// Serves a fast drone while `body` runs with a configuration for it.
fn with_drone(address: Ipv4Addr, body: impl FnOnce(DroneConfig) + std::panic::UnwindSafe) {
    let state_port = free_port(Ipv4Addr::LOCALHOST);
    let drone = EmulatorConfig {
        timing: Timing::fast(),
        state_port,
        ..EmulatorConfig::default()
    };
    let config = ServeConfig {
        address,
        command_port: free_port(address),
        drone,
        ..ServeConfig::default()
    };
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| serve(&config, &stop).unwrap());
        let client = DroneConfig {
            drone: SocketAddr::from((address, config.command_port)),
            command_bind: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
            state_bind: SocketAddr::from((Ipv4Addr::LOCALHOST, state_port)),
            ..DroneConfig::default()
        };
        let result = std::panic::catch_unwind(|| body(client));
        stop.store(true, Ordering::Relaxed);
        if let Err(panic) = result {
            std::panic::resume_unwind(panic);
        }
    });
}

#[test]
fn a_flight_over_sockets() {
    with_drone(Ipv4Addr::new(127, 0, 0, 21), |config| {
        let drone = Drone::connect(config).unwrap();
        drone.take_off().unwrap();
        drone.forward(Distance::from_cm(50).unwrap()).unwrap();
        drone.clockwise(Turn::from_degrees(90).unwrap()).unwrap();
        assert!(drone.battery().unwrap().percent() > 80);
        assert_eq!(drone.query(Query::Sdk).unwrap(), "20");
        let (telemetry, age) = drone.telemetry().unwrap();
        assert!(telemetry.attitude.is_some() && age < Duration::from_secs(1));
        drone.land().unwrap();
        assert!(!drone.may_be_flying().unwrap());
        assert_eq!(drone.counters().unwrap().stale, 0);
    });
}

#[test]
fn a_lander_ends_the_flight_from_another_thread() {
    with_drone(Ipv4Addr::new(127, 0, 0, 27), |config| {
        let drone = Drone::connect(config.clone()).unwrap();
        assert_eq!(drone.sdk_version().unwrap(), SdkVersion::V2_0);
        drone.take_off().unwrap();
        let lander = drone.lander();
        std::thread::scope(|scope| {
            scope.spawn(|| lander.land());
        });
        // Whatever is asked for from now on ends with an error.
        assert!((0..100).any(|_| drone.query(Query::Wifi).is_err()));
        drop(drone);
        let again = Drone::connect(config).unwrap();
        assert!(
            again.forward(Distance::MIN).is_err(),
            "it stands on the ground"
        );
    });
}

#[test]
fn without_pictures_there_is_no_take_off_that_needs_them() {
    with_drone(Ipv4Addr::new(127, 0, 0, 28), |config| {
        let drone = Drone::connect(config).unwrap();
        let bind = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let video = VideoConfig {
            bind,
            ..VideoConfig::default()
        };
        let stream = VideoStream::open(video).unwrap();
        let refused = drone.take_off_seeing(&stream).unwrap_err();
        assert_eq!(
            refused,
            DriveError::Preflight(vec![Finding::NoVideo { age_ms: None }])
        );
    });
}

#[cfg(target_os = "linux")]
#[test]
fn sockets_can_be_bound_to_an_interface() {
    with_drone(Ipv4Addr::new(127, 0, 0, 29), |config| {
        let on = |name: &str| DroneConfig {
            interface: Some(name.into()),
            ..config.clone()
        };
        let wrong = Drone::connect(on("nosuch0")).unwrap_err();
        assert!(matches!(wrong, ConnectError::Bind { .. }), "{wrong}");
        match Drone::connect(on("lo")) {
            Ok(drone) => assert!(drone.battery().is_ok()),
            Err(ConnectError::Bind { source, .. })
                if source.kind() == std::io::ErrorKind::PermissionDenied =>
            {
                println!("binding to an interface is not allowed here: not tested");
            }
            Err(other) => panic!("{other}"),
        }
    });
}

#[test]
fn dropping_the_connection_lands() {
    with_drone(Ipv4Addr::new(127, 0, 0, 22), |config| {
        let drone = Drone::connect(config.clone()).unwrap();
        drone.take_off().unwrap();
        drop(drone);
        let again = Drone::connect(config).unwrap();
        let refused = again.forward(Distance::MIN).unwrap_err();
        assert!(matches!(
            refused,
            DriveError::Refused {
                refusal: Refusal::MotorStop,
                ..
            }
        ));
    });
}

#[test]
fn a_panic_lands() {
    with_drone(Ipv4Addr::new(127, 0, 0, 23), |config| {
        let copy = config.clone();
        let flight = std::panic::catch_unwind(move || {
            let drone = Drone::connect(copy).unwrap();
            drone.take_off().unwrap();
            panic!("the mission failed");
        });
        assert!(flight.is_err());
        let again = Drone::connect(config).unwrap();
        assert!(
            again.forward(Distance::MIN).is_err(),
            "it stands on the ground"
        );
    });
}

#[test]
fn a_drone_that_is_not_there_is_an_error_in_time() {
    let mut config = DroneConfig::at(SocketAddr::from((
        [127, 0, 0, 24],
        free_port(Ipv4Addr::LOCALHOST),
    )));
    config.state_bind = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    config.session.setting_timeout = Duration::from_millis(100);
    let start = Instant::now();
    assert!(matches!(
        Drone::connect(config),
        Err(ConnectError::NoAnswer { .. })
    ));
    assert!(start.elapsed() < Duration::from_secs(10));
}

#[test]
fn a_port_in_use_is_named() {
    let taken = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let mut config = DroneConfig::at(SocketAddr::from(([127, 0, 0, 25], 9)));
    config.state_bind = taken.local_addr().unwrap();
    let error = Drone::connect(config).unwrap_err();
    assert!(
        matches!(error, ConnectError::Bind { address, .. } if address == taken.local_addr().unwrap())
    );
}

/// Units of the real sizes, each with its number, every thirtieth a key frame.
struct Numbers(u32, Arc<Mutex<Vec<Instant>>>);

impl VideoSource for Numbers {
    fn next_unit(&mut self, _now: Duration) -> Option<Vec<u8>> {
        let is_key = self.0.is_multiple_of(30);
        let mut unit = Vec::new();
        if is_key {
            unit.extend([0, 0, 0, 1, 0x67, 1, 2, 3, 0, 0, 0, 1, 0x68, 1, 2, 3]);
        }
        unit.extend([0, 0, 0, 1, if is_key { 0x65 } else { 0x61 }, 0x88]);
        unit.extend(self.0.to_be_bytes().map(|byte| byte | 0x80));
        unit.resize(if is_key { 35_000 } else { 10_000 }, 7);
        self.0 += 1;
        self.1.lock().unwrap().push(Instant::now());
        Some(unit)
    }
}

#[test]
fn video_comes_without_loss_and_fresh() {
    let address = Ipv4Addr::new(127, 0, 0, 26);
    let video = VideoConfig {
        bind: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
        ..VideoConfig::default()
    };
    let stream = VideoStream::open(VideoConfig {
        drone: Some(address.into()),
        ..video
    })
    .unwrap();
    let state_port = free_port(Ipv4Addr::LOCALHOST);
    let video_port = stream.local_address().port();
    let drone = EmulatorConfig {
        timing: Timing::fast(),
        state_port,
        video_port,
        ..EmulatorConfig::default()
    };
    let config = ServeConfig {
        address,
        command_port: free_port(address),
        drone,
        ..ServeConfig::default()
    };
    let stop = AtomicBool::new(false);
    let created = Arc::new(Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        scope.spawn(|| {
            serve_with_cameras(
                &config,
                &|_| Some(Box::new(Numbers(0, Arc::clone(&created)))),
                &stop,
            )
            .unwrap();
        });
        let client = DroneConfig {
            drone: SocketAddr::from((address, config.command_port)),
            command_bind: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
            state_bind: SocketAddr::from((Ipv4Addr::LOCALHOST, state_port)),
            ..DroneConfig::default()
        };
        let drone = Drone::connect(client).unwrap();
        drone.execute(Command::StreamOn).unwrap();
        let mut ages = Vec::new();
        let mut take = || {
            let unit = stream.next(Duration::from_secs(2))?;
            ages.push(created.lock().unwrap()[ages.len()].elapsed());
            Some(unit)
        };
        let units: Vec<_> = (0..45).map_while(|_| take()).collect();
        ages.sort();
        println!(
            "age of a unit when taken: median {:?}, p95 {:?}",
            ages[22], ages[42]
        );
        let newest = stream.newest(Duration::from_secs(2));
        stop.store(true, Ordering::Relaxed);
        assert_eq!(units.len(), 45);
        assert!(units[0].is_key && units.iter().all(|unit| unit.is_decodable));
        assert_eq!(units.iter().filter(|unit| unit.is_key).count(), 2);
        assert!(newest.is_some_and(|unit| unit.at >= units[44].at));
        assert_eq!(stream.counters().1, 0);
    });
}

/// Up, a bit forward, down; the state comes from the hub.
fn hop(hub: &StateHub, address: SocketAddr) -> bool {
    let command_bind = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    let config = DroneConfig {
        command_bind,
        ..DroneConfig::at(address)
    };
    let drone = Drone::connect_through(hub, config).unwrap();
    drone.take_off().unwrap();
    drone.forward(Distance::MIN).unwrap();
    drone.land().is_ok()
}

#[test]
fn three_drones_are_found_and_fly_over_one_state_port() {
    let address = Ipv4Addr::new(127, 0, 0, 31);
    let state_port = free_port(Ipv4Addr::LOCALHOST);
    let drone = EmulatorConfig {
        timing: Timing::fast(),
        state_port,
        ..EmulatorConfig::default()
    };
    let command_port = free_port(address);
    let config = ServeConfig {
        address,
        command_port,
        count: 3,
        drone,
        ..ServeConfig::default()
    };
    let local = |port| SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| serve(&config, &stop).unwrap());
        let candidates: Vec<SocketAddr> = (29..36)
            .map(|last| SocketAddr::from(([127, 0, 0, last], command_port)))
            .collect();
        let found = discover(local(0), &candidates, Duration::from_secs(1)).unwrap();
        let hub = StateHub::bind(local(state_port)).unwrap();
        let flown: Vec<bool> = std::thread::scope(|flights| {
            let threads: Vec<_> = found
                .iter()
                .map(|found| flights.spawn(|| hop(&hub, found.address)))
                .collect();
            threads
                .into_iter()
                .map(|thread| thread.join().unwrap())
                .collect()
        });
        stop.store(true, Ordering::Relaxed);
        assert_eq!(flown, [true; 3]);
        let serials: Vec<_> = found
            .into_iter()
            .map(|found| found.serial_number.unwrap())
            .collect();
        assert_eq!(
            serials,
            ["0TQEMULATED0010", "0TQEMULATED0011", "0TQEMULATED0012"]
        );
    });
}
