//! Materials of every kind of lobe, alone and together.

use halfshade::color::Rgb;
use halfshade::material::{
    Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, Material, MetallicRoughness, Phong,
    Sheen, Surface,
};
use halfshade::texture::{TexturedRgb, TexturedScalar};

/// A material, and how it is met.
pub struct Case {
    pub name: &'static str,
    pub material: Material,
    /// Whether it is seen from the inside of a body.
    pub is_inside: bool,
    /// Whether its lobes are wide enough for a grid of bins over the sphere.
    pub is_wide: bool,
}

fn case(name: &'static str, material: Material) -> Case {
    Case {
        name,
        material,
        is_inside: false,
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

pub fn phong(edit: impl FnOnce(&mut Phong)) -> Material {
    let mut phong = Phong::matte(Rgb::BLACK);
    edit(&mut phong);
    Material {
        surface: Surface::Phong(phong),
        ..Material::matte("", Rgb::BLACK)
    }
}

pub fn metal(roughness: f32) -> Material {
    gltf(|m| m.roughness = scalar(roughness))
}

pub fn plastic(roughness: f32) -> Material {
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

fn inside(name: &'static str, material: Material) -> Case {
    Case {
        is_inside: true,
        ..case(name, material)
    }
}

/// A white pane, or the border of a white body.
pub fn glass(roughness: f32, is_body: bool, dispersion: f32) -> Material {
    gltf(|m| {
        m.metallic = scalar(0.0);
        m.roughness = scalar(roughness);
        m.transmission = scalar(1.0);
        m.thickness = scalar(f32::from(u8::from(is_body)));
        m.dispersion = dispersion;
    })
}

/// The border of a white body of an index.
pub fn body(roughness: f32, index: f32) -> Material {
    with(glass(roughness, true, 0.0), |m| {
        m.index_of_refraction = index;
    })
}

fn coated(base: Material, share: f32, roughness: f32) -> Material {
    with(base, |m| {
        m.clearcoat = Some(Clearcoat {
            factor: scalar(share),
            roughness: scalar(roughness),
            normal_map: None,
        });
    })
}

fn cloth(base: Material, roughness: f32) -> Material {
    with(base, |m| {
        m.sheen = Some(Sheen {
            color: rgb(1.0, 0.8, 0.5),
            roughness: scalar(roughness),
        });
    })
}

fn brushed(roughness: f32, strength: f32) -> Material {
    with(metal(roughness), |m| {
        m.anisotropy = Some(Anisotropy {
            strength,
            rotation: 0.0,
            texture: None,
        });
    })
}

fn film(base: Material, nanometres: f32) -> Material {
    with(base, |m| {
        m.iridescence = Some(Iridescence {
            factor: scalar(1.0),
            thickness: [nanometres; 2],
            ..Iridescence::default()
        });
    })
}

fn leaf(roughness: f32) -> Material {
    with(plastic(roughness), |m| {
        m.diffuse_transmission = Some(DiffuseTransmission {
            factor: scalar(0.5),
            color: rgb(0.5, 1.0, 0.3),
        });
    })
}

fn with(mut material: Material, edit: impl FnOnce(&mut MetallicRoughness)) -> Material {
    if let Surface::MetallicRoughness(surface) = &mut material.surface {
        edit(surface);
    }
    material
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
        case(
            "colours beyond 1",
            phong(|p| {
                p.diffuse = rgb(0.8, 0.8, 0.2);
                p.specular = rgb(0.5, 0.5, 0.5);
                p.exponent = scalar(10.0);
            }),
        ),
        case(
            "glass with a highlight",
            phong(|p| {
                p.specular = rgb(0.04, 0.04, 0.04);
                p.exponent = scalar(40.0);
                p.transmit = Rgb::WHITE;
                p.index_of_refraction = 1.5;
            }),
        ),
        narrow("mirror of metal", metal(0.0)),
        narrow("smooth metal", metal(0.05)),
        case("metal 0.3", metal(0.3)),
        case("metal 0.6", metal(0.6)),
        case("metal 1", metal(1.0)),
        narrow("smooth plastic", plastic(0.0)),
        case("plastic 0.4", plastic(0.4)),
        case("plastic 1", plastic(1.0)),
        narrow("smooth pane", glass(0.0, false, 0.0)),
        case("rough pane", glass(0.5, false, 0.0)),
        case("very rough pane", glass(1.0, false, 0.0)),
        narrow("smooth body", glass(0.0, true, 0.0)),
        narrow("almost smooth body", glass(0.1, true, 0.0)),
        case("rough body", glass(0.5, true, 0.0)),
        case("very rough body", glass(1.0, true, 0.0)),
        inside("rough body from inside", glass(0.5, true, 0.0)),
        inside("very rough body from inside", glass(1.0, true, 0.0)),
        case("very rough water", body(1.0, 1.33)),
        inside("rough water from inside", body(0.7, 1.33)),
        case("very rough diamond", body(1.0, 2.4)),
        inside("very rough diamond from inside", body(1.0, 2.4)),
        case(
            "rough body that hardly mirrors",
            with(body(0.8, 1.5), |m| m.specular = scalar(0.1)),
        ),
        inside(
            "rough body of coloured specular from inside",
            with(body(0.8, 1.5), |m| m.specular_color = rgb(3.0, 1.0, 0.0)),
        ),
        case(
            "brushed body",
            with(body(0.4, 1.5), |m| {
                m.anisotropy = Some(Anisotropy {
                    strength: 0.8,
                    rotation: 0.0,
                    texture: None,
                });
            }),
        ),
        narrow("smooth prism", glass(0.0, true, 3.0)),
        case("rough prism", glass(0.5, true, 3.0)),
        inside("rough prism from inside", glass(0.5, true, 3.0)),
        inside("very rough prism from inside", glass(1.0, true, 3.0)),
        case(
            "half glass",
            with(glass(0.5, true, 0.0), |m| {
                m.transmission = scalar(0.6);
                m.metallic = scalar(0.3);
            }),
        ),
        narrow("smooth coat", coated(plastic(0.5), 1.0, 0.0)),
        case("coat on plastic", coated(plastic(0.5), 1.0, 0.3)),
        case("coat on metal", coated(metal(0.7), 0.7, 0.5)),
        case("coat on cloth", coated(cloth(plastic(0.8), 0.5), 1.0, 0.4)),
        case("cloth 1", cloth(plastic(1.0), 1.0)),
        case("cloth 0.3", cloth(plastic(1.0), 0.3)),
        case("cloth 0.1", cloth(plastic(0.6), 0.1)),
        case("brushed", brushed(0.3, 0.7)),
        case("very brushed", brushed(0.3, 1.0)),
        case("bubble 200 nm", film(plastic(0.4), 200.0)),
        case("bubble 400 nm", film(plastic(0.4), 400.0)),
        case(
            "tempered steel",
            film(
                with(metal(0.4), |m| m.base_color = rgb(0.6, 0.6, 0.6)),
                320.0,
            ),
        ),
        case("film on glass", film(glass(0.4, true, 0.0), 500.0)),
        case("film on rough glass", film(glass(1.0, true, 0.0), 200.0)),
        inside(
            "film on rough glass from inside",
            film(glass(1.0, true, 0.0), 200.0),
        ),
        narrow("film on smooth glass", film(glass(0.0, true, 0.0), 500.0)),
        case("leaf", leaf(0.5)),
        case("coated leaf", coated(cloth(leaf(0.6), 0.5), 0.5, 0.4)),
        case(
            "colour and strength of specular",
            with(plastic(0.4), |m| {
                m.specular = scalar(0.6);
                m.specular_color = rgb(3.0, 1.0, 20.0);
            }),
        ),
        case(
            "everything mirrored",
            with(plastic(0.4), |m| m.index_of_refraction = 0.0),
        ),
    ]
}
