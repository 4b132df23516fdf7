//! Sparse points, and what the camera saw through, to clusters, convex obstacles and proven free space.
