//! Rays of the four kinds that a renderer traces, for any mesh.

use rayon::prelude::*;

use crate::bvh::{Builder, Bvh, Hit};
use crate::camera::{Camera, film_position};
use crate::import::scene_file::framing_camera;
use crate::interaction::{Interaction, rounding_error};
use crate::math::{Aabb, DVec3, Frame, Ray, UVec2, UnitVec3, Vec2, Vec3, morton_pixel};
use crate::sampling::{
    Pattern, Sampler, SamplingConfig, square_to_cone, square_to_disk, square_to_hemisphere,
};

use super::{Query, RaySet, Triangles};

/// From the middle of the mesh to the light, and the light's radius, in halves of the mesh's
/// longest side.
const TO_LIGHT: Vec3 = Vec3::new(1.2, 2.0, 1.0);
const LIGHT_RADIUS: f32 = 0.25;

/// Numbers of a ray, by what they are for.
#[derive(Clone, Copy)]
enum Use {
    OnLight,
    OffSurface,
    Direction,
    OriginXy,
    OriginZ,
}

/// The rays of a camera with `side` × `side` pixels that frames `triangles`, neighbours near each other
/// (`primary`); from what they hit, one to a point of a disk light each (`shadow`, any hit) and
/// one after a cosine-distributed bounce (`diffuse`); and `side`² rays from and to anywhere in the
/// mesh's box (`random`).
///
/// The same for any number of threads. `None` where there is nothing that rays could hit.
pub fn own_rays(triangles: &Triangles, side: u32) -> Option<[RaySet; 4]> {
    let tree = Bvh::build(&triangles.positions, &triangles.indices, Builder::default());
    let bounds = tree.bounds();
    let camera = camera(&bounds)?;
    let light = DiskLight::over(&bounds)?;
    let codes = 0..side.next_power_of_two().pow(2);
    let pixels = codes.map(morton_pixel).filter(|p| p.x < side && p.y < side);
    let pixels: Vec<UVec2> = pixels.collect();
    let rays = camera.rays(UVec2::splat(side));
    let primary: Vec<Ray> = pixels
        .par_iter()
        .map(|&pixel| {
            let film = film_position(pixel, Vec2::splat(0.5));
            rays.at(film, Vec2::ZERO)
        })
        .collect();
    let (shadow, diffuse) = primary
        .par_iter()
        .zip(&pixels)
        .filter_map(|(ray, &pixel)| {
            let hit = tree.closest_hit(ray)?;
            let surface = surface(triangles, ray, &hit)?;
            let numbers = numbers(pixel);
            let to_light = surface.spawn_ray_to(light.point(numbers(Use::OnLight)));
            let around = Frame::around(surface.geometric_normal);
            let bounce = around.to_world(square_to_hemisphere(numbers(Use::OffSurface)));
            Some((to_light, surface.spawn_ray(bounce)))
        })
        .unzip();
    let random = pixels
        .par_iter()
        .map(|&pixel| random_ray(&bounds, numbers(pixel)))
        .collect();
    let set = |name: &str, query, rays| RaySet {
        name: name.to_owned(),
        file: None,
        query,
        rays,
    };
    Some([
        set("primary", Query::Closest, primary),
        set("shadow", Query::Any, shadow),
        set("diffuse", Query::Closest, diffuse),
        set("random", Query::Closest, random),
    ])
}

/// As a model by itself gets it; `None` where there is nothing to see.
fn camera(bounds: &Aabb) -> Option<Camera> {
    if bounds.is_empty() {
        return None;
    }
    let camera = framing_camera((bounds.min.as_dvec3(), bounds.max.as_dvec3()), 1.0)?;
    Some(camera.item.placed(1.0, camera.origin.as_vec3()))
}

struct DiskLight {
    center: Vec3,
    radius: f32,
    frame: Frame,
}

impl DiskLight {
    /// Above, to the side of and facing the middle of `bounds`.
    fn over(bounds: &Aabb) -> Option<Self> {
        let half_side = 0.5 * bounds.extent().max_element();
        Some(Self {
            center: bounds.center() + half_side * TO_LIGHT,
            radius: half_side * LIGHT_RADIUS,
            frame: Frame::around(UnitVec3::normalize(-TO_LIGHT)?),
        })
    }

    fn point(&self, u: Vec2) -> Vec3 {
        let on_disk = self.radius * square_to_disk(u);
        self.center + self.frame.to_world(on_disk.extend(0.0))
    }
}

/// What `ray` hits, seen from its origin; `None` where the triangle has no normal.
fn surface(triangles: &Triangles, ray: &Ray, hit: &Hit) -> Option<Interaction> {
    let corners = triangles.indices[hit.triangle as usize];
    let [a, b, c] = corners.map(|i| triangles.positions[i as usize].as_dvec3());
    let normal = UnitVec3::normalize_f64((b - a).cross(c - a))?;
    let wo = UnitVec3::normalize(-ray.direction)?;
    let is_front = normal.dot(*wo) > 0.0;
    let normal = if is_front { normal } else { -normal };
    let [u, v] = [hit.u, hit.v].map(f64::from);
    let point = (a + u * (b - a) + v * (c - a)).as_vec3();
    Some(Interaction {
        point,
        point_error: rounding_error(point),
        smooth_point: None,
        geometric_normal: normal,
        shading_normal: normal,
        wo,
        is_front,
    })
}

/// Independent points of the unit square, one for each use.
fn numbers(pixel: UVec2) -> impl Fn(Use) -> Vec2 {
    let config = SamplingConfig {
        samples: 1,
        pattern: Pattern::Random,
        ..SamplingConfig::default()
    };
    let sampler = Sampler::new(&config, pixel, 0);
    move |purpose| sampler.light(1, purpose as u32, 0, 1)
}

fn random_ray(bounds: &Aabb, numbers: impl Fn(Use) -> Vec2) -> Ray {
    let place = numbers(Use::OriginXy).extend(numbers(Use::OriginZ).x);
    let direction: DVec3 = square_to_cone(numbers(Use::Direction), 2.0);
    Ray::new(bounds.min + place * bounds.extent(), direction.as_vec3())
}
