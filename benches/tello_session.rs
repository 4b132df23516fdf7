//! Overhead of the Tello session: one command with its reply, one state line, one stick set-point.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a benchmark says where it fails"
)]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;
use tello_sdk::{Command, Input, Origin, Output, Query, Session, SessionConfig};

const STATE: &[u8] = b"mid:-2;x:-200;y:-200;z:-200;mpry:0,0,0;pitch:0;roll:0;yaw:0;vgx:0;vgy:0;vgz:0;templ:60;temph:62;tof:80;h:70;bat:87;baro:93.25;time:12;agx:-9.00;agy:2.00;agz:-998.00;\r\n";

fn drain(session: &mut Session) {
    while !matches!(black_box(session.poll_output()), Output::WaitUntil(_)) {}
}

fn tello_session(criterion: &mut Criterion) {
    let origin = Origin::Drone;
    let mut group = criterion.benchmark_group("tello_session");
    let mut session = Session::new(SessionConfig::default()).expect("the defaults are valid");
    let mut now = Duration::ZERO;
    group.bench_function("command_and_reply", |bencher| {
        bencher.iter(|| {
            // A second apart, so that nothing has to wait for copies of the last reply.
            now += Duration::from_secs(1);
            session
                .request(now, Command::Query(Query::Battery))
                .expect("the queue is empty");
            drain(&mut session);
            session.handle_input(Input::Reply {
                at: now,
                origin,
                bytes: b"87\r\n",
            });
            drain(&mut session);
        });
    });
    group.bench_function("state_line", |bencher| {
        bencher.iter(|| {
            now += Duration::from_millis(100);
            session.handle_input(Input::State {
                at: now,
                origin,
                bytes: STATE,
            });
            drain(&mut session);
        });
    });
    group.finish();
}

criterion_group!(benches, tello_session);
criterion_main!(benches);
