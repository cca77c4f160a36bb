//! Instances: trees that stand in the world several times, under a tree of their boxes.

use super::boxes::BoxTree;
use super::count::Silent;
use super::hit::{Hit, HitRow, Search};
use super::tree::Bvh;
use crate::math::{Aabb, DAffine3, DVec3, Ray, RayRow, UNIT_ROUNDOFF, Vec3};

/// What rays are traced through: one tree as it is, or instances of several.
#[derive(Debug)]
pub enum Tracer {
    /// A single tree in world space.
    Flat(Bvh),
    /// Several trees, or one that is moved.
    Instanced(Forest),
}

impl Tracer {
    /// `instances` are pairs of an index into `trees` and the transform from that tree's
    /// coordinates to the world's. Their order numbers the instances of [`Hit::instance`].
    pub fn new(mut trees: Vec<Bvh>, instances: &[(u32, DAffine3)]) -> Self {
        if trees.len() == 1
            && *instances == [(0, DAffine3::IDENTITY)]
            && let Some(tree) = trees.pop()
        {
            return Self::Flat(tree);
        }
        Self::Instanced(Forest::new(trees, instances))
    }

    /// As [`Bvh::closest_hit`]; ties go to the lowest instance, then triangle.
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        match self {
            Self::Flat(tree) => tree.closest_hit(ray),
            Self::Instanced(forest) => forest.closest_hit(ray),
        }
    }

    /// As [`Bvh::closest_hit_if`].
    pub fn closest_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        match self {
            Self::Flat(tree) => tree.closest_hit_if(ray, accept),
            Self::Instanced(forest) => forest.closest_hit_if(ray, accept),
        }
    }

    /// As [`Bvh::closest_hits`]; through instances rays go one by one.
    pub fn closest_hits(&self, rays: &RayRow) -> HitRow {
        match self {
            Self::Flat(tree) => tree.closest_hits(rays),
            Self::Instanced(forest) => {
                let mut hits = HitRow::before(rays);
                for i in 0..rays.count() {
                    if let Some(hit) = forest.closest_hit(&rays.get(i)) {
                        hits.set(i, &hit);
                    }
                }
                hits
            }
        }
    }

    /// As [`Bvh::any_hits`]; through instances rays go one by one.
    pub fn any_hits(&self, rays: &RayRow) -> u64 {
        match self {
            Self::Flat(tree) => tree.any_hits(rays),
            Self::Instanced(forest) => (0..rays.count())
                .map(|i| u64::from(forest.any_hit(&rays.get(i))) << i)
                .fold(0, |all, one| all | one),
        }
    }

    /// As [`Bvh::any_hit`].
    pub fn any_hit(&self, ray: &Ray) -> bool {
        match self {
            Self::Flat(tree) => tree.any_hit(ray),
            Self::Instanced(forest) => forest.any_hit(ray),
        }
    }

    /// As [`Bvh::any_hit_if`].
    pub fn any_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        match self {
            Self::Flat(tree) => tree.any_hit_if(ray, accept),
            Self::Instanced(forest) => forest.any_hit_if(ray, accept),
        }
    }

    /// Around everything that can be hit, in world space.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Flat(tree) => tree.bounds(),
            Self::Instanced(forest) => forest.bounds(),
        }
    }

    /// Bytes on the heap.
    pub fn memory_bytes(&self) -> usize {
        match self {
            Self::Flat(tree) => tree.memory_bytes(),
            Self::Instanced(forest) => forest.memory_bytes(),
        }
    }
}

/// Condition numbers beyond this do not widen the boxes further; see [`Forest::search`].
const MAX_CONDITION: f64 = 64.0;

/// Trees standing in the world, each any number of times.
///
/// A ray is moved into a tree's coordinates without changing the length of its direction to 1,
/// so that `t` means the same everywhere.
#[derive(Debug)]
pub struct Forest {
    trees: Vec<Bvh>,
    instances: Vec<Instance>,
    /// Over the instances.
    boxes: BoxTree,
    /// Largest condition number of a transform, but [`MAX_CONDITION`] at most.
    condition: f64,
}

#[derive(Debug)]
struct Instance {
    tree: u32,
    from_world: DAffine3,
    /// In world space.
    bounds: Aabb,
}

impl Forest {
    /// See [`Tracer::new`]. An instance whose transform cannot be inverted is never hit.
    pub fn new(trees: Vec<Bvh>, instances: &[(u32, DAffine3)]) -> Self {
        let mut condition = 1.0f64;
        let instances: Vec<Instance> = instances
            .iter()
            .map(|&(tree, to_world)| {
                let instance = Instance::new(tree, &to_world, &trees[tree as usize]);
                if !instance.bounds.is_empty() {
                    condition = condition.max(condition_number(&to_world, &instance.from_world));
                }
                instance
            })
            .collect();
        let boxes: Vec<Aabb> = instances.iter().map(|instance| instance.bounds).collect();
        Self {
            trees,
            instances,
            boxes: BoxTree::new(&boxes),
            condition: condition.min(MAX_CONDITION),
        }
    }

    /// As [`Tracer::closest_hit`].
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest_hit_if(ray, |_| true)
    }

    /// As [`Tracer::closest_hit_if`].
    pub fn closest_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        self.search::<false>(ray, &accept)
    }

    /// As [`Tracer::any_hit`].
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.any_hit_if(ray, |_| true)
    }

    /// As [`Tracer::any_hit_if`].
    pub fn any_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        self.search::<true>(ray, &accept).is_some()
    }

    /// As [`Tracer::bounds`].
    pub fn bounds(&self) -> Aabb {
        self.boxes.bounds()
    }

    /// As [`Tracer::memory_bytes`].
    pub fn memory_bytes(&self) -> usize {
        let trees: usize = self.trees.iter().map(Bvh::memory_bytes).sum();
        trees
            + self.trees.capacity() * size_of::<Bvh>()
            + self.instances.capacity() * size_of::<Instance>()
            + self.boxes.memory_bytes()
    }

    /// A point that was found in an instance's own coordinates may be outside of its box in the world: moving the
    /// ray there rounds origin and direction to `f32`, and the transform back stretches that by at most its condition
    /// number.
    fn search<const ANY: bool>(&self, ray: &Ray, accept: &impl Fn(&Hit) -> bool) -> Option<Hit> {
        let size = ray.origin.abs().max_element() + self.boxes.reach();
        let slack = 16.0 * UNIT_ROUNDOFF * self.condition as f32 * size;
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.boxes.visit(ray, slack, |index| {
            let instance = &self.instances[index as usize];
            let accept = |hit: &Hit| instance.confirms(ray, hit.t, slack) && accept(hit);
            let tree = &self.trees[instance.tree as usize];
            let own = instance.ray(ray);
            tree.cast::<ANY, false, _>(&own, &mut search, index, &accept, &mut Silent);
            let is_done = ANY && search.hit.is_some();
            (!is_done).then_some(search.t_best)
        });
        search.hit
    }
}

impl Instance {
    fn new(tree: u32, to_world: &DAffine3, shape: &Bvh) -> Self {
        let from_world = to_world.inverse();
        let bounds = if from_world.is_finite() && to_world.is_finite() {
            transformed(&shape.bounds(), to_world)
        } else {
            Aabb::EMPTY
        };
        Self {
            tree,
            from_world,
            bounds,
        }
    }

    fn ray(&self, ray: &Ray) -> Ray {
        let origin = self.from_world.transform_point3(ray.origin.as_dvec3());
        let direction = self.from_world.transform_vector3(ray.direction.as_dvec3());
        Ray {
            origin: origin.as_vec3(),
            direction: direction.as_vec3(),
            ..*ray
        }
    }

    /// Whether the point at `t` is in the box, but for `slack`: demanded of every hit, so that
    /// the tree over the boxes cannot change which hits there are.
    fn confirms(&self, ray: &Ray, t: f32, slack: f32) -> bool {
        let (origin, way) = (
            ray.origin.as_dvec3(),
            f64::from(t) * ray.direction.as_dvec3(),
        );
        let point = origin + way;
        let slack =
            DVec3::splat(f64::from(slack)) + f64::from(f32::EPSILON) * (origin.abs() + way.abs());
        let low = self.bounds.min.as_dvec3() - slack;
        let high = self.bounds.max.as_dvec3() + slack;
        low.cmple(point).all() && point.cmple(high).all()
    }
}

/// The box around the transformed box, rounded outwards.
fn transformed(bounds: &Aabb, to_world: &DAffine3) -> Aabb {
    if bounds.is_empty() {
        return Aabb::EMPTY;
    }
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let corner = |i: usize| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 0 {
                min[axis]
            } else {
                max[axis]
            }
        };
        to_world.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
    };
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
    let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min);
    let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
    Aabb {
        min: Vec3::from(low.as_vec3().to_array().map(f32::next_down)),
        max: Vec3::from(high.as_vec3().to_array().map(f32::next_up)),
    }
}

fn condition_number(matrix: &DAffine3, inverse: &DAffine3) -> f64 {
    let norm = |m: &DAffine3| {
        let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
        (x.length_squared() + y.length_squared() + z.length_squared()).sqrt()
    };
    norm(matrix) * norm(inverse)
}
