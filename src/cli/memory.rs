//! Whether a picture fits into memory: running out of it later would lose the work.

use std::hint::black_box;

use halfshade::render::Job;

use super::Failure;
use super::console::Bytes;
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
