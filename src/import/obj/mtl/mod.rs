//! MTL: what a material library says, and what it means.
//!
//! The statements are read here and not by `tobj`, whose reader takes one bad number for the end
//! of the whole file, keeps only one value of each statement it does not know (emission, the
//! PBR keys, most maps), and keeps the options of a map as part of its file name. Tests read the
//! same files with both.

mod map;
mod statements;
mod surface;
mod textures;

pub use statements::{MtlMaterial, read};
pub use surface::{NEUTRAL_REFLECTANCE, material};
pub use textures::Textures;
