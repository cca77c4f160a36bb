//! Lights that are on a surface or inside of a body.

use std::fmt;

use serde::Serialize;

use crate::light::Light;
use crate::math::{Frame, Ray, UnitVec3, Vec2, Vec3, gamma};
use crate::prepare::PreparedScene;
use crate::sampling::square_to_disk;

/// Lights that are looked at.
const MOST_LIGHTS: usize = 1 << 12;

/// Points of an area light along each axis of its sample square.
const POINTS: u32 = 4;

/// A light that touches a surface or is inside of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct LightPlace {
    /// Its number in the scene, from 0.
    pub light: usize,
    /// Surfaces are nearer to it than rounding can tell.
    pub touches: bool,
    /// It sees only the backs of surfaces.
    pub is_inside: bool,
    /// Camera rays can meet it, and it is the surface that it touches.
    pub is_seen_through: bool,
}

impl fmt::Display for LightPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = match (self.touches, self.is_inside) {
            (true, true) => "touches a surface, and is inside of a body",
            (true, false) => "touches a surface",
            (false, _) => "is inside of a body",
        };
        write!(f, "light {}: {place}", self.light)
    }
}

/// The lights of `scene` that touch a surface or are inside of a body.
pub fn places(scene: &PreparedScene) -> Vec<LightPlace> {
    let lights = scene.shining.iter().take(MOST_LIGHTS);
    let places = lights.map(|&number| place(scene, number as usize));
    places.filter(|p| p.touches || p.is_inside).collect()
}

fn place(scene: &PreparedScene, number: usize) -> LightPlace {
    let light = &scene.lights[number];
    let (points, normal) = points(light);
    let touching = points.iter().filter(|point| match normal {
        Some(normal) => touches(scene, **point, normal),
        None => (0..3).any(|axis| touches(scene, **point, Vec3::AXES[axis])),
    });
    // A surface that merely crosses a light passes between its points.
    let touching = touching.count();
    let touches = touching > 0 && (touching > 1 || points.len() == 1);
    LightPlace {
        light: number,
        touches,
        is_inside: points.first().is_some_and(|point| is_inside(scene, *point)),
        is_seen_through: touches && normal.is_some() && light.is_visible(),
    }
}

/// Points of a light, and its normal where it is flat.
fn points(light: &Light) -> (Vec<Vec3>, Option<Vec3>) {
    let squares = || {
        let middle = |i: u32| (i as f32 + 0.5) / POINTS as f32;
        (0..POINTS * POINTS).map(move |i| Vec2::new(middle(i % POINTS), middle(i / POINTS)))
    };
    match light {
        Light::Point(light) => (vec![light.position], None),
        Light::Spot(light) => (vec![light.position], None),
        Light::Distant(_) => (Vec::new(), None),
        Light::Sphere(light) => {
            let around = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
            let points = around.map(|way| light.center + light.radius * way);
            (points.collect(), None)
        }
        Light::Disk(light) => {
            let frame = Frame::around(light.normal);
            let points = squares().map(|u| {
                let at = light.radius * square_to_disk(u);
                light.center + frame.to_world(at.extend(0.0))
            });
            (points.collect(), Some(*light.normal))
        }
        Light::Rectangle(light) => {
            let points = squares().map(|u| {
                let at = 2.0 * u - Vec2::ONE;
                light.center + at.x * light.half_u + at.y * light.half_v
            });
            let normal = UnitVec3::normalize(light.half_u.cross(light.half_v));
            (points.collect(), normal.map(|normal| *normal))
        }
    }
}

/// Whether a surface crosses the line through `point` along `normal` within rounding.
fn touches(scene: &PreparedScene, point: Vec3, normal: Vec3) -> bool {
    let reach = gamma(16) * point.abs().max_element();
    let ray = Ray {
        t_max: 2.0,
        ..Ray::new(point - reach * normal, reach * normal)
    };
    reach > 0.0 && scene.closest_hit(&ray, None).is_some()
}

/// Whether only backs of surfaces are seen from `point`, along every axis.
fn is_inside(scene: &PreparedScene, point: Vec3) -> bool {
    let ways = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    ways.map(|way| Ray::new(point, way)).all(|ray| {
        let hit = scene.closest_hit(&ray, None);
        hit.is_some_and(|hit| !scene.surface(&ray, &hit).interaction.is_front)
    })
}
