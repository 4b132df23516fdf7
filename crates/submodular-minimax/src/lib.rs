//! Minimax of jointly submodular set functions, and outlier removal for point clouds built on it.
