//! What glTF files become: other people's files against other people's loaders, and small
//! documents made here for each rule and each kind of broken file.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod accessors;
mod animation;
mod builder;
mod damage;
mod deformation;
mod files;
mod hierarchy;
mod layers;
mod lights_and_cameras;
mod materials;
mod models;
