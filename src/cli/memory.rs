//! Whether trees and a picture fit into memory: running out of it later would lose the work.

use std::hint::black_box;

use halfshade::bvh::Builder;
use halfshade::prepare::traced_triangles;
use halfshade::render::Job;
use halfshade::scene::Scene;

use super::Failure;
use super::console::{Bytes, Console};
use super::layers::{LayerKind, LayerValues};

/// Fails where the system does not give what `job` and its outputs will take.
pub fn check(job: &Job, layers: &[LayerKind]) -> Result<(), Failure> {
    let outputs = job.crop.area() * LayerValues::pixel_bytes(layers);
    let bytes = job.memory_bytes() + outputs;
    if can_be_had(bytes) {
        return Ok(());
    }
    Err(Failure::job(format_args!(
        "a picture of {}x{} pixels takes {} of memory, which cannot be had; \
         --size makes it smaller, --crop renders a part of it",
        job.crop.width,
        job.crop.height,
        Bytes(bytes)
    )))
}

/// Says what building the trees over `scene` will take, and fails where that is above `limit`.
pub fn check_build(
    scene: &Scene,
    builder: Builder,
    limit: Option<u64>,
    console: Console,
) -> Result<(), Failure> {
    let triangles = traced_triangles(scene);
    let peak = builder.peak_bytes(triangles);
    console.detail(format_args!(
        "building the {builder} tree over {triangles} triangles takes up to {}",
        Bytes(peak)
    ));
    match limit {
        Some(limit) if peak > limit => Err(Failure::job(format_args!(
            "building the {builder} tree over {triangles} triangles takes up to {}, which is more \
             than --max-memory allows ({})",
            Bytes(peak),
            Bytes(limit)
        ))),
        _ => Ok(()),
    }
}

/// Whether the system would give this much memory in one piece; it is given back untouched.
fn can_be_had(bytes: u64) -> bool {
    let Ok(bytes) = usize::try_from(bytes) else {
        return false;
    };
    let mut probe: Vec<u8> = Vec::new();
    let is_had = probe.try_reserve_exact(bytes).is_ok();
    // Otherwise the compiler may leave out an allocation that nobody looks at.
    black_box(&probe);
    is_had
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_an_address_space_cannot_be_had() {
        assert!(can_be_had(1 << 20));
        assert!(!can_be_had(1 << 62) && !can_be_had(u64::MAX));
    }
}
