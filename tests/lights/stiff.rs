//! Limits and extremes: vanishing and huge lights, scaled scenes (numerics.md L5, L6, L11, G4).

use halfshade::color::Rgb;
use halfshade::light::{
    DiskLight, DistantLight, Falloff, Light, LightSample, PointLight, RectangleLight, ShadowEnd,
    SphereLight, SpotLight,
};
use halfshade::math::{Ray, UnitVec3, Vec2, Vec3};

use crate::density::cases;
use crate::{disk, distant, end, point, random, rectangle, sphere, spot, unit};

/// Everything about a sample, to compare bit for bit.
fn bits(sample: Option<LightSample>) -> Option<[u32; 9]> {
    sample.map(|s| {
        let end = match s.shadow {
            ShadowEnd::Point(v) => v,
            ShadowEnd::Direction(v) => v.get(),
        };
        let w = s.weight.channels();
        [
            s.wi.x, s.wi.y, s.wi.z, w[0], w[1], w[2], end.x, end.y, end.z,
        ]
        .map(f32::to_bits)
    })
}

/// numerics.md L5: soft lights become the hard one, and a radius of 0 is it, bit for bit.
#[test]
fn the_limit_of_a_vanishing_radius_is_the_hard_light() {
    let position = Vec3::new(0.5, 3.0, -0.25);
    let makers: [&dyn Fn(f32) -> Light; 3] = [
        &|r| Light::Point(point(position, r)),
        &|r| Light::Spot(spot(position, r)),
        &|r| Light::Distant(distant(r)),
    ];
    for make in makers {
        let hard = make(0.0);
        assert!(hard.is_delta());
        assert_eq!(hard.samples(), 1);
        let first = hard.sample(Vec3::ZERO, Vec2::ZERO).unwrap();
        for u in random(1000, 1) {
            assert_eq!(bits(hard.sample(Vec3::ZERO, u)), bits(Some(first)));
        }
        for k in 0..=30 {
            let radius = 10.0_f32.powi(-k);
            let soft = make(radius);
            assert!(!soft.is_delta());
            assert_eq!(soft.samples(), 4);
            for u in random(100, 2) {
                let s = soft.sample(Vec3::ZERO, u).unwrap();
                let moved = (end(&s) - end(&first)).length();
                assert!(moved <= f64::from(radius) + 1e-6, "1e-{k}: {moved}");
                let change = (s.weight.r / first.weight.r - 1.0).abs();
                assert!(change <= radius * radius + 1e-6, "1e-{k}: {change}");
            }
        }
    }
    // Area lights fade away with their area.
    for k in 0..=30 {
        let radius = 10.0_f32.powi(-k);
        for light in [
            Light::Disk(disk(position, -UnitVec3::Y, radius)),
            Light::Sphere(sphere(position, radius)),
            Light::Rectangle(rectangle(position, Vec3::X * radius, Vec3::Z * radius)),
        ] {
            for u in random(100, 2) {
                // Below the smallest f32, nothing is left.
                let weight = light.sample(Vec3::ZERO, u).map_or(0.0, |s| s.weight.r);
                assert!(
                    (0.0..=radius * radius).contains(&weight),
                    "1e-{k}: {weight}"
                );
            }
        }
    }
    for light in [
        Light::Disk(disk(position, -UnitVec3::Y, 0.0)),
        Light::Sphere(sphere(position, 0.0)),
        Light::Rectangle(rectangle(position, Vec3::X, Vec3::X)),
    ] {
        assert!(light.is_delta());
        assert!(light.sample(Vec3::ZERO, Vec2::splat(0.3)).is_none());
        assert!(light.met(&Ray::new(Vec3::ZERO, position)).is_none());
    }
}

/// Lights of every kind at every size and brightness.
pub fn stiff_lights() -> Vec<Light> {
    let mut lights = Vec::new();
    let down = unit(0.1, -1.0, 0.2);
    for position in [
        Vec3::ZERO,
        Vec3::new(1.0, 2.0, 3.0),
        Vec3::splat(1e-30),
        Vec3::splat(-3e37),
    ] {
        for radius in [0.0, 1e-38, 1e-30, 1e-10, 1.0, 1e10, 1e30, 3e38] {
            for brightness in [1e-30, 1.0, 1e30].map(Rgb::splat) {
                let half = |v: Vec3| v * radius;
                lights.extend([
                    Light::Point(PointLight {
                        intensity: brightness,
                        ..point(position, radius)
                    }),
                    Light::Spot(SpotLight {
                        intensity: brightness,
                        ..spot(position, radius)
                    }),
                    Light::Distant(DistantLight {
                        irradiance: brightness,
                        ..distant(radius)
                    }),
                    Light::Disk(DiskLight {
                        radiance: brightness,
                        ..disk(position, down, radius)
                    }),
                    Light::Sphere(SphereLight {
                        radiance: brightness,
                        ..sphere(position, radius)
                    }),
                    Light::Rectangle(RectangleLight {
                        radiance: brightness,
                        ..rectangle(position, half(Vec3::X), half(Vec3::Z))
                    }),
                    Light::Rectangle(RectangleLight {
                        radiance: brightness,
                        ..rectangle(position, half(Vec3::ONE), half(Vec3::Z) * 1e-9)
                    }),
                ]);
            }
        }
    }
    lights
}

/// numerics.md L6 and L11.
#[test]
fn every_sample_is_finite_however_stiff_the_scene() {
    let mut points = vec![
        Vec3::ZERO,
        Vec3::new(1.0, 2.0, 3.0),
        Vec3::new(1.0, -2.0, 3.0),
    ];
    for scale in [1e-45, 1e-30, 1e-7, 1.0, 1e7, 1e30, 3e38] {
        points.extend([Vec3::X, Vec3::NEG_Y, Vec3::new(0.3, -0.8, 0.5)].map(|v| v * scale));
    }
    points.push(Vec3::new(1.0, 2.0_f32.next_down(), 3.0));
    let corners = [0.0, 0.25, 0.5, 1.0_f32.next_down()];
    let mut taken = 0;
    for light in stiff_lights() {
        for &point in &points {
            for (a, b) in corners.iter().flat_map(|&a| corners.map(|b| (a, b))) {
                let Some(s) = light.sample(point, Vec2::new(a, b)) else {
                    continue;
                };
                taken += 1;
                let what = || format!("{light:?} from {point}: {s:?}");
                assert!(s.weight.is_finite() && s.weight.r > 0.0, "{}", what());
                assert!((s.wi.length() - 1.0).abs() < 1e-5, "{}", what());
                assert!(end(&s).is_finite(), "{}", what());
            }
            let ray = Ray::new(point, Vec3::new(0.1, 1.0, -0.2));
            let met = light.met(&ray);
            assert!(
                met.is_none_or(|(t, _)| t.is_finite() && t > 0.0),
                "{light:?} {met:?}"
            );
        }
    }
    assert!(taken > 50_000, "only {taken} samples to look at");
}

#[test]
fn a_point_at_the_very_light_gets_none_from_it() {
    let position = Vec3::new(1.0, 2.0, 3.0);
    for radius in [0.0, 1.0] {
        assert!(
            point(position, radius)
                .sample(position, Vec2::ZERO)
                .is_none()
        );
        assert!(
            spot(position, radius)
                .sample(position, Vec2::ZERO)
                .is_none()
        );
    }
    assert!(
        disk(position, UnitVec3::Y, 1.0)
            .sample(position, Vec2::ZERO)
            .is_none()
    );
    assert!(
        rectangle(position, Vec3::X, Vec3::Z)
            .sample(position, Vec2::ZERO)
            .is_none()
    );
}

/// Two lights 1e12 apart in one sum keep their ratio (numerics.md L11).
#[test]
fn weights_are_in_proportion_to_intensity() {
    for light in cases().iter().map(|c| (c.light, c.seen_from)) {
        let (light, from) = light;
        let dim = |factor: f32| match light {
            Light::Point(l) => Light::Point(PointLight {
                intensity: l.intensity * factor,
                ..l
            }),
            Light::Spot(l) => Light::Spot(SpotLight {
                intensity: l.intensity * factor,
                ..l
            }),
            Light::Distant(l) => Light::Distant(DistantLight {
                irradiance: l.irradiance * factor,
                ..l
            }),
            Light::Disk(l) => Light::Disk(DiskLight {
                radiance: l.radiance * factor,
                ..l
            }),
            Light::Rectangle(l) => Light::Rectangle(RectangleLight {
                radiance: l.radiance * factor,
                ..l
            }),
            Light::Sphere(l) => Light::Sphere(SphereLight {
                radiance: l.radiance * factor,
                ..l
            }),
        };
        let u = Vec2::new(0.3, 0.6);
        let weight = |light: Light| light.sample(from, u).unwrap().weight.r;
        for factor in [1e-20, 1e-12, 1e12, 1e20] {
            let ratio = weight(dim(factor)) / weight(light) / factor;
            assert!((ratio - 1.0).abs() < 1e-6, "{light:?}: {ratio}");
        }
    }
}

/// A scene scaled by a power of two gets the same light, bit for bit (numerics.md G4), radiant
/// intensity being kept by the falloff of the scaled light.
#[test]
fn placed_lights_light_the_scaled_scene_alike() {
    for case in cases() {
        for k in (-40..=40).step_by(5) {
            let scale = 2.0_f32.powi(k);
            let placed = case.light.placed(scale, Vec3::ZERO);
            assert_eq!(placed.is_delta(), case.light.is_delta());
            for u in random(50, 4) {
                let here = case.light.sample(case.seen_from, u);
                let there = placed.sample(case.seen_from * scale, u).map(|mut s| {
                    if let ShadowEnd::Point(p) = &mut s.shadow {
                        *p /= scale;
                    }
                    s
                });
                assert_eq!(bits(here), bits(there), "{:?} by 2^{k}", case.light);
            }
        }
    }
    let seed = Falloff {
        constant: 1.0,
        linear: 0.5,
        quadratic: 0.25,
        range: 30.0,
    };
    let light = Light::Point(PointLight {
        falloff: seed,
        ..point(Vec3::new(1.0, 5.0, 2.0), 0.5)
    });
    let (scale, offset) = (0.001, Vec3::new(3.0, -4.0, 5.0));
    let placed = light.placed(scale, offset);
    let (here, there) = (
        Vec3::new(2.0, 0.0, 1.0),
        Vec3::new(2.0, 0.0, 1.0) * scale + offset,
    );
    let u = Vec2::new(0.2, 0.9);
    let weights = [light.sample(here, u), placed.sample(there, u)].map(|s| s.unwrap().weight.r);
    assert!((weights[0] / weights[1] - 1.0).abs() < 1e-3, "{weights:?}");
}
