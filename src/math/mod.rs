//! Vectors and the few shapes that everything else is made of.
//!
//! Vectors and matrices are [`glam`]'s; a point and a direction are both [`Vec3`], and the
//! functions that transform them say which is meant (`transform_point3`, `transform_vector3`).
//! Here are the types that glam lacks: unit vectors, rays, boxes and shading frames.

mod aabb;
mod extremes;
mod frame;
mod morton;
mod ray;
mod rounding;
mod rows;
mod unit;

pub use aabb::Aabb;
pub use extremes::{larger, lesser};
pub use frame::Frame;
pub use glam::{Affine2, DAffine3, DMat3, DMat4, DQuat, DVec2, DVec3, Mat3, UVec2, Vec2, Vec3};
pub use morton::morton_pixel;
pub use ray::Ray;
pub use rounding::{ONE_MINUS_EPSILON, UNIT_ROUNDOFF, gamma};
pub use rows::{
    FEW, ROW, RayRow, Row, RowJob, VectorRow, first_places, places, those_where, widely,
};
pub use unit::UnitVec3;
