//! Finds where the range profile around an agent opens: doors, corridors and other ways out of a room.
