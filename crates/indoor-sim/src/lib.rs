#![doc = include_str!("../README.md")]

mod random;
mod world;

pub use world::{
    Door, FloorPlan, Furniture, Landmark, PRESETS, Reach, Room, Solid, SolidKind, Start,
    TextureConfig, World, WorldError, coverage, generate,
};
