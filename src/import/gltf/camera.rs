//! Cameras. The scale of their nodes means nothing to them; nor do near and far planes to rays.

use super::document::{CameraEntry, Document, place};
use crate::camera::{Camera, Projection};
use crate::import::{WarningCode, Warnings};
use crate::math::{DAffine3, UnitVec3, Vec3};
use crate::scene::Placed;

/// The camera of node `index`; `None` where it has none, or one that cannot see.
pub fn of_node(
    document: &Document,
    index: usize,
    world: &DAffine3,
    warnings: &mut Warnings,
) -> Option<Placed<Camera>> {
    let node = &document.nodes[index];
    let used = node.camera?;
    let entry = document.cameras.get(used);
    let name = entry.and_then(|entry| entry.name.as_deref());
    match entry.map_or(Err("is not there"), |entry| camera(entry, world)) {
        Ok(item) => Some(Placed {
            name: name.or(node.name.as_deref()).unwrap_or("").into(),
            origin: world.translation,
            item,
        }),
        Err(what) => {
            let message = format!(
                "{} of {} {what}; it is left out",
                place("camera", used, name),
                document.node_place(index)
            );
            warnings.add(WarningCode::BadCamera, message);
            None
        }
    }
}

fn camera(entry: &CameraEntry, world: &DAffine3) -> Result<Camera, &'static str> {
    let [back, up] = [world.matrix3.z_axis, world.matrix3.y_axis];
    let unit = |v: crate::math::DVec3| UnitVec3::normalize(v.normalize_or_zero().as_vec3());
    let no_direction = "looks in no direction";
    let back_direction = unit(back).ok_or(no_direction)?;
    let right = unit(up.cross(back)).ok_or(no_direction)?;
    Ok(Camera {
        position: Vec3::ZERO,
        right,
        up: unit(back.cross(up.cross(back))).ok_or(no_direction)?,
        back: back_direction,
        projection: projection(entry)?,
        lens_radius: 0.0,
        focus_distance: 1.0,
    })
}

fn projection(entry: &CameraEntry) -> Result<Projection, &'static str> {
    match (&entry.perspective, &entry.orthographic) {
        (Some(perspective), _) => {
            let vertical_fov_radians = perspective.yfov;
            if !(vertical_fov_radians > 0.0 && vertical_fov_radians < std::f32::consts::PI) {
                return Err("has no field of view between 0 and 180 degrees");
            }
            Ok(Projection::Perspective {
                vertical_fov_radians,
            })
        }
        (None, Some(orthographic)) => {
            let half_height = orthographic.ymag.abs();
            if !(half_height > 0.0 && half_height.is_finite()) {
                return Err("has no height");
            }
            Ok(Projection::Orthographic { half_height })
        }
        (None, None) => Err("has no projection"),
    }
}
