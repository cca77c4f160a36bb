//! Materials of every kind of lobe, alone and together.

use halfshade::color::Rgb;
use halfshade::material::{Material, MetallicRoughness, Phong, Surface};
use halfshade::texture::{TexturedRgb, TexturedScalar};

/// A material, and how it is met.
pub struct Case {
    pub name: &'static str,
    pub material: Material,
    /// Index of the side beyond over that of the viewer's.
    pub eta: f32,
    /// Whether its lobes are wide enough for a grid of bins over the sphere.
    pub is_wide: bool,
}

fn case(name: &'static str, material: Material) -> Case {
    Case {
        name,
        material,
        eta: 1.5,
        is_wide: true,
    }
}

fn narrow(name: &'static str, material: Material) -> Case {
    Case {
        is_wide: false,
        ..case(name, material)
    }
}

fn gltf(edit: impl FnOnce(&mut MetallicRoughness)) -> Material {
    let mut surface = MetallicRoughness::default();
    edit(&mut surface);
    Material {
        surface: Surface::MetallicRoughness(Box::new(surface)),
        ..Material::matte("", Rgb::BLACK)
    }
}

fn phong(edit: impl FnOnce(&mut Phong)) -> Material {
    let mut phong = Phong::matte(Rgb::BLACK);
    edit(&mut phong);
    Material {
        surface: Surface::Phong(phong),
        ..Material::matte("", Rgb::BLACK)
    }
}

fn metal(roughness: f32) -> Material {
    gltf(|m| m.roughness = scalar(roughness))
}

fn plastic(roughness: f32) -> Material {
    gltf(|m| {
        m.metallic = scalar(0.0);
        m.roughness = scalar(roughness);
    })
}

fn scalar(value: f32) -> TexturedScalar {
    TexturedScalar::constant(value)
}

fn rgb(r: f32, g: f32, b: f32) -> TexturedRgb {
    TexturedRgb::constant(Rgb::new(r, g, b))
}

/// All of them.
pub fn cases() -> Vec<Case> {
    let glossy = |n: f32| {
        phong(|p| {
            p.diffuse = rgb(0.5, 0.3, 0.1);
            p.specular = rgb(0.4, 0.4, 0.4);
            p.exponent = scalar(n);
        })
    };
    let mirror = phong(|p| {
        p.diffuse = rgb(0.2, 0.2, 0.2);
        p.reflect = Rgb::splat(0.4);
        p.transmit = Rgb::splat(0.4);
        p.index_of_refraction = 1.5;
    });
    vec![
        case("matte", Material::matte("", Rgb::new(1.0, 0.5, 0.2))),
        case("Phong 0", glossy(0.0)),
        case("Phong 20", glossy(20.0)),
        narrow("Phong 1e6", glossy(1e6)),
        case("mirror and glass over matte", mirror),
        narrow("mirror of metal", metal(0.0)),
        narrow("smooth metal", metal(0.05)),
        case("metal 0.3", metal(0.3)),
        case("metal 0.6", metal(0.6)),
        case("metal 1", metal(1.0)),
        narrow("smooth plastic", plastic(0.0)),
        case("plastic 0.4", plastic(0.4)),
        case("plastic 1", plastic(1.0)),
    ]
}
