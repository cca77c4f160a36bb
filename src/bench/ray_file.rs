//! Ray files and hit files.
//!
//! A ray file holds the bytes `RAY1`, a little-endian u32 count, then for each ray eight little-endian
//! f32: origin x y z, t_min, direction x y z, t_max. A hit file holds for each ray a u32 triangle (in
//! the order of the model; 0xffffffff: none) and an f32 t (the ray's t_max where there is no hit).

use std::fs;
use std::io::Write;
use std::path::Path;

use crate::bvh::{Bvh, Hit};
use crate::import::ImportError;
use crate::math::{Ray, Vec3};
use crate::output::{OutputError, write_whole};

use super::{Query, RaySet};

const MAGIC: &[u8; 4] = b"RAY1";
const NO_TRIANGLE: u32 = u32::MAX;

/// The rays of a ray file.
///
/// # Errors
/// Where it cannot be read, is of another kind, or does not hold as many rays as it says.
pub fn read_rays(path: &Path) -> Result<Vec<Ray>, ImportError> {
    let bytes = fs::read(path).map_err(|error| ImportError::io(path, error))?;
    let Some((count, records)) = bytes
        .strip_prefix(MAGIC)
        .and_then(|rest| rest.split_first_chunk::<4>())
    else {
        return Err(ImportError::invalid(
            path,
            "not a ray file: it does not begin with RAY1 and a number of rays",
        ));
    };
    let count = u32::from_le_bytes(*count);
    let (records, rest) = records.as_chunks::<32>();
    if records.len() != count as usize || !rest.is_empty() {
        let held = records.as_flattened().len() + rest.len();
        return Err(ImportError::invalid_at(
            path,
            "byte 4",
            format!("announces {count} rays of 32 bytes, but {held} bytes follow"),
        ));
    }
    Ok(records.iter().map(ray).collect())
}

fn ray(record: &[u8; 32]) -> Ray {
    let (numbers, _) = record.as_chunks::<4>();
    let number = |i: usize| f32::from_le_bytes(numbers[i]);
    Ray {
        origin: Vec3::new(number(0), number(1), number(2)),
        direction: Vec3::new(number(4), number(5), number(6)),
        t_min: number(3),
        t_max: number(7),
    }
}

/// Writes a ray file. Rays beyond the 2^32 that it can count are left out.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_rays(path: &Path, rays: &[Ray]) -> Result<(), OutputError> {
    let count = u32::try_from(rays.len()).unwrap_or(u32::MAX);
    write_whole(path, |file| {
        file.write_all(MAGIC)?;
        file.write_all(&count.to_le_bytes())?;
        for ray in rays.iter().take(count as usize) {
            let (o, d) = (ray.origin, ray.direction);
            for number in [o.x, o.y, o.z, ray.t_min, d.x, d.y, d.z, ray.t_max] {
                file.write_all(&number.to_le_bytes())?;
            }
        }
        Ok(())
    })
}

/// Writes what every ray of `set` finds in `tree`: its nearest hit or, where it was asked
/// whether anything is in the way, the hit that answered, which depends on the tree.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_hits(path: &Path, tree: &Bvh, set: &RaySet) -> Result<(), OutputError> {
    let find = match set.query {
        Query::Closest => Bvh::closest_hit,
        Query::Any => some_hit,
    };
    write_whole(path, |file| {
        for ray in &set.rays {
            let (triangle, t) = match find(tree, ray) {
                Some(hit) => (hit.triangle, hit.t),
                None => (NO_TRIANGLE, ray.t_max),
            };
            file.write_all(&triangle.to_le_bytes())?;
            file.write_all(&t.to_le_bytes())?;
        }
        Ok(())
    })
}

/// A hit, of a ray that asks whether there is one.
fn some_hit(tree: &Bvh, ray: &Ray) -> Option<Hit> {
    let found = std::cell::Cell::new(None);
    tree.any_hit_if(ray, |hit| {
        found.set(Some(*hit));
        true
    });
    found.get()
}
