//! DJI Tello protocol: a sans-IO core with typed commands, replies and telemetry.
