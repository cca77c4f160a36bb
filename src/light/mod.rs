//! Lights: from a shading point to a direction, a weight and what must be unblocked.
//!
//! A light returns a record; the integrator shoots the shadow ray. One file a kind; the closed
//! enum [`Light`] lists them all.

mod disk;
mod distant;
mod environment;
mod falloff;
mod point;
mod rectangle;
mod row;
mod sphere;
mod spherical_ellipse;
mod spherical_rectangle;
mod spot;
mod tree;
mod triangle;

pub use disk::DiskLight;
pub use distant::DistantLight;
pub use environment::{Environment, EnvironmentSampler};
pub use falloff::Falloff;
pub use point::PointLight;
pub use rectangle::RectangleLight;
pub use row::LightSampleRow;
pub use sphere::SphereLight;
pub use spot::SpotLight;
pub use tree::{LightBounds, LightTree, Receiver};
pub use triangle::{SeenTriangle, TriangleSample};

use crate::color::Rgb;
use crate::math::{Aabb, DVec3, Ray, UnitVec3, Vec2, Vec3};

/// A light of any kind.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    /// A point, with a soft shadow where it has a radius.
    Point(PointLight),
    /// A point that shines into a cone.
    Spot(SpotLight),
    /// Parallel rays from far away.
    Distant(DistantLight),
    /// A one-sided disk of constant radiance.
    Disk(DiskLight),
    /// A one-sided rectangle of constant radiance.
    Rectangle(RectangleLight),
    /// A sphere of constant radiance.
    Sphere(SphereLight),
}

/// One way in which a light may reach a point.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// From the point to the light: the direction that shading uses.
    pub wi: UnitVec3,
    /// Radiance over solid-angle density (for lights without area: irradiance on a surface that
    /// faces the light): multiply by BSDF and cosine once the way is clear.
    pub weight: Rgb,
    /// That density, as [`Light::density`] says it.
    pub density: f64,
    /// What the shadow ray goes to.
    pub shadow: ShadowEnd,
}

/// The far end of a shadow ray.
#[derive(Clone, Copy, Debug)]
pub enum ShadowEnd {
    /// A point of the light.
    Point(Vec3),
    /// Out of the scene in this direction.
    Direction(UnitVec3),
}

/// Calls the method of the same name of whatever kind of light it is.
macro_rules! each_kind {
    ($self:expr, $light:ident => $call:expr) => {
        match $self {
            Light::Point($light) => $call,
            Light::Spot($light) => $call,
            Light::Distant($light) => $call,
            Light::Disk($light) => $call,
            Light::Rectangle($light) => $call,
            Light::Sphere($light) => $call,
        }
    };
}

impl Light {
    /// One sample of the light as seen from `point`, for `u` in `[0, 1)²`.
    ///
    /// `None` where none of the light can reach the point (behind it, outside its cone).
    pub fn sample(&self, point: Vec3, u: Vec2) -> Option<LightSample> {
        each_kind!(self, light => light.sample(point, u))
    }

    /// The density by solid angle with which [`Self::sample`] at `point` takes the direction `wi`, in
    /// which the light is seen; 0 for lights that no ray can meet, since they have no surface.
    pub fn density(&self, point: Vec3, wi: UnitVec3) -> f64 {
        let density = match self {
            Light::Point(_) | Light::Spot(_) => 0.0,
            Light::Distant(light) => light.density(),
            Light::Disk(light) => light.density(point, wi),
            Light::Rectangle(light) => light.density(point, wi),
            Light::Sphere(light) => light.density(point),
        };
        if density.is_finite() { density } else { 0.0 }
    }

    /// Where it is, which way it shines and how strong it is; `None` where it is infinitely far away
    /// or has no power.
    pub fn light_bounds(&self) -> Option<LightBounds> {
        let bounds = match self {
            Light::Distant(_) => return None,
            Light::Point(light) => {
                let bounds = Aabb::of_points([light.position]);
                LightBounds::in_all_directions(bounds, light.intensity.luminance().into())
            }
            Light::Spot(light) => light.light_bounds(),
            Light::Disk(light) => {
                let area = std::f64::consts::PI * f64::from(light.radius).powi(2);
                let power = area * f64::from(light.radiance.luminance());
                LightBounds::flat(self.extent(), light.normal, false, power)
            }
            Light::Rectangle(light) => {
                let (normal, area) = light.normal_and_area()?;
                let power = area * f64::from(light.radiance.luminance());
                LightBounds::flat(self.extent(), normal, false, power)
            }
            Light::Sphere(light) => {
                let area = std::f64::consts::PI * f64::from(light.radius).powi(2);
                let power = area * f64::from(light.radiance.luminance());
                LightBounds::in_all_directions(self.extent(), power)
            }
        };
        // Colours may have a luminance of 0 where they are not black, but for rounding.
        (!self.is_black()).then(|| bounds.with_least(f64::MIN_POSITIVE))
    }

    /// Whether every `u` gives the same sample: then one shadow ray says it all.
    pub fn is_delta(&self) -> bool {
        each_kind!(self, light => light.is_delta())
    }

    /// Shadow rays per shading point that its author asked for; at least 1.
    pub fn samples(&self) -> u32 {
        if self.is_delta() {
            1
        } else {
            each_kind!(self, light => light.samples).max(1)
        }
    }

    /// Whether the camera sees the light itself.
    pub fn is_visible(&self) -> bool {
        match self {
            Light::Disk(light) => light.is_visible,
            Light::Rectangle(light) => light.is_visible,
            Light::Sphere(light) => light.is_visible,
            Light::Point(_) | Light::Spot(_) | Light::Distant(_) => false,
        }
    }

    /// A box around its surface; `None` where it has none, so that no ray can meet it.
    pub fn surface_bounds(&self) -> Option<Aabb> {
        let has_surface = match self {
            Light::Point(_) | Light::Spot(_) | Light::Distant(_) => false,
            Light::Disk(_) | Light::Rectangle(_) | Light::Sphere(_) => !self.is_delta(),
        };
        has_surface.then(|| self.extent())
    }

    /// A box around its surface; empty where it has none.
    fn extent(&self) -> Aabb {
        let (center, reach) = match self {
            Light::Disk(light) => (light.center, Vec3::splat(light.radius)),
            Light::Rectangle(light) => (light.center, light.half_u.abs() + light.half_v.abs()),
            Light::Sphere(light) => (light.center, Vec3::splat(light.radius)),
            Light::Point(_) | Light::Spot(_) | Light::Distant(_) => return Aabb::EMPTY,
        };
        Aabb::of_points([center - reach, center + reach])
    }

    /// Where a ray meets the light's surface, and the radiance it finds there.
    ///
    /// `None` for lights without a surface, and the back of one-sided ones.
    pub fn met(&self, ray: &Ray) -> Option<(f32, Rgb)> {
        match self {
            Light::Disk(light) => light.met(ray),
            Light::Rectangle(light) => light.met(ray),
            Light::Sphere(light) => light.met(ray),
            Light::Point(_) | Light::Spot(_) | Light::Distant(_) => None,
        }
    }

    /// This light in coordinates that are scaled by `scale` and then moved by `offset`; it
    /// lights the scaled scene as it lit the original.
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        match self {
            Light::Point(light) => Light::Point(light.placed(scale, offset)),
            Light::Spot(light) => Light::Spot(light.placed(scale, offset)),
            Light::Distant(light) => Light::Distant(*light),
            Light::Disk(light) => Light::Disk(light.placed(scale, offset)),
            Light::Rectangle(light) => Light::Rectangle(light.placed(scale, offset)),
            Light::Sphere(light) => Light::Sphere(light.placed(scale, offset)),
        }
    }

    /// Whether it gives no light at all.
    pub fn is_black(&self) -> bool {
        match self {
            Light::Point(light) => light.intensity.is_black(),
            Light::Spot(light) => light.intensity.is_black(),
            Light::Distant(light) => light.irradiance.is_black(),
            Light::Disk(light) => light.radiance.is_black(),
            Light::Rectangle(light) => light.radiance.is_black(),
            Light::Sphere(light) => light.radiance.is_black(),
        }
    }
}

/// The way from a shading point to a light, in double precision: no square of a distance
/// overflows or vanishes.
struct Toward {
    /// Of length 1.
    direction: DVec3,
    distance: f64,
}

impl Toward {
    /// `None` where they coincide or are not finite.
    fn new(point: Vec3, light: Vec3) -> Option<Self> {
        let way = light.as_dvec3() - point.as_dvec3();
        let distance = way.length();
        (distance > 0.0 && distance.is_finite()).then(|| Self {
            direction: way / distance,
            distance,
        })
    }

    fn unit(&self) -> UnitVec3 {
        unit(self.direction)
    }
}

/// Whether a light of this radius (or angle) casts soft shadows.
fn has_extent(radius: f32) -> bool {
    radius > 0.0
}

/// A vector of length 1, in single precision.
#[inline(always)]
fn unit(direction: DVec3) -> UnitVec3 {
    UnitVec3::from_normalized(direction.as_vec3())
}

/// Far quicker than `f64::hypot`, and as good: squares of `f32` numbers do not leave `f64`.
#[inline(always)]
fn hypotenuse(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// `color * factor`; `None` where that is black, or more than single precision holds.
#[inline(always)]
fn weigh(color: Rgb, factor: f64) -> Option<Rgb> {
    let [r, g, b] = color.channels();
    let weight = Rgb::new(
        (f64::from(r) * factor) as f32,
        (f64::from(g) * factor) as f32,
        (f64::from(b) * factor) as f32,
    );
    (weight.is_finite() && !weight.is_black()).then_some(weight)
}

/// In single precision, kept finite for lights that reach beyond it.
#[inline(always)]
fn shadow_point(point: DVec3) -> Vec3 {
    let largest = DVec3::splat(f64::from(f32::MAX));
    point.clamp(-largest, largest).as_vec3()
}

/// Where a ray meets a plane.
struct PlaneHit {
    /// Whether it does, from the front; else the rest means nothing.
    is_hit: bool,
    /// The ray's parameter there.
    t: f32,
    /// The place.
    from_center: DVec3,
}

/// Where `ray` meets the plane through `center` (relative to the ray's origin) across `normal`, of any length.
///
/// Without a branch, for rows of rays.
#[inline(always)]
fn plane_hit(ray: &Ray, center: DVec3, normal: DVec3) -> PlaneHit {
    let direction = ray.direction.as_dvec3();
    let approach = direction.dot(normal);
    let exact_t = center.dot(normal) / approach;
    let t = exact_t as f32;
    PlaneHit {
        is_hit: (approach < 0.0) & (t > ray.t_min) & (t < ray.t_max),
        t,
        from_center: direction * exact_t - center,
    }
}
