//! Explores unknown rooms with a toy drone: the mission, and the explorer command.
