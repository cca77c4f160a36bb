//! L7: under a uniform sky nothing is brighter than the sky.

use rayon::prelude::*;

use crate::color::Rgb;
use crate::material::Material;
use crate::math::Vec3;
use crate::sampling::Pattern;
use crate::scene::{Background, Scene, Settings};
use crate::stress::check::deviation;
use crate::stress::floor::{paths, settings};
use crate::stress::scattering::{
    ELEVATIONS, ROUGHNESSES, albedo, bsdf, coated, energy_made, glossy, wo,
};
use crate::stress::scenes::{add_box, add_quad, means, radiance};
use crate::stress::{Check, Curve, Effort, Sweep};
use crate::texture::TexturedRgb;

/// What rounding in single precision may add to 1.
const ROUNDING: f64 = 1e-5;

/// Matte walls, rendered materials, and albedos.
pub fn run(effort: Effort) -> Vec<Check> {
    vec![
        Check::at_most(
            "matte walls of albedo 1 in radiance 1: error",
            matte(),
            ROUNDING,
        )
        .noted("whitted adds what comes from everywhere as one term"),
        paths_in_a_box(effort),
        Check::at_most(
            "path, white boxes under a sky of 1: error",
            paths_under_a_sky(),
            ROUNDING,
        ),
        rendered(),
        made("Phong, exponent 0..1e8: energy made", phong_albedos(effort)),
        made(
            "metal, dielectric, glass, roughness 0..1: energy made",
            coat_albedos(effort),
        ),
        lost(),
    ]
}

fn sky() -> Background {
    Background {
        radiance: Rgb::WHITE,
        ambient: Rgb::WHITE,
    }
}

fn deep() -> Settings {
    Settings {
        max_depth: Some(64),
        ..settings(1, Pattern::Sobol)
    }
}

/// The inside of a white box.
fn matte() -> f64 {
    let mut scene = Scene::default();
    let white = Material::matte("white", Rgb::WHITE);
    add_box(&mut scene, Vec3::splat(-1.0), Vec3::splat(1.0), white);
    scene.background = sky();
    let errors = (0..100).map(|i| {
        let angle = 2.4 * i as f32;
        let way = Vec3::new(angle.cos(), 0.02 * i as f32 - 1.0, angle.sin());
        f64::from((radiance(&scene, Vec3::splat(0.1), way, &deep()).g - 1.0).abs())
    });
    errors.fold(0.0, f64::max)
}

/// Inside of matte walls that give off what they take, after so many bounces that none is missing.
fn paths_in_a_box(effort: Effort) -> Check {
    let settings = Settings {
        max_depth: Some(1024),
        ..paths(Pattern::Random)
    };
    let worst = [0.0f32, 0.5, 0.9, 0.99].map(|albedo| {
        let mut wall = Material::matte("wall", Rgb::splat(albedo));
        wall.emission = TexturedRgb::constant(Rgb::splat(1.0 - albedo));
        let mut scene = Scene::default();
        add_box(&mut scene, Vec3::splat(-1.0), Vec3::splat(1.0), wall);
        let eye = Vec3::new(0.1, 0.2, -0.3);
        let means = means(
            &scene,
            eye,
            Vec3::new(0.4, -0.3, 0.8),
            &settings,
            effort.pick(64, 1024),
        );
        deviation(&means, 1.0)
    });
    let worst = worst.into_iter().fold(0.0, f64::max);
    Check::at_most(
        "path, closed box, albedo 0..0.99, emission 1 - albedo: error in standard errors",
        worst,
        4.0,
    )
}

/// White boxes in a white sky: every path ends in the sky.
fn paths_under_a_sky() -> f64 {
    let mut scene = Scene::default();
    let white = || Material::matte("white", Rgb::WHITE);
    add_box(
        &mut scene,
        Vec3::new(-1.0, -0.2, -1.0),
        Vec3::new(1.0, 0.0, 1.0),
        white(),
    );
    add_box(
        &mut scene,
        Vec3::new(-0.3, 0.0, -0.3),
        Vec3::new(0.3, 0.9, 0.2),
        white(),
    );
    scene.background.radiance = Rgb::WHITE;
    let settings = Settings {
        max_depth: Some(1024),
        ..paths(Pattern::Sobol)
    };
    let errors = (0..50).map(|i| {
        let angle = 2.4 * i as f32;
        let eye = Vec3::new(3.0 * angle.cos(), 0.5 + 0.04 * i as f32, 3.0 * angle.sin());
        f64::from((radiance(&scene, eye, 0.4 * Vec3::Y - eye, &settings).g - 1.0).abs())
    });
    errors.fold(0.0, f64::max)
}

/// Squares of every coat, as a picture shows them.
fn rendered() -> Check {
    let curve = |(metallic, transmission): (f32, f32)| {
        let points = ROUGHNESSES.map(|roughness| {
            let mut scene = Scene::default();
            let material = coated(metallic, roughness, transmission, 1.5);
            add_quad(&mut scene, Vec3::ZERO, Vec3::X, Vec3::Y, material);
            scene.background = sky();
            let excess = ELEVATIONS.map(|degrees| {
                let eye = *wo(degrees);
                f64::from(radiance(&scene, eye, -eye, &deep()).max_channel()) - 1.0
            });
            (f64::from(roughness), excess.into_iter().fold(0.0, f64::max))
        });
        Curve::new(
            format!("metallic {metallic}, transmission {transmission}"),
            points.into(),
        )
    };
    let curves = [
        (0.0, 0.0),
        (0.5, 0.0),
        (1.0, 0.0),
        (0.0, 0.5),
        (0.0, 1.0),
        (0.5, 0.5),
    ]
    .map(curve);
    let sweep = Sweep::several("roughness", "radiance above that of the sky", curves.into());
    Check::worst(
        "rendered coats under a sky of 1: radiance above 1",
        ROUNDING,
        sweep,
    )
}

/// The most that any view certainly gets above 1.
fn most_made(material: &Material, effort: Effort) -> f64 {
    let bsdf = bsdf(material);
    let views = ELEVATIONS.iter().rev().step_by(effort.pick(3, 1));
    let made = views.map(|&degrees| energy_made(&bsdf, wo(degrees)));
    made.fold(0.0, f64::max)
}

fn phong_albedos(effort: Effort) -> Sweep {
    let exponents: Vec<f32> = (0..=16).map(|k| 10f32.powf(0.5 * k as f32)).collect();
    let point = |&n: &f32| (f64::from(n), most_made(&glossy(1.0, n), effort));
    let points = exponents.par_iter().map(point).collect();
    Sweep::of("exponent", "energy made", points)
}

fn coat_albedos(effort: Effort) -> Sweep {
    let curves = [0.0, 1.0, 1.5, 100.0].into_par_iter().flat_map(|index| {
        [0.0, 0.5, 1.0].into_par_iter().map(move |metallic| {
            let points = ROUGHNESSES.map(|roughness| {
                let coat = coated(metallic, roughness, 0.0, index);
                (f64::from(roughness), most_made(&coat, effort))
            });
            Curve::new(format!("index {index}, metallic {metallic}"), points.into())
        })
    });
    Sweep::several("roughness", "energy made", curves.collect())
}

fn made(what: &str, sweep: Sweep) -> Check {
    Check::worst(what, ROUNDING, sweep)
}

/// What a white metal loses, since light that meets two facets is left out.
fn lost() -> Check {
    let points = ROUGHNESSES[1..].iter().map(|&roughness| {
        let bsdf = bsdf(&coated(1.0, roughness, 0.0, 1.5));
        (f64::from(roughness), 1.0 - albedo(&bsdf, wo(60.0)))
    });
    let sweep = Sweep::of("roughness", "energy lost", points.collect());
    let all = sweep.curves[0].points.iter();
    let text: Vec<String> = all
        .map(|(r, loss)| format!("{r:.2}: {:.1} %", 100.0 * loss))
        .collect();
    Check::worst(
        "white metal, 60 degrees: share of the energy lost",
        1.0,
        sweep,
    )
    .noted(format!("lost by roughness: {}", text.join(", ")))
}
