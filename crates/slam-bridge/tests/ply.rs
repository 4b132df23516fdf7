//! PLY: every encoding gives the same points, and every lie is named with its place.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

use slam_bridge::{Fault, Place, ReadError, read_ply};

const HEADER: &str = "property float x\nproperty float y\nproperty float z\nend_header\n";

fn ascii(vertices: &str, body: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\nelement vertex {vertices}\n{HEADER}{body}").into_bytes()
}

fn binary(endian: &str, vertices: u64, rows: &[[f32; 3]]) -> Vec<u8> {
    let mut file =
        format!("ply\nformat binary_{endian}_endian 1.0\nelement vertex {vertices}\n").into_bytes();
    file.extend_from_slice(HEADER.as_bytes());
    for value in rows.iter().flatten() {
        match endian {
            "big" => file.extend_from_slice(&value.to_be_bytes()),
            _ => file.extend_from_slice(&value.to_le_bytes()),
        }
    }
    file
}

fn message(file: &[u8]) -> String {
    read_ply(file).expect_err("bad input").to_string()
}

#[test]
fn ascii_and_both_byte_orders_agree() {
    let rows = [[1.5, -2.0, 0.25], [4.0, 5.0, 6.0]];
    let text = read_ply(ascii("2", "1.5 -2 0.25\n4 5 6\n").as_slice()).expect("ascii");
    assert_eq!(text.positions(), [[1.5, -2.0, 0.25], [4.0, 5.0, 6.0]]);
    assert_eq!(
        read_ply(binary("little", 2, &rows).as_slice()).expect("little"),
        text
    );
    assert_eq!(
        read_ply(binary("big", 2, &rows).as_slice()).expect("big"),
        text
    );
}

#[test]
fn unknown_elements_lists_and_properties_are_skipped() {
    let file = "ply\r\nformat ascii 1.0\r\ncomment made elsewhere\r\nelement camera 1\r\n\
        property list uchar int ids\r\nelement vertex 2\r\nproperty uchar red\r\n\
        property list uchar float weights\r\nproperty double x\r\nproperty double y\r\n\
        property double z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n\
        property uint id\r\nproperty float max_distance\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n\
        end_header\r\n3 1 2 3\r\n255 2 0.5 0.5 1 2 3 0 0 2 70 2.5\r\n0 0 4 5 6 0 0 0 8 0\r\n3 0 1 0\r\n";
    let map = read_ply(file.as_bytes()).expect("good file");
    assert_eq!(map.positions(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(map.points[0].id.0, 70);
    assert_eq!(map.points[0].viewing_direction.map(|d| d.z), Some(1.0));
    assert_eq!(map.points[1].viewing_direction, None);
    assert_eq!(map.points[0].max_distance, Some(2.5));
    assert_eq!(map.points[1].max_distance, None);
}

#[test]
fn binary_lists_are_skipped() {
    let mut file = b"ply\nformat binary_little_endian 1.0\nelement face 1\n\
        property list uchar int vertex_indices\nelement vertex 1\n"
        .to_vec();
    file.extend_from_slice(HEADER.as_bytes());
    file.extend_from_slice(&[2, 1, 0, 0, 0, 2, 0, 0, 0]);
    for value in [7.0_f32, 8.0, 9.0] {
        file.extend_from_slice(&value.to_le_bytes());
    }
    assert_eq!(
        read_ply(file.as_slice()).expect("good file").positions(),
        [[7.0, 8.0, 9.0]]
    );
}

#[test]
fn a_truncated_file_says_how_far_it_goes() {
    let text = message(&ascii("3", "1 2 3\n4 5 6\n"));
    assert!(
        text.contains("promises 3 vertex rows, the file ends after 2 (line 9)"),
        "{text}"
    );
    let text = message(&ascii("2", "1 2 3\n4 5"));
    assert_eq!(text, "line 9: 2 columns where 3 belong");
    let rows = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let mut file = binary("little", 2, &rows);
    file.truncate(file.len() - 1);
    assert!(message(&file).contains("promises 2 vertex rows, the file ends after 1"));
}

#[test]
fn a_header_that_lies_either_way_is_caught() {
    let rows = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    for promised in ["1", "18446744073709551615"] {
        let error = read_ply(ascii(promised, "1 2 3\n4 5 6\n").as_slice()).expect_err("a lie");
        let known = matches!(
            error,
            ReadError::Surplus { .. } | ReadError::Truncated { .. }
        );
        assert!(known, "{error}");
    }
    assert!(matches!(
        read_ply(binary("big", 1, &rows).as_slice()),
        Err(ReadError::Surplus {
            promised: 1,
            place: Place::Byte(_)
        })
    ));
    assert!(matches!(
        read_ply(binary("big", u64::MAX, &rows).as_slice()),
        Err(ReadError::Truncated { found: 2, .. })
    ));
    assert!(message(&ascii("-4", "1 2 3\n")).starts_with("line 3: a PLY header line"));
}

#[test]
fn nan_and_letters_are_named_with_their_place() {
    let text = message(&ascii("2", "1 2 3\n4 nan 6\n"));
    assert!(
        text.starts_with("line 9: the value in column 2 is NaN"),
        "{text}"
    );
    assert_eq!(
        message(&ascii("1", "1 2 z\n")),
        "line 8: 'z' in column 3 is not a number"
    );
    let error = read_ply(binary("little", 2, &[[1.0; 3], [1.0, f32::INFINITY, 1.0]]).as_slice());
    let header = binary("little", 2, &[]).len() as u64;
    match error {
        Err(ReadError::At { place, fault }) => {
            assert_eq!(place, Place::Byte(header + 12));
            assert_eq!(fault, Fault::NonFinite { column: 2 });
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_id_used_twice_is_refused() {
    let file = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
        property float z\nproperty int id\nend_header\n1 2 3 9\n1 2 3 9\n";
    assert!(message(file.as_bytes()).starts_with("line 10: the id 9 is not"));
}

#[test]
fn other_files_are_not_taken_for_ply() {
    assert!(matches!(read_ply([].as_slice()), Err(ReadError::Empty)));
    assert!(message(b"solid cube\n").contains("does not begin with 'ply'"));
    assert!(message(b"ply\nformat ascii 1.0\nend_header\n").contains("no element vertex"));
    assert!(message(b"ply\nformat ascii 1.0\nelement vertex 1\n").contains("no end_header"));
    let no_format = message(b"ply\nelement vertex 0\nproperty float x\nend_header\n");
    assert!(no_format.contains("no format"), "{no_format}");
    let no_z = message(b"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n");
    assert!(no_z.contains("no x, y, z"), "{no_z}");
}
