//! Cost of one simulated picture, beside the naive search that tests every landmark against every solid.
//!
//! The drone hovers in its first room after a take-off; the larger the world, the more the culling has to save.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

use core::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use indoor_sim::{Landmark, SimConfig, Simulator, World};
use tello_sdk::Command;

fn hovering(name: &str) -> Simulator {
    let world = World::named(name, 1).expect("a preset");
    let mut sim = Simulator::new(world, SimConfig::default(), 1).expect("default numbers");
    sim.send(&Command::TakeOff).expect("a full battery");
    sim.advance(Duration::from_secs(5));
    sim
}

/// Whether a camera sees a landmark, with a test against every solid of the world.
fn naive(world: &World, eye: [f64; 3], axis: [f64; 3], landmark: &Landmark) -> bool {
    let ray: [f64; 3] = core::array::from_fn(|a| landmark.position[a] - eye[a]);
    let dot = |b: [f64; 3]| (0..3).map(|a| ray[a] * b[a]).sum::<f64>();
    let range = dot(ray).sqrt();
    let facing = -dot(landmark.normal) >= landmark.least_cosine * range;
    let ahead = dot(axis) > 0.82 * range;
    let place = core::array::from_fn(|a| landmark.position[a] + 0.002 * landmark.normal[a]);
    let resolved = range >= landmark.near && range <= landmark.far;
    facing
        && ahead
        && resolved
        && world
            .solids()
            .iter()
            .all(|solid| solid.enter(eye, place).is_none())
}

fn picture(c: &mut Criterion) {
    let mut group = c.benchmark_group("sim_frame");
    for name in ["closed-room", "two-rooms", "apartment"] {
        let sim = hovering(name);
        let landmarks = sim.world().landmarks().len();
        group.throughput(Throughput::Elements(landmarks as u64));
        group.bench_with_input(
            BenchmarkId::new("picture and 0.1 s of flight", name),
            &sim,
            |b, sim| {
                b.iter_batched(
                    || sim.clone(),
                    |mut sim| {
                        sim.advance(Duration::from_millis(100));
                        sim
                    },
                    criterion::BatchSize::LargeInput,
                );
            },
        );
        group.bench_with_input(
            BenchmarkId::new("naive visibility", name),
            &sim,
            |b, sim| {
                let pose = sim.camera_pose();
                let eye = pose.translation.vector.into();
                let axis = (pose.rotation * indoor_sim::slam_bridge::nalgebra::Vector3::z()).into();
                let world = sim.world();
                b.iter(|| {
                    world
                        .landmarks()
                        .iter()
                        .filter(|mark| naive(world, eye, axis, mark))
                        .count()
                });
            },
        );
    }
    group.finish();
}

criterion_group!(benches, picture);
criterion_main!(benches);
