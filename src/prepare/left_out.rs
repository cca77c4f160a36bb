//! What the rays of a scene do not need.

use super::PreparedScene;
use crate::scene::{Keep, LeftOut, Omission, Scene};

/// The numbers of the lights that have any power, or with [`Omission::Lights`] in `keep` of all.
/// Numbers stay what they are, since random numbers depend on them.
pub fn shining(scene: &Scene, keep: Keep) -> Vec<u32> {
    let keeps_black = keep.contains(Omission::Lights);
    (0..scene.lights.len() as u32)
        .filter(|&i| keeps_black || !scene.lights[i as usize].item.is_black())
        .collect()
}

/// What was left out of `prepared`, but for what `keep` holds.
pub fn left_out(prepared: &PreparedScene, keep: Keep) -> Vec<LeftOut> {
    let scene = prepared.scene;
    let black = prepared.lights.len() - prepared.shining.len();
    let lights = (black > 0).then(|| {
        let what = format!("samples of {black} of {} lights", prepared.lights.len());
        LeftOut::new(Omission::Lights, what, "they give no light", 0)
    });
    let all = scene.triangle_count();
    let opaque: u64 = (scene.instances.iter())
        .filter(|instance| scene.is_opaque(instance))
        .map(|instance| scene.mesh(instance.mesh).indices().len() as u64)
        .sum();
    let opacity = (opaque > 0 && !keep.contains(Omission::Opacity)).then(|| {
        let what = format!("lookups of opacity on {opaque} of {all} triangles");
        LeftOut::new(Omission::Opacity, what, "their materials are opaque", 0)
    });
    lights.into_iter().chain(opacity).collect()
}
