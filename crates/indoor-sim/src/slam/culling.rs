//! What the map forgets: points that too few keyframes confirmed, and keyframes that add nothing.

use slam_bridge::KeyFrameId;

use super::mapping::{Mapping, NONE};

/// How many of the newest keyframes are looked at when removing redundant ones.
const RECENT: u32 = 12;

/// Share of well observed points that makes a keyframe redundant (ORB-SLAM: 0.9).
const REDUNDANT: f64 = 0.9;

/// A point is well observed with more observers than this. ORB-SLAM: 3 in the same octave or a finer one; octaves are
/// not simulated, so the number is raised until the points keep as many observers as on real maps.
const OTHERS: usize = 5;

/// A point has to prove itself for this many keyframes.
const PROBATION: u32 = 2;

impl Mapping {
    /// Removes the points born [`PROBATION`] keyframes ago that still have two observers or fewer, as ORB-SLAM does.
    pub(super) fn cull_points(&mut self, newest: u32) {
        let Some(birth) = newest.checked_sub(PROBATION) else {
            return;
        };
        for index in (0..self.points.len()).rev() {
            let point = &self.points[index];
            if point.born < birth {
                break;
            }
            if point.kept && point.born == birth && point.observers.len() <= 2 {
                self.remove_point(index as u32);
            }
        }
    }

    /// Removes the recent keyframes that are redundant: nine tenths of their points are well observed without them.
    pub(super) fn cull_frames(&mut self, newest: u32) {
        let oldest = newest.saturating_sub(RECENT).max(2);
        for number in oldest..newest.saturating_sub(1) {
            let frame = &self.frames[number as usize];
            let seen = |&&index: &&u32| self.points[index as usize].observers.len() > OTHERS;
            let redundant = frame.points.iter().filter(seen).count();
            if frame.kept && redundant as f64 > REDUNDANT * frame.points.len() as f64 {
                self.remove_frame(number);
            }
        }
    }

    fn remove_frame(&mut self, number: u32) {
        let frame = &mut self.frames[number as usize];
        frame.kept = false;
        let id = KeyFrameId(u64::from(number));
        for index in core::mem::take(&mut frame.points) {
            let observers = &mut self.points[index as usize].observers;
            observers.retain(|&observer| observer != id);
            if observers.len() < 2 {
                self.remove_point(index);
            }
        }
    }

    fn remove_point(&mut self, index: u32) {
        let point = &mut self.points[index as usize];
        point.kept = false;
        self.owner[point.landmark as usize] = NONE;
        for observer in core::mem::take(&mut point.observers) {
            self.frames[observer.0 as usize]
                .points
                .retain(|&other| other != index);
        }
    }
}
