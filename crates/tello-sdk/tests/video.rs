//! Ten thousand random access units, many an exact multiple of the datagram size, with and without loss.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeSet;
use std::time::Duration;
use tello_sdk::video::{Assembler, AssemblerConfig, Framing, Integrity, PAYLOAD, datagrams};

const UNITS: u64 = 10_000;

/// A unit whose bytes hold no start code of their own; every thirtieth is a key frame with parameter sets.
fn unit(rng: &mut Pcg64, index: u64) -> Vec<u8> {
    let is_key = index.is_multiple_of(30);
    let mut data = Vec::new();
    if is_key {
        data.extend([0, 0, 0, 1, 0x67, 0x64, 0x0A, 0x1F]);
        data.extend([0, 0, 0, 1, 0x68, 0xEE, 0x3C, 0x80, 1, 2, 3, 4, 5]);
    }
    let length = match rng.random_range(0..4) {
        0 => PAYLOAD * rng.random_range(1..9),
        1 => rng.random_range(20..PAYLOAD),
        _ => rng.random_range(20..12_000),
    };
    let header = if is_key { 0x65 } else { 0x61 };
    data.extend([0, 0, 0, 1, header, 0x80 | rng.random_range(1..0x7F)]);
    data.extend((6..length).map(|_| rng.random_range(1..=255_u8)));
    data
}

#[test]
fn without_loss_every_unit_is_delivered_to_the_byte() {
    let mut rng = Pcg64::seed_from_u64(4);
    let mut assembler = Assembler::new(AssemblerConfig::default());
    let mut sent = Vec::new();
    let mut got = Vec::new();
    for index in 0..UNITS {
        let data = unit(&mut rng, index);
        let at = Duration::from_millis(33) * index as u32;
        for datagram in datagrams(&data) {
            got.extend(
                assembler
                    .push(at, datagram)
                    .into_iter()
                    .flatten()
                    .map(|unit| unit.data),
            );
        }
        got.extend(
            assembler
                .handle_timeout(at + Duration::from_millis(25))
                .map(|unit| unit.data),
        );
        sent.push(data);
    }
    assert!(sent.iter().filter(|data| data.len() % PAYLOAD == 0).count() > 1000);
    assert_eq!(got.len(), sent.len());
    assert!(got == sent);
}

/// Numbered datagrams: whatever is called intact is what was sent.
#[test]
fn with_numbers_and_loss_every_intact_unit_is_byte_identical() {
    for percent in 0..=5 {
        let mut rng = Pcg64::seed_from_u64(percent);
        let mut assembler = Assembler::new(AssemblerConfig {
            framing: Framing::Binary,
            ..AssemblerConfig::default()
        });
        let (mut sent, mut intact, mut wrong) = (BTreeSet::new(), 0, 0);
        for index in 0..UNITS {
            let data = unit(&mut rng, index);
            let pieces: Vec<&[u8]> = data.chunks(PAYLOAD - 2).collect();
            sent.insert(data.clone());
            for (number, piece) in pieces.iter().enumerate() {
                let last = if number + 1 == pieces.len() { 0x80 } else { 0 };
                let datagram = [&[index as u8, number as u8 | last], *piece].concat();
                if rng.random_range(0..100) < percent {
                    continue;
                }
                for unit in assembler
                    .push(Duration::ZERO, &datagram)
                    .into_iter()
                    .flatten()
                {
                    if unit.integrity == Integrity::Intact {
                        intact += 1;
                        wrong += u64::from(!sent.contains(&unit.data));
                    }
                }
            }
            if sent.len() > 300 {
                sent.clear();
                sent.insert(data);
            }
        }
        println!("{percent} % loss: {intact} of {UNITS} intact, {wrong} wrong");
        assert_eq!(wrong, 0, "{percent} % loss");
        assert!(intact > UNITS * 6 / 10);
    }
}

/// No numbers: a loss in the middle cannot be seen, so only single datagrams are called intact; the rest is counted.
#[test]
fn without_numbers_only_what_is_sure_is_called_intact() {
    for percent in [1, 5] {
        let mut rng = Pcg64::seed_from_u64(percent);
        let mut assembler = Assembler::new(AssemblerConfig::default());
        let (mut unverified, mut undetected) = (0, 0);
        let mut recent: Vec<Vec<u8>> = Vec::new();
        for index in 0..UNITS {
            recent.push(unit(&mut rng, index));
            let data = recent.last().unwrap().clone();
            for datagram in datagrams(&data) {
                if rng.random_range(0..100) < percent {
                    continue;
                }
                for unit in assembler
                    .push(Duration::ZERO, datagram)
                    .into_iter()
                    .flatten()
                {
                    let identical = recent.contains(&unit.data);
                    match unit.integrity {
                        Integrity::Intact => assert!(identical, "unit {index}"),
                        Integrity::Unverified => {
                            unverified += 1;
                            undetected += u64::from(!identical);
                        }
                        Integrity::Suspect | Integrity::Damaged => {}
                    }
                }
            }
            if recent.len() > 8 {
                recent.remove(0);
            }
        }
        println!(
            "{percent} % loss: {undetected} of {unverified} unverified units lack a middle datagram"
        );
    }
}
