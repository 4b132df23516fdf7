//! What is written is read back, bit by bit; and no bytes make a reader panic.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

use proptest::array::{uniform3, uniform4};
use proptest::prelude::*;
use slam_bridge::nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use slam_bridge::{
    Frustum, KeyFrame, KeyFrameId, Map, MapPoint, PointId, Scale, TimedPose, read_keyframes,
    read_map, read_map_folder, read_observations, read_pcd, read_ply, read_tum, read_xyz,
    write_keyframes, write_map_folder, write_observations, write_ply, write_tum,
};

fn pose() -> impl Strategy<Value = Isometry3<f64>> {
    (uniform3(-1e6..1e6_f64), uniform4(-1.0..1.0_f64))
        .prop_filter("a quaternion with length", |(_, q)| {
            q.iter().any(|x| x.abs() > 1e-3)
        })
        .prop_map(|([x, y, z], [i, j, k, w])| {
            let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
            Isometry3::from_parts(Translation3::new(x, y, z), rotation)
        })
}

fn map() -> impl Strategy<Value = Map> {
    let point = (
        uniform3(-1e9..1e9_f64),
        proptest::option::of(uniform3(-1.0..1.0_f64)),
        0_u8..=255,
        proptest::option::weighted(0.1, 1e-3..1e9_f64),
    );
    let points = proptest::collection::vec(point, 1..30);
    let time = proptest::option::weighted(0.8, 0.0..1e9_f64);
    let keyframes = proptest::collection::vec((pose(), time), 0..8);
    let scale = prop_oneof![
        Just(Scale::Unknown),
        (1e-3..1e3_f64).prop_map(Scale::MetersPerUnit)
    ];
    (points, keyframes, scale, 0_u64..5, any::<bool>()).prop_map(
        |(points, keyframes, scale, epoch, frustum)| Map {
            epoch,
            scale,
            points: points
                .into_iter()
                .enumerate()
                .map(map_point(keyframes.len()))
                .collect(),
            keyframes: keyframes.into_iter().enumerate().map(keyframe).collect(),
            frustum: frustum.then_some(Frustum {
                half_horizontal: 0.51,
                half_vertical: 0.375,
            }),
        },
    )
}

type RawPoint = ([f64; 3], Option<[f64; 3]>, u8, Option<f64>);

fn map_point(keyframes: usize) -> impl Fn((usize, RawPoint)) -> MapPoint {
    move |(index, (position, direction, seen, max_distance))| MapPoint {
        id: PointId(1000 - 7 * index as u64),
        position: position.into(),
        viewing_direction: direction.and_then(|d| Vector3::from(d).try_normalize(1e-3)),
        max_distance,
        observers: (0..keyframes.min(8))
            .filter(|bit| seen >> bit & 1 == 1)
            .map(|bit| KeyFrameId(3 * bit as u64))
            .collect(),
    }
}

fn keyframe(
    (index, (world_from_camera, time)): (usize, (Isometry3<f64>, Option<f64>)),
) -> KeyFrame {
    KeyFrame {
        id: KeyFrameId(3 * index as u64),
        time,
        world_from_camera,
    }
}

/// Renormalising a unit vector may move its last bits.
fn assert_same(read: &Map, written: &Map) {
    assert_eq!(read.points.len(), written.points.len());
    for (a, b) in read.points.iter().zip(&written.points) {
        assert_eq!(
            (a.id, a.position, a.max_distance, &a.observers),
            (b.id, b.position, b.max_distance, &b.observers)
        );
        let (a, b) = (a.viewing_direction, b.viewing_direction);
        assert_eq!(a.is_some(), b.is_some());
        assert!((a.unwrap_or_default() - b.unwrap_or_default()).norm() < 1e-12);
    }
    assert_eq!(read.keyframes.len(), written.keyframes.len());
    for (a, b) in read.keyframes.iter().zip(&written.keyframes) {
        assert_eq!((a.id, a.time), (b.id, b.time));
        assert_pose(&a.world_from_camera, &b.world_from_camera);
    }
    assert_eq!((read.scale, read.epoch), (written.scale, written.epoch));
    assert_eq!(read.frustum, written.frustum);
}

fn assert_pose(a: &Isometry3<f64>, b: &Isometry3<f64>) {
    assert_eq!(a.translation, b.translation);
    assert!(a.rotation.angle_to(&b.rotation) < 1e-7);
}

proptest! {
    #[test]
    fn map_through_its_three_files(map in map()) {
        let (mut points, mut keyframes, mut observations) = (Vec::new(), Vec::new(), Vec::new());
        write_ply(&map, &mut points).expect("memory takes all");
        write_keyframes(&map.keyframes, &mut keyframes).expect("memory takes all");
        write_observations(&map, &mut observations).expect("memory takes all");
        let mut read = read_ply(points.as_slice()).expect("own file");
        read.keyframes = read_keyframes(keyframes.as_slice()).expect("own file");
        let unmatched = read_observations(observations.as_slice(), &mut read).expect("own file");
        prop_assert_eq!(unmatched, slam_bridge::Unmatched::default());
        assert_same(&read, &map);
    }

    #[test]
    fn trajectory(poses in proptest::collection::vec((0.0..1e9_f64, pose()), 0..20)) {
        let poses: Vec<TimedPose> =
            poses.into_iter().map(|(time, pose)| TimedPose { time, pose }).collect();
        let mut file = Vec::new();
        write_tum(&poses, &mut file).expect("memory takes all");
        let read = read_tum(file.as_slice()).expect("own file");
        prop_assert_eq!(read.len(), poses.len());
        for (a, b) in read.iter().zip(&poses) {
            prop_assert_eq!(a.time, b.time);
            assert_pose(&a.pose, &b.pose);
        }
    }

    #[test]
    fn no_bytes_make_a_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        read_everything(&bytes);
    }

    #[test]
    fn no_body_behind_a_good_header_makes_a_reader_panic(
        header in 0..HEADERS.len(),
        count in prop_oneof![0_u64..9, any::<u64>()],
        body in proptest::collection::vec(any::<u8>(), 0..200),
    ) {
        let mut file = HEADERS[header].replace('N', &count.to_string()).into_bytes();
        file.extend_from_slice(&body);
        read_everything(&file);
    }

    #[test]
    fn no_text_makes_a_reader_panic(text in "([-0-9a-z.,; \n#]|nan|ply\n){0,60}") {
        read_everything(text.as_bytes());
    }
}

const HEADERS: [&str; 6] = [
    "ply\nformat ascii 1.0\nelement vertex N\nproperty float x\nproperty float y\n\
     property float z\nproperty list uchar int l\nend_header\n",
    "ply\nformat binary_little_endian 1.0\nelement face N\nproperty list double double l\n\
     element vertex N\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
    "ply\nformat binary_big_endian 1.0\nelement empty N\nelement vertex N\nproperty char x\n\
     property short y\nproperty double z\nproperty int id\nend_header\n",
    "# .PCD\nFIELDS x y z\nSIZE 4 4 8\nTYPE F U F\nPOINTS N\nDATA ascii\n",
    "# .PCD\nFIELDS x y z\nSIZE 4 4 8\nTYPE F U F\nPOINTS N\nDATA binary\n",
    "# .PCD\nFIELDS x y z\nSIZE 4 4 8\nTYPE F U F\nPOINTS N\nDATA binary_compressed\n",
];

fn read_everything(bytes: &[u8]) {
    let _ = read_ply(bytes);
    let _ = read_pcd(bytes);
    let _ = read_xyz(bytes);
    let _ = read_tum(bytes);
    let _ = read_keyframes(bytes);
    let _ = read_observations(bytes, &mut Map::from_positions([[0.0; 3]]));
}

#[test]
fn a_folder_gives_back_the_map() {
    let folder = std::env::temp_dir().join(format!("slam-bridge-folder-{}", std::process::id()));
    let mut map = Map::from_positions([[1.0, 2.0, 3.0], [0.1, 0.2, 0.3]]);
    map.scale = Scale::MetersPerUnit(0.37);
    map.keyframes = vec![keyframe((
        0,
        (Isometry3::translation(0.5, 0.0, 0.0), Some(1.25)),
    ))];
    map.points[1].observers = vec![KeyFrameId(0)];
    write_map_folder(&map, &folder).expect("a folder of our own");
    let read = read_map(&folder).expect("own folder");
    assert_same(&read, &map);
    assert_same(
        &read_map(folder.join("map.ply")).expect("own file"),
        &bare(&map),
    );
    let missing = read_map_folder(&folder, Some(7)).expect_err("no such version");
    assert!(missing.to_string().contains("holds no map.ply"));
    std::fs::remove_dir_all(&folder).expect("a folder of our own");
}

fn bare(map: &Map) -> Map {
    let mut bare = map.clone();
    bare.keyframes.clear();
    bare.points
        .iter_mut()
        .for_each(|point| point.observers.clear());
    bare
}

#[test]
fn paths_that_lead_nowhere_say_so() {
    let message = |path: &str| read_map(path).expect_err("no map").to_string();
    assert_eq!(
        message("/no/such/map.ply"),
        "/no/such/map.ply: no such file or folder"
    );
    assert!(message(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml")).contains("no reader for"));
    assert!(message(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).contains("holds no map.ply"));
}
