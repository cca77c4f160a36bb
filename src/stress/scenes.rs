//! Small scenes, made in code.
//!
//! No file and no user has a part in them, so that what cannot fail is not handed on as a `Result`.

#![allow(clippy::expect_used)]

use crate::bvh::Builder;
use crate::camera::{Camera, Projection};
use crate::color::Rgb;
use crate::film::{Film, Rect};
use crate::integrate::{RayLog, integrator};
use crate::light::{Falloff, Light, PointLight};
use crate::material::{Material, MaterialId, MetallicRoughness, Phong, Surface};
use crate::math::{DAffine3, DVec3, Ray, UVec2, UnitVec3, Vec3};
use crate::prepare::{PreparedScene, prepare};
use crate::render::{Job, render};
use crate::sampling::Sampler;
use crate::scene::{Instance, Mesh, MeshId, Placed, Scene, Settings};
use crate::texture::{Filter, Image, ImageId, Pixels, Texture, TextureId, TextureRef, Wrap};
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;

/// Adds a mesh with its own material.
pub fn add_mesh(
    scene: &mut Scene,
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    material: Material,
) {
    let mesh = Mesh::new(material.name.clone(), positions, indices).expect("a mesh");
    scene.instances.push(Instance {
        name: material.name.clone(),
        mesh: MeshId(scene.meshes.len() as u32),
        material: MaterialId(scene.materials.len() as u32),
        transform: DAffine3::IDENTITY,
    });
    scene.meshes.push(mesh);
    scene.materials.push(material);
}

/// Adds the parallelogram `center ± u ± v`, which faces `u × v`.
pub fn add_quad(scene: &mut Scene, center: Vec3, u: Vec3, v: Vec3, material: Material) {
    let positions = vec![
        center - u - v,
        center + u - v,
        center + u + v,
        center - u + v,
    ];
    add_mesh(scene, positions, vec![[0, 1, 2], [0, 2, 3]], material);
}

/// Adds a box from `min` to `max`, facing outwards.
pub fn add_box(scene: &mut Scene, min: Vec3, max: Vec3, material: Material) {
    let positions = (0..8)
        .map(|i| {
            let pick = |bit: u32, lo: f32, hi: f32| if i >> bit & 1 == 0 { lo } else { hi };
            Vec3::new(
                pick(0, min.x, max.x),
                pick(1, min.y, max.y),
                pick(2, min.z, max.z),
            )
        })
        .collect();
    let quads: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let indices = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    add_mesh(scene, positions, indices, material);
}

/// Adds a closed sphere of `rows` × 2 `rows` quads, facing outwards.
pub fn add_sphere(scene: &mut Scene, center: Vec3, radius: f32, rows: u32, material: Material) {
    let columns = 2 * rows;
    let mut positions = vec![center + Vec3::Y * radius, center - Vec3::Y * radius];
    for row in 1..rows {
        let theta = std::f32::consts::PI * row as f32 / rows as f32;
        for column in 0..columns {
            let phi = std::f32::consts::TAU * column as f32 / columns as f32;
            let ring = Vec3::new(
                theta.sin() * phi.cos(),
                theta.cos(),
                theta.sin() * phi.sin(),
            );
            positions.push(center + ring * radius);
        }
    }
    let at = |row: u32, column: u32| 2 + (row - 1) * columns + column % columns;
    let mut indices = Vec::new();
    for column in 0..columns {
        indices.push([0, at(1, column + 1), at(1, column)]);
        indices.push([1, at(rows - 1, column), at(rows - 1, column + 1)]);
        for row in 1..rows - 1 {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
            indices.extend([[a, b, d], [a, d, c]]);
        }
    }
    add_mesh(scene, positions, indices, material);
}

/// A material of glTF's metallic-roughness model: `edit` changes it from what glTF says of one
/// that says nothing.
pub fn metallic_roughness(edit: impl FnOnce(&mut MetallicRoughness)) -> Material {
    let mut surface = MetallicRoughness::default();
    edit(&mut surface);
    Material {
        surface: Surface::MetallicRoughness(Box::new(surface)),
        ..Material::matte("metallic-roughness", Rgb::BLACK)
    }
}

/// A Phong material: `edit` changes it from one that reflects nothing.
pub fn phong(edit: impl FnOnce(&mut Phong)) -> Material {
    let mut phong = Phong::matte(Rgb::BLACK);
    edit(&mut phong);
    Material {
        surface: Surface::Phong(phong),
        ..Material::matte("phong", Rgb::BLACK)
    }
}

/// Adds an image of linear values, `width` pixels across, that repeats and is not filtered.
pub fn add_texture(scene: &mut Scene, width: u32, pixels: Vec<[f32; 4]>) -> TextureRef {
    let image = ImageId(scene.images.len() as u32);
    scene.images.push(Image {
        name: String::new(),
        width,
        height: pixels.len() as u32 / width,
        pixels: Pixels::Rgba32F(pixels),
    });
    let texture = TextureId(scene.textures.len() as u32);
    scene.textures.push(Texture {
        image,
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Nearest,
    });
    TextureRef::new(texture)
}

/// Adds any light; its own coordinates are the world's.
pub fn add_light(scene: &mut Scene, light: Light) {
    scene.lights.push(Placed {
        name: String::new(),
        origin: DVec3::ZERO,
        item: light,
    });
}

/// A point light with the inverse square law.
pub fn point_light(position: Vec3, intensity: f32, radius: f32, samples: u32) -> Light {
    Light::Point(PointLight {
        position,
        intensity: Rgb::splat(intensity),
        radius,
        samples,
        falloff: Falloff::INVERSE_SQUARE,
    })
}

/// Radiance that comes back along a world-space ray, averaged over `samples` camera samples that
/// all take this ray.
pub fn radiance(scene: &Scene, origin: Vec3, direction: Vec3, settings: &Settings) -> Rgb {
    radiance_in(
        &prepare(scene, Builder::default()).scene,
        origin,
        direction,
        settings,
    )
}

/// As [`radiance`], in a scene that is prepared already.
pub fn radiance_in(
    prepared: &PreparedScene,
    origin: Vec3,
    direction: Vec3,
    settings: &Settings,
) -> Rgb {
    let origin = prepared.placement.point(origin.as_dvec3());
    let direction = UnitVec3::normalize(direction).expect("a direction");
    let integrator = integrator(prepared, settings);
    let mut log = RayLog::default();
    let count = settings.sampling.samples_per_pixel();
    let mut sum = [0.0f64; 3];
    for index in 0..count {
        let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, index);
        let ray = Ray::new(origin, *direction);
        let value = integrator.radiance(&ray, &sampler, &mut log);
        for (s, v) in sum.iter_mut().zip(value.channels()) {
            *s += f64::from(v);
        }
    }
    Rgb::from(sum.map(|s| (s / f64::from(count)) as f32))
}

/// Green of [`radiance`] for `count` seeds in a row.
pub fn means(
    scene: &Scene,
    origin: Vec3,
    direction: Vec3,
    settings: &Settings,
    count: u64,
) -> Vec<f64> {
    let prepared = prepare(scene, Builder::default()).scene;
    let mean = |seed| {
        let mut settings = settings.clone();
        settings.sampling.seed = seed;
        f64::from(radiance_in(&prepared, origin, direction, &settings).g)
    };
    (0..count).into_par_iter().map(mean).collect()
}

/// A pinhole at `position` that looks at `target`.
pub fn look_at(position: Vec3, target: Vec3) -> Placed<Camera> {
    let up = if (target - position).normalize().y.abs() > 0.9 {
        Vec3::Z
    } else {
        Vec3::Y
    };
    let mut camera = Camera::look_at(Vec3::ZERO, target - position, up, 0.7).expect("a view");
    camera.projection = Projection::Perspective {
        vertical_fov_radians: 0.7,
    };
    Placed {
        name: String::new(),
        origin: position.as_dvec3(),
        item: camera,
    }
}

/// Renders the whole film.
pub fn picture(scene: &Scene, camera: &Placed<Camera>, settings: &Settings) -> Film {
    let prepared = prepare(scene, Builder::default()).scene;
    picture_of(&prepared, camera, settings)
}

/// As [`picture`], of a scene that is prepared already.
pub fn picture_of(prepared: &PreparedScene, camera: &Placed<Camera>, settings: &Settings) -> Film {
    let job = Job {
        scene: prepared,
        camera: prepared.camera(camera),
        settings,
        crop: Rect::full(settings.size),
        layers: Vec::new(),
    };
    render(&job, &AtomicBool::new(false), &|_| {})
}

/// The bits of a picture.
pub fn bits(film: &Film) -> Vec<[u32; 3]> {
    film.means()
        .iter()
        .map(|c| c.channels().map(f32::to_bits))
        .collect()
}

/// Root of the mean squared difference of two pictures over that of the first.
pub fn relative_rmse(expected: &Film, got: &Film) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for (a, b) in expected.means().iter().zip(got.means()) {
        for (a, b) in a.channels().into_iter().zip(b.channels()) {
            difference += f64::from(a - b).powi(2);
            size += f64::from(a).powi(2);
        }
    }
    (difference / size).sqrt()
}
