//! The tracing core: which triangle does a ray hit?
//!
//! Triangles go in; out comes a [`Bvh`], or a [`Tracer`] over instances of several, that
//! answers `closest_hit` and `any_hit`. A hit is a function of ray and triangle alone
//! (`triangle`): trees and vector instructions only decide what need not be looked at, and what is certain to be hit;
//! `caster` and `filter` show why they never decide wrongly.

mod beam;
mod boxes;
mod build;
mod caster;
mod count;
mod filter;
mod forest;
mod hit;
mod layout;
mod packet;
mod simd;
mod single;
mod stats;
mod traverse;
mod tree;
mod triangle;

pub use boxes::BoxTree;
pub use build::Builder;
pub use count::TraversalCounts;
pub use forest::{Forest, Tracer};
pub use hit::{Hit, HitRow};
pub use stats::TreeStats;
pub use tree::{Bvh, Width};
