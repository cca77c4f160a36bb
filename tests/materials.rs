//! Textures, normal maps, sides and opacity of glTF materials, seen in whole renders.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::f32::consts::PI;

use common::build::*;
use common::floor::*;
use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::integrate::{FirstSurface, ViewKind};
use halfshade::material::{AlphaMode, Material, MaterialId, NormalMap};
use halfshade::math::{Affine2, DAffine3, DVec3, Ray, Vec2, Vec3};
use halfshade::prepare::{prepare, prepare_within};
use halfshade::sampling::Pattern;
use halfshade::scene::{Instance, Mesh, MeshId, Scene, Settings};
use halfshade::texture::{TexturedRgb, TexturedScalar, Wrap};

fn once() -> Settings {
    settings(1, Pattern::Sobol)
}

/// A rough dielectric of glTF.
fn plaster() -> Material {
    metallic_roughness(|m| {
        m.base_color = TexturedRgb::constant(Rgb::splat(RHO));
        m.metallic = TexturedScalar::constant(0.0);
    })
}

/// The square from (-1, 0, -1) to (1, 0, 1) that faces +y. Its texture coordinates go from 0 to 1
/// along x and z, or along -x and z.
fn tile(is_mirrored: bool) -> Mesh {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0f32)];
    let positions = corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
    let uvs = corners.map(|(x, z)| {
        let u = if is_mirrored { -x } else { x };
        Vec2::new(0.5 + 0.5 * u, 0.5 + 0.5 * z)
    });
    Mesh::new("tile", positions, vec![[0, 1, 2], [0, 2, 3]])
        .unwrap()
        .with_uv_set(uvs.to_vec())
        .unwrap()
}

fn add_instance(scene: &mut Scene, mesh: Mesh, material: Material, transform: DAffine3) {
    scene.instances.push(Instance {
        name: String::new(),
        mesh: MeshId(scene.meshes.len() as u32),
        material: MaterialId(scene.materials.len() as u32),
        transform,
    });
    scene.meshes.push(mesh);
    scene.materials.push(material);
}

/// Where a tile's tangents come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tangents {
    File,
    Uvs,
    MirroredUvs,
    FileOnMirroredUvs,
}

/// Radiance of the middle of a tile whose normals a map bends to `texel`, with a light towards
/// `light`; all of it taken to the world by `transform`.
fn bent(
    texel: [f32; 4],
    tangents: Tangents,
    transform: DAffine3,
    light: Vec3,
    is_shared: bool,
) -> f32 {
    let mut scene = Scene::default();
    let mut material = plaster();
    material.normal_map = Some(NormalMap {
        texture: add_texture(&mut scene, 1, vec![texel]),
        scale: 1.0,
        is_height: false,
    });
    let mesh = match tangents {
        Tangents::Uvs => tile(false),
        Tangents::MirroredUvs => tile(true),
        Tangents::File => {
            let tangents = vec![[1.0, 0.0, 0.0, 1.0]; 4];
            tile(false).with_tangents(tangents).unwrap()
        }
        Tangents::FileOnMirroredUvs => {
            let tangents = vec![[-1.0, 0.0, 0.0, -1.0]; 4];
            tile(true).with_tangents(tangents).unwrap()
        }
    };
    add_instance(&mut scene, mesh, material, transform);
    if is_shared {
        let mut other = scene.instances[0].clone();
        other.transform = DAffine3::from_translation(DVec3::X * 20.0) * other.transform;
        scene.instances.push(other);
    }
    let to_world = |p: Vec3| transform.transform_point3(p.as_dvec3()).as_vec3();
    let position = to_world(2.0 * light);
    add_light(&mut scene, point_light(position, 10.0, 0.0, 1));
    let (eye, middle) = (to_world(Vec3::new(0.0, 3.0, 0.0)), to_world(Vec3::ZERO));
    let budget = if is_shared { 0 } else { u64::MAX };
    let prepared = prepare_within(&scene, Builder::default(), budget).scene;
    radiance_in(&prepared, eye, middle - eye, &once()).g
}

/// Red points along u, green against v, since v grows downwards; on mirrored instances too.
#[test]
fn normal_maps_bend_to_the_side_that_the_file_says() {
    let transforms = [
        DAffine3::IDENTITY,
        DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
        DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)),
        DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)),
        DAffine3::from_scale(DVec3::splat(-1.0)),
        DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 1.1)
            * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
    ];
    let slope = 0.5 + 0.5f32.sqrt() * 0.5;
    let (red, green) = ([slope, 0.5, slope, 1.0], [0.5, slope, slope, 1.0]);
    let diagonal = |x: f32, z: f32| Vec3::new(x, 1.0, z).normalize();
    for (tangents, u) in [
        (Tangents::File, 1.0),
        (Tangents::Uvs, 1.0),
        (Tangents::MirroredUvs, -1.0),
        (Tangents::FileOnMirroredUvs, -1.0),
    ] {
        for (texel, toward) in [(red, diagonal(u, 0.0)), (green, diagonal(0.0, -1.0))] {
            let away = toward * Vec3::new(-1.0, 1.0, -1.0);
            let usual = bent(texel, tangents, transforms[0], toward, false);
            // 1 to (almost) 0 by the cosine of the bent normal.
            assert!(usual > 0.3, "{tangents:?}: {usual}");
            for transform in transforms {
                for is_shared in [false, true] {
                    let what = format!("{tangents:?}, {texel:?}, {transform:?}, {is_shared}");
                    let facing = bent(texel, tangents, transform, toward, is_shared);
                    assert_close(facing, usual, 1e-4, &what);
                    let averted = bent(texel, tangents, transform, away, is_shared);
                    assert!(averted < 1e-3 * usual, "{what}: {averted} {usual}");
                }
            }
        }
    }
}

/// A red, a green and a blue pixel side by side, through the view of base colours.
#[test]
fn texture_coordinates_are_transformed_and_wrapped() {
    let [r, g, b] = [
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [0.0, 0.0, 1.0, 1.0],
    ];
    // The middles of six sixths of the tile.
    let us = [0.5, 1.5, 2.5, 3.5, 4.5, 5.5f32].map(|sixths| sixths / 6.0);
    let double = Affine2::from_scale(Vec2::new(2.0, 1.0));
    let moved = |by: f32| Affine2::from_translation(Vec2::new(by, 0.0));
    for (wrap, transform, expected) in [
        (Wrap::Repeat, Affine2::IDENTITY, [r, r, g, g, b, b]),
        (Wrap::Repeat, double, [r, g, b, r, g, b]),
        (Wrap::MirroredRepeat, double, [r, g, b, b, g, r]),
        (Wrap::ClampToEdge, double, [r, g, b, b, b, b]),
        (Wrap::Repeat, moved(1.0 / 3.0), [g, g, b, b, r, r]),
        (Wrap::ClampToEdge, moved(-1.0 / 3.0), [r, r, r, r, g, g]),
        (Wrap::MirroredRepeat, moved(-1.0 / 3.0), [r, r, r, r, g, g]),
        (Wrap::MirroredRepeat, moved(-2.0 / 3.0), [g, g, r, r, r, r]),
        (Wrap::Repeat, moved(-1.0 / 3.0) * double, [b, r, g, b, r, g]),
    ] {
        let mut scene = Scene::default();
        let mut texture = add_texture(&mut scene, 3, vec![r, g, b]);
        scene.textures[0].wrap[0] = wrap;
        texture.transform = transform;
        let material = metallic_roughness(|m| m.base_color.texture = Some(texture));
        add_instance(&mut scene, tile(false), material, DAffine3::IDENTITY);
        let prepared = prepare(&scene, Builder::default()).scene;
        let got = us.map(|u| {
            let eye = DVec3::new(2.0 * f64::from(u) - 1.0, 1.0, 0.1);
            let ray = Ray::new(prepared.placement.point(eye), -Vec3::Y);
            FirstSurface::along(&prepared, &ray).value(ViewKind::Albedo)
        });
        let expected = expected.map(|[r, g, b, _]| [r, g, b]);
        assert_eq!(got, expected, "{wrap:?} {transform:?}");
    }
}

/// Irradiance of the floor's middle under a square of `material` at height 1, and what a camera
/// above the square sees straight below; the light is above both.
fn under(material: Option<Material>, is_facing_down: bool) -> (f32, f32) {
    let mut scene = plane();
    if let Some(material) = material {
        let (u, v) = if is_facing_down {
            (Vec3::X, Vec3::Z)
        } else {
            (Vec3::Z, Vec3::X)
        };
        add_quad(&mut scene, Vec3::Y, u * 0.5, v * 0.5, material);
    }
    add_light(&mut scene, point_light(Vec3::Y * 3.0, 10.0, 0.0, 1));
    let side = Vec3::new(2.0, 0.5, 0.0);
    let floor = radiance(&scene, side, -side, &once()).g * PI / RHO;
    let eye = Vec3::Y * 2.0;
    (floor, radiance(&scene, eye, -eye, &once()).g)
}

fn with_opacity(opacity: f32, alpha_mode: AlphaMode) -> Material {
    Material {
        alpha_mode,
        opacity: TexturedScalar::constant(opacity),
        ..plaster()
    }
}

#[test]
fn a_single_sided_surface_is_seen_from_its_front_and_shades_with_both() {
    let single = Material {
        is_double_sided: false,
        ..plaster()
    };
    let (lit, bare) = under(None, false);
    assert!(lit > 1.0 && bare > 0.1);
    let (floor, seen) = under(Some(single.clone()), true);
    assert_eq!(floor, 0.0, "its back casts a shadow");
    assert_eq!(seen, 0.0, "through its back the shaded floor is seen");
    let (floor, seen) = under(Some(single), false);
    assert_eq!(floor, 0.0, "its front casts a shadow");
    assert!(
        seen > bare,
        "its front is nearer to the light: {seen} {bare}"
    );
    let (floor, seen_back) = under(Some(plaster()), true);
    assert_eq!(floor, 0.0);
    assert_close(
        seen_back,
        seen,
        1e-6,
        "both sides of a double-sided surface",
    );
}

#[test]
fn masked_out_surfaces_are_not_there() {
    let bare = under(None, false);
    let solid = under(Some(plaster()), false);
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    for opacity in [0.0, 0.25, 0.499] {
        assert_eq!(under(Some(with_opacity(opacity, mask)), false), bare);
    }
    for opacity in [0.5, 0.75, 1.0] {
        assert_eq!(under(Some(with_opacity(opacity, mask)), false), solid);
    }
    let opaque = with_opacity(0.25, AlphaMode::Opaque);
    assert_eq!(under(Some(opaque), false), solid, "opacity is not read");
}

/// The share of what is behind that shows, and of the light that falls through.
#[test]
fn blended_surfaces_let_their_share_through() {
    let (lit, bare) = under(None, false);
    let (_, solid) = under(Some(plaster()), false);
    for opacity in [0.0, 0.25, 0.75, 1.0f32] {
        let (floor, seen) = under(Some(with_opacity(opacity, AlphaMode::Blend)), false);
        let through = 1.0 - opacity;
        let what = format!("opacity {opacity}");
        assert!(
            (floor - through * lit).abs() <= 1e-6 * lit,
            "{what}: {floor} {lit}"
        );
        // The floor below is seen through the square, and is lit through it too.
        let expected = opacity * solid + through * through * bare;
        assert_close(seen, expected, 1e-5, &what);
    }
}

/// Opacity is that of the texture's own alpha, also in shadows and from below.
#[test]
fn a_texture_cuts_holes() {
    for (alpha_mode, expected) in [
        (AlphaMode::Mask { cutoff: 0.5 }, [1.0, 1.0, 0.0]),
        (AlphaMode::Blend, [1.0, 0.75, 0.0]),
    ] {
        let mut scene = plane();
        let pixels = [0.0, 0.25, 1.0].map(|alpha| [1.0, 1.0, 1.0, alpha]);
        let mut material = with_opacity(1.0, alpha_mode);
        material.opacity.texture = Some(add_texture(&mut scene, 3, pixels.to_vec()));
        material.opacity.channel = 3;
        let up = DAffine3::from_translation(DVec3::Y);
        add_instance(&mut scene, tile(false), material, up);
        add_light(&mut scene, point_light(Vec3::Y * 1e3, 1e6, 0.0, 1));
        for (x, expected) in [-0.66, 0.0, 0.66].into_iter().zip(expected) {
            let floor = Vec3::new(x, 0.0, 0.1);
            let side = Vec3::new(3.0, 0.5, 0.0);
            let got = radiance(&scene, side, floor - side, &once()).g * PI / RHO;
            assert!((got - expected).abs() < 1e-3, "{alpha_mode:?}, {x}: {got}");
        }
    }
}
