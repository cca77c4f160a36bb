//! Lights that rays meet on their way: disks, rectangles and spheres stand in the scene as surfaces do.

use crate::bvh::BoxTree;
use crate::color::Rgb;
use crate::light::Light;
use crate::math::{Aabb, Ray, RayRow, Row, UNIT_ROUNDOFF, Vec3, first_places, places};

/// Up to so many lights are looked at one after the other, which is quicker than a tree over them.
const FEW: usize = 8;

/// What a hit may be off by: 16 units in the last place of what it is computed from, in double precision, and rounded to.
const SLACK: f32 = 16.0 * UNIT_ROUNDOFF;

/// The lights that rays can meet.
#[derive(Debug)]
pub(super) struct LightSurfaces<'a> {
    /// With their numbers, in rising order.
    lights: Vec<(u32, &'a Light)>,
    /// Over their boxes, unless they are few.
    tree: Option<BoxTree>,
}

/// A light whose surface a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct MetLight {
    pub number: u32,
    /// Whether the camera sees it.
    pub is_visible: bool,
    /// Where along the ray.
    pub t: f32,
    pub radiance: Rgb,
}

impl<'a> LightSurfaces<'a> {
    /// Those of `lights`, with rising numbers, that have surfaces.
    pub fn new(lights: impl Iterator<Item = (u32, &'a Light)>) -> Self {
        let (lights, boxes): (Vec<_>, Vec<Aabb>) = lights
            .filter_map(|(number, light)| Some(((number, light), light.surface_bounds()?)))
            .unzip();
        let has_tree = lights.len() > FEW;
        let boxes: Vec<Aabb> = boxes.iter().map(grown).collect();
        Self {
            tree: has_tree.then(|| BoxTree::new(&boxes)),
            lights,
        }
    }

    /// Calls `visit` for each light that `ray` meets between `start` and `end`, in any order, until it says that it is enough.
    fn visit(&self, ray: &Ray, start: f32, end: f32, mut visit: impl FnMut(MetLight) -> bool) {
        let meet = |&(number, light): &(u32, &Light)| {
            let (t, radiance) = light.met(ray)?;
            (t > start && t < end).then_some(MetLight {
                number,
                is_visible: light.is_visible(),
                t,
                radiance,
            })
        };
        let Some(tree) = &self.tree else {
            self.lights.iter().filter_map(meet).any(visit);
            return;
        };
        let part = Ray {
            t_min: start,
            t_max: end,
            ..*ray
        };
        let slack = SLACK * ray.origin.abs().max_element();
        tree.visit(&part, slack, |index| {
            let is_enough = meet(&self.lights[index as usize]).is_some_and(&mut visit);
            (!is_enough).then_some(end)
        });
    }

    /// The lights that `ray` meets between `start` and `end`, in the order of their numbers.
    pub fn between(&self, ray: &Ray, start: f32, end: f32) -> Vec<MetLight> {
        let mut met = Vec::new();
        self.visit(ray, start, end, |light| {
            met.push(light);
            false
        });
        met.sort_unstable_by_key(|light| light.number);
        met
    }

    /// A bit for each of `rays` that meets a light between its origin and where it `ends`.
    pub fn are_met_by(&self, rays: &RayRow, ends: &Row) -> u64 {
        if self.tree.is_none() {
            let met = self.lights.iter().map(|(_, l)| l.is_met_by(rays, ends));
            return met.fold(0, |all, met| all | met);
        }
        let meets = |&i: &usize| {
            let mut is_met = false;
            self.visit(&rays.get(i), 0.0, ends[i], |_| {
                is_met = true;
                true
            });
            is_met
        };
        places(first_places(rays.count()))
            .filter(meets)
            .fold(0, |all, i| all | 1 << i)
    }
}

/// A box larger by what its own coordinates may bring: far lights are not to blur those that are near.
fn grown(bounds: &Aabb) -> Aabb {
    let slack = Vec3::splat(SLACK * bounds.reach());
    Aabb {
        min: (bounds.min - slack).max(Vec3::splat(f32::MIN)),
        max: (bounds.max + slack).min(Vec3::splat(f32::MAX)),
    }
}

/// The nearest of `lights` that the camera sees.
pub(super) fn nearest_visible(lights: &[MetLight]) -> Option<&MetLight> {
    (lights.iter())
        .filter(|light| light.is_visible)
        .min_by(|a, b| a.t.total_cmp(&b.t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{DiskLight, RectangleLight, SphereLight};
    use crate::math::{UVec2, UnitVec3};
    use crate::sampling::{Pattern, Sampler, SamplingConfig};

    /// Random vectors with coordinates in `[-1, 1)`, and directions.
    fn random(count: u32, seed: u64) -> impl Iterator<Item = (Vec3, UnitVec3)> {
        let config = SamplingConfig {
            samples: count,
            pattern: Pattern::Random,
            seed,
            ..SamplingConfig::default()
        };
        (0..count).map(move |i| {
            let sampler = Sampler::new(&config, UVec2::ZERO, i);
            let (xy, z) = (sampler.camera(), sampler.lens().x);
            let toward = sampler.light(1, 0, 0, 1).extend(sampler.scattering(1)[0].x);
            let direction = UnitVec3::normalize(2.0 * toward - 1.0).unwrap_or(UnitVec3::Y);
            (2.0 * xy.extend(z) - 1.0, direction)
        })
    }

    /// Lights of all kinds about `offset`, some of them large, most of them small.
    fn lights(count: u32, offset: Vec3) -> Vec<Light> {
        let light = |(i, (place, normal)): (u32, (Vec3, UnitVec3))| {
            let center = place + offset;
            let radius = 0.5 * 0.3f32.powi((i % 7) as i32);
            let radiance = Rgb::splat(i as f32 + 1.0);
            let is_visible = i % 2 == 0;
            match i % 3 {
                0 => Light::Disk(DiskLight {
                    center,
                    normal,
                    radius,
                    radiance,
                    is_visible,
                    samples: 1,
                }),
                1 => Light::Sphere(SphereLight {
                    center,
                    radius,
                    radiance,
                    is_visible,
                    samples: 1,
                }),
                _ => Light::Rectangle(RectangleLight {
                    center,
                    half_u: radius * normal.any_orthonormal_vector(),
                    half_v: 0.3 * radius * *normal,
                    radiance,
                    is_visible,
                    samples: 1,
                }),
            }
        };
        let far = Light::Sphere(SphereLight {
            center: Vec3::new(0.0, 1e6, 3e7),
            radius: 1e5,
            radiance: Rgb::WHITE,
            is_visible: true,
            samples: 1,
        });
        let near = (0..).zip(random(count, 1)).map(light);
        near.chain([far]).collect()
    }

    fn told(met: &[MetLight]) -> Vec<(u32, u32)> {
        met.iter().map(|m| (m.number, m.t.to_bits())).collect()
    }

    /// The tree only saves work: what it finds is what is found by looking at all lights in turn.
    #[test]
    fn no_light_is_missed_or_met_twice() {
        for offset in [Vec3::ZERO, Vec3::new(3e3, -1e5, 2.0)] {
            let lights = lights(300, offset);
            let by_tree = LightSurfaces::new((0..).zip(&lights));
            let one_by_one = LightSurfaces {
                lights: by_tree.lights.clone(),
                tree: None,
            };
            assert!(by_tree.tree.is_some());
            let (mut rays, mut ends, mut found) = (RayRow::EMPTY, [0.0; 64], 0);
            for (i, (origin, direction)) in random(4000, 2).enumerate() {
                // Some along an axis, some from far away, some that end soon.
                let direction = if i % 5 == 0 {
                    Vec3::AXES[i % 3]
                } else {
                    *direction
                };
                let away = if i % 4 == 0 { 1e3 } else { 1.0 };
                let ray = Ray::new(origin + offset - away * direction, direction);
                let (start, end) = (away - 1.0, if i % 2 == 0 { f32::INFINITY } else { away });
                let expected = told(&one_by_one.between(&ray, start, end));
                assert_eq!(told(&by_tree.between(&ray, start, end)), expected);
                found += expected.len();
                ends[rays.count()] = end;
                rays.push(&ray);
                if rays.count() == 64 {
                    let expected = one_by_one.are_met_by(&rays, &ends);
                    assert_eq!(by_tree.are_met_by(&rays, &ends), expected);
                    rays = RayRow::EMPTY;
                }
            }
            assert!(found > 4000, "{found} lights were met");
        }
    }
}
