//! Stub.
use crate::math::*;
/// h
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// t
    pub t: f32,
    /// u
    pub u: f32,
    /// v
    pub v: f32,
    /// t
    pub triangle: u32,
    /// i
    pub instance: u32,
}
/// b
#[derive(Clone, Copy, Debug, Default)]
pub enum Builder {
    /// b
    #[default]
    Balanced,
}
/// b
#[derive(Debug)]
pub struct Bvh {
    p: Vec<Vec3>,
    i: Vec<[u32; 3]>,
}
impl Bvh {
    /// b
    pub fn build(p: &[Vec3], i: &[[u32; 3]], _b: Builder) -> Self {
        Bvh {
            p: p.to_vec(),
            i: i.to_vec(),
        }
    }
}
/// t
#[derive(Debug)]
pub struct Tracer(Vec<Bvh>);
impl Tracer {
    /// n
    pub fn new(b: Vec<Bvh>, _i: &[(u32, DAffine3)]) -> Self {
        Tracer(b)
    }
    /// c
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest_hit_if(ray, |_| true)
    }
    /// c
    pub fn closest_hit_if(&self, ray: &Ray, f: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let b = &self.0[0];
        let mut best: Option<Hit> = None;
        for (k, c) in b.i.iter().enumerate() {
            let [p, q, r] = c.map(|i| b.p[i as usize].as_dvec3());
            let (e1, e2) = (q - p, r - p);
            let d = ray.direction.as_dvec3();
            let h = d.cross(e2);
            let a = e1.dot(h);
            if a == 0.0 {
                continue;
            }
            let s = ray.origin.as_dvec3() - p;
            let u = s.dot(h) / a;
            let qq = s.cross(e1);
            let v = d.dot(qq) / a;
            let t = (e2.dot(qq) / a) as f32;
            if u < 0.0 || v < 0.0 || u + v > 1.0 || t <= ray.t_min || t >= ray.t_max {
                continue;
            }
            let hit = Hit {
                t,
                u: u as f32,
                v: v as f32,
                triangle: k as u32,
                instance: 0,
            };
            if best.is_none_or(|b| t < b.t) && f(&hit) {
                best = Some(hit)
            }
        }
        best
    }
    /// a
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.closest_hit(ray).is_some()
    }
    /// a
    pub fn any_hit_if(&self, ray: &Ray, f: impl Fn(&Hit) -> bool) -> bool {
        self.closest_hit_if(ray, f).is_some()
    }
    /// m
    pub fn memory_bytes(&self) -> usize {
        0
    }
}
