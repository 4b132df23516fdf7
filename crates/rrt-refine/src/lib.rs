//! Sampling-based motion planners and path refiners in any dimension over a motion-validity closure.
