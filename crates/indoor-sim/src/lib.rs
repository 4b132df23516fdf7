//! Seeded indoor worlds, a Tello-like drone and a stand-in for sparse monocular SLAM.
