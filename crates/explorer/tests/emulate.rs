//! `explorer emulate` as a client meets it: a drone on UDP whose datagrams all come from its own address.

#![cfg(unix)]
#![allow(
    clippy::expect_used,
    clippy::disallowed_methods,
    reason = "a client on a socket, whose failure should say where"
)]

use std::io::{BufRead as _, BufReader, ErrorKind, Read as _};
use std::net::{SocketAddr, UdpSocket};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;

/// A running drone, ended with the test.
struct Drone(Child, BufReader<ChildStderr>);

impl Drone {
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_explorer"))
            .arg("emulate")
            .args(arguments)
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut lines = BufReader::new(child.stderr.take().expect("a pipe"));
        let mut line = String::new();
        lines.read_line(&mut line).expect("a line when it listens");
        assert!(line.contains("Ctrl-C ends it"), "{line}");
        Self(child, lines)
    }

    /// What Ctrl-C sends; gives the rest of its words.
    fn interrupt(mut self) -> String {
        let id = self.0.id().to_string();
        let sent = Command::new("kill").args(["-INT", &id]).status();
        assert!(sent.is_ok_and(|status| status.success()));
        let status = self.0.wait().expect("it ends");
        assert!(status.success(), "{status}");
        let mut text = String::new();
        self.1.read_to_string(&mut text).expect("text");
        text
    }
}

impl Drop for Drone {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

fn socket() -> UdpSocket {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a free port");
    let limit = Some(Duration::from_secs(20));
    socket.set_read_timeout(limit).expect("a timeout");
    socket
}

fn port(socket: &UdpSocket) -> String {
    socket.local_addr().expect("bound").port().to_string()
}

/// The next datagram, which must come from this address.
fn hear(socket: &UdpSocket, from: &str) -> Vec<u8> {
    let mut buffer = [0; 2048];
    let (length, sender) = loop {
        match socket.recv_from(&mut buffer) {
            // A signal, such as the end of another test's process, is no answer.
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            heard => break heard.expect("a datagram"),
        }
    };
    assert_eq!(sender.ip().to_string(), from);
    buffer[..length].to_vec()
}

#[test]
fn it_answers_tells_its_state_and_sends_video_from_its_own_address() {
    let (command, state, video) = (socket(), socket(), socket());
    let free = port(&socket());
    let drone = Drone::start(&[
        "--address",
        "127.0.0.41",
        "--command-port",
        &free,
        "--state-port",
        &port(&state),
        "--video-port",
        &port(&video),
        "--count",
        "2",
        "--sdk",
        "3.0",
    ]);
    let ask = |address: &str, text: &str| {
        let to: SocketAddr = format!("{address}:{free}").parse().expect("an address");
        command.send_to(text.as_bytes(), to).expect("sent");
        String::from_utf8(hear(&command, address)).expect("text")
    };
    assert_eq!(ask("127.0.0.42", "command"), "ok");
    assert_eq!(ask("127.0.0.42", "sdk?").trim(), "30");
    let line = String::from_utf8(hear(&state, "127.0.0.42")).expect("text");
    assert!(
        line.starts_with("mid:") && line.contains("bat:87;"),
        "{line}"
    );
    assert_eq!(ask("127.0.0.42", "streamon"), "ok");
    assert_eq!(hear(&video, "127.0.0.42")[..5], [0, 0, 0, 1, 0x67]);
    assert_eq!(ask("127.0.0.41", "command"), "ok");
    let words = drone.interrupt();
    assert!(
        words.contains("127.0.0.41:") && words.contains("127.0.0.42:"),
        "{words}"
    );
    assert!(words.contains("3 commands"), "{words}");
}

#[test]
fn the_binary_protocol_and_a_fault() {
    let command = socket();
    let free = port(&socket());
    let drone = Drone::start(&[
        "--address",
        "127.0.0.43",
        "--command-port",
        &free,
        "--sdk",
        "binary",
        "--faults",
        "low-battery",
    ]);
    let to: SocketAddr = format!("127.0.0.43:{free}").parse().expect("an address");
    command.send_to(b"conn_req:\x96\x17", to).expect("sent");
    assert_eq!(hear(&command, "127.0.0.43"), b"conn_ack:\x96\x17");
    assert_eq!(hear(&command, "127.0.0.43")[0], 0xCC);
    drop(drone);
}

#[test]
fn what_cannot_be_is_said_in_one_line() {
    let taken = UdpSocket::bind("127.0.0.44:0").expect("a free port");
    let explorer = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_explorer"))
            .arg("emulate")
            .args(arguments)
            .output()
            .expect("the command runs")
    };
    let output = explorer(&["--address", "127.0.0.44", "--command-port", &port(&taken)]);
    let line = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        line.trim_end().lines().count() == 1 && line.contains("127.0.0.44"),
        "{line}"
    );
    let wrong = explorer(&["--faults", "bad-luck"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("wifi-gap"));
}
