//! The vocabulary of Wheatstone and its reference renderer: volumes and their geometry, transfer functions,
//! views, rigs, phantoms, image metrics, and the CPU ray caster that the GPU is tested against.
//!
//! No GPU, no files. Spaces and units are named in every identifier; `ARCHITECTURE.md` lists them.
#![forbid(unsafe_code)]

pub mod budget;
pub mod cast;
pub mod detail;
pub mod first_hits;
pub mod gradient_map;
pub mod head;
pub mod headset;
pub mod image;
pub mod lightfield;
pub mod lit_sphere;
pub mod metrics;
pub mod phantom;
pub mod reference;
pub mod scene;
pub mod skip;
pub mod stereo;
pub mod transfer;
pub mod view;
pub mod volume;
pub mod warp;
