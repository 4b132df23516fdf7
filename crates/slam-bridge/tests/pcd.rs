//! PCD: every encoding gives the same points, and every lie is named with its place.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

use slam_bridge::{ReadError, read_pcd};

fn header(points: u64, data: &str) -> Vec<u8> {
    format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS rgb x y z\n\
         SIZE 4 4 4 8\nTYPE U F F F\nCOUNT 1 1 1 1\nWIDTH {points}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA {data}\n"
    )
    .into_bytes()
}

fn row(rgb: u32, x: f32, y: f32, z: f64) -> Vec<u8> {
    [rgb.to_le_bytes(), x.to_le_bytes(), y.to_le_bytes()]
        .concat()
        .into_iter()
        .chain(z.to_le_bytes())
        .collect()
}

fn with(mut header: Vec<u8>, body: &[u8]) -> Vec<u8> {
    header.extend_from_slice(body);
    header
}

/// Packs as literal runs only, which every LZF reader must take.
fn lzf(data: &[u8]) -> Vec<u8> {
    let mut packed = Vec::new();
    for run in data.chunks(32) {
        packed.push(run.len() as u8 - 1);
        packed.extend_from_slice(run);
    }
    let mut sized = (packed.len() as u32).to_le_bytes().to_vec();
    sized.extend_from_slice(&(data.len() as u32).to_le_bytes());
    sized.extend_from_slice(&packed);
    sized
}

fn compressed(promised: u64) -> Vec<u8> {
    let columns: Vec<u8> = [7_u32.to_le_bytes(), 8_u32.to_le_bytes()]
        .into_iter()
        .chain([1.0_f32, 4.0, 2.0, 5.0].map(f32::to_le_bytes))
        .flatten()
        .chain([3.0_f64, 6.0].into_iter().flat_map(f64::to_le_bytes))
        .collect();
    with(header(promised, "binary_compressed"), &lzf(&columns))
}

#[test]
fn every_encoding_gives_the_same_points() {
    let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let text = with(header(2, "ascii"), b"7 1 2 3\n8 4 5 6\n");
    assert_eq!(
        read_pcd(text.as_slice()).expect("ascii").positions(),
        expected
    );
    let rows = [row(7, 1.0, 2.0, 3.0), row(8, 4.0, 5.0, 6.0)].concat();
    let binary = with(header(2, "binary"), &rows);
    assert_eq!(
        read_pcd(binary.as_slice()).expect("binary").positions(),
        expected
    );
    let map = read_pcd(compressed(2).as_slice()).expect("compressed");
    assert_eq!(map.positions(), expected);
}

#[test]
fn counts_that_lie_are_caught() {
    let rows = row(7, 1.0, 2.0, 3.0);
    for promised in [2, u64::MAX] {
        let binary = with(header(promised, "binary"), &rows);
        let error = read_pcd(binary.as_slice()).expect_err("a lie");
        assert!(
            matches!(error, ReadError::Truncated { found: 1, .. }),
            "{error}"
        );
        let error = read_pcd(compressed(promised + u64::from(promised == 2)).as_slice());
        assert!(
            error
                .expect_err("a lie")
                .to_string()
                .contains("damaged compressed data")
        );
    }
    let surplus = with(header(0, "binary"), &rows);
    assert!(matches!(
        read_pcd(surplus.as_slice()),
        Err(ReadError::Surplus { .. })
    ));
    let mut cut = compressed(2);
    cut.truncate(cut.len() - 3);
    assert!(read_pcd(cut.as_slice()).is_err());
}

#[test]
fn faults_name_their_place() {
    let message = |file: Vec<u8>| {
        read_pcd(file.as_slice())
            .expect_err("bad input")
            .to_string()
    };
    let nan = with(header(2, "ascii"), b"7 1 2 3\n8 nan 5 6\n");
    assert!(message(nan).starts_with("line 13: the value in column 2 is NaN"));
    let letters = with(header(1, "ascii"), b"7 1 b 3\n");
    assert_eq!(message(letters), "line 12: 'b' in column 3 is not a number");
    assert!(message(b"ply\n".to_vec()).contains("does not begin with '# .PCD'"));
    assert!(message(b"# .PCD v0.7\nFIELDS x\n".to_vec()).contains("no DATA"));
    assert!(matches!(read_pcd([].as_slice()), Err(ReadError::Empty)));
}
