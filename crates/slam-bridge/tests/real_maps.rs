//! Every published map at hand reads with the number of points that its description gives.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a test that fails should say where"
)]

use std::path::PathBuf;

use slam_bridge::{read_map, read_map_folder, read_tum};

/// Where the data lie, or `None` with a line that says so.
fn data() -> Option<PathBuf> {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").into();
    let root = std::env::var_os("EXPLORER_DATA")
        .map_or(default, PathBuf::from)
        .join("data");
    if root.is_dir() {
        return Some(root);
    }
    println!("skipped: no maps in {} (set EXPLORER_DATA)", root.display());
    None
}

#[test]
fn files_hold_the_points_that_their_description_gives() {
    let Some(data) = data() else { return };
    for (path, points) in [
        ("tello-orbslam-rooms/room1.csv", 14_216),
        ("tello-orbslam-rooms/jackobs.csv", 8_823),
        ("tello-orbslam-rooms/shahar_1.csv", 7_977),
        ("tello-orbslam-rooms/shahar_4.csv", 3_406),
        ("tello-orbslam-rooms/fares.csv", 4_436),
        ("tello-orbslam-rooms/fares_df1.csv", 2_103),
        (
            "orbslam3-maps/sevenscenes_kitchen_mono_first500/map.ply",
            4_460,
        ),
        ("orbslam3-maps/office_mono_growing/map_99.ply.gz", 2_007),
        ("orbslam3-maps/office_mono_growing/map_1199.ply", 6_328),
        ("synthetic-apartment/apt_10k_o15.ply", 10_000),
        ("pcl_room_scans/room_scan1.pcd", 112_586),
        ("pcl_room_scans/room_scan2.pcd", 112_624),
        ("pcl_room_scans/room_scan1.ply", 112_586),
        ("pcl_room_scans/room_scan2.ply", 112_624),
        ("orbslam2_euroc_v101_map/MapPoints.txt", 8_704),
        ("orbslam2_euroc_v101_map/MapPoints.pcd", 8_704),
        ("phone_desk_orbslam2/orbslam2_map_offline.pcd", 1_871),
        ("phone_desk_orbslam2/orbslam2_map_live.pcd", 3_043),
        ("phone_desk_orbslam2/orbslam2_MapPoints.txt", 1_826),
    ] {
        let map = read_map(data.join(path)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(map.points.len(), points, "{path}");
    }
}

#[test]
fn folders_hold_keyframes_and_observations() {
    let Some(data) = data() else { return };
    for (path, points, keyframes) in [
        ("sevenscenes_kitchen_mono_first500", 4_460, 67),
        ("tum_fr1_rpy_rgbd", 3_678, 75),
        ("office_mono_growing", 6_328, 108),
        ("kitti_mono_51frames", 1_132, 10),
        ("euroc_v101_stationary_stereo", 544, 1),
    ] {
        let map = read_map(data.join("orbslam3-maps").join(path)).expect(path);
        assert_eq!(
            (map.points.len(), map.keyframes.len()),
            (points, keyframes),
            "{path}"
        );
        assert!(map.has_observations(), "{path}");
        assert!(
            map.points.iter().all(|point| !point.observers.is_empty()),
            "{path}"
        );
        assert!(
            map.points
                .iter()
                .all(|point| point.viewing_direction.is_some()),
            "{path}"
        );
    }
}

#[test]
fn an_older_version_of_a_growing_map_can_be_asked_for() {
    let Some(data) = data() else { return };
    let folder = data.join("orbslam3-maps/office_mono_growing");
    let map = read_map_folder(folder, Some(99)).expect("map_99");
    assert_eq!((map.points.len(), map.keyframes.len()), (2_007, 14));
    assert!(!map.has_observations());
}

#[test]
fn two_encodings_of_one_scan_agree() {
    let Some(data) = data() else { return };
    let scan = data.join("pcl_room_scans/room_scan1");
    let ply = read_map(scan.with_extension("ply")).expect("PLY");
    assert_eq!(ply, read_map(scan.with_extension("pcd")).expect("PCD"));
}

#[test]
fn trajectories_read_whole() {
    let Some(data) = data() else { return };
    let path = data.join("orbslam3-maps/sevenscenes_kitchen_mono_first500/kf_tum.txt");
    let file = std::fs::read(path).expect("a trajectory");
    assert_eq!(read_tum(file.as_slice()).expect("TUM").len(), 67);
}
