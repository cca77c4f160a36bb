//! From the top down, cut where the bounds get smallest.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Content, Group, LightBounds, LightTree, NONE, Node};

/// Places along an axis where a group may be cut.
const BINS: usize = 12;

/// A light and its number.
type Numbered = (u32, LightBounds);

pub fn build(lights: &[Option<LightBounds>]) -> LightTree {
    let mut shining: Vec<Numbered> = (0..)
        .zip(lights)
        .filter_map(|(number, bounds)| Some((number, (*bounds)?)))
        .filter(|(_, bounds)| bounds.intensity > 0.0)
        .collect();
    let mut tree = LightTree {
        nodes: Vec::with_capacity(2 * shining.len()),
        leaves: vec![NONE; lights.len()],
    };
    let Some(around) = bounds(&shining) else {
        return tree;
    };
    tree.nodes.push(node(&around, NONE));
    let mut pending = vec![(0, around, shining.as_mut_slice())];
    while let Some((index, around, lights)) = pending.pop() {
        if let [(number, _)] = lights {
            tree.nodes[index as usize].content = Content::Light(*number);
            tree.leaves[*number as usize] = index;
            continue;
        }
        let cut = cut(lights, &around);
        let first = tree.nodes.len() as u32;
        tree.nodes[index as usize].content = Content::Children(first);
        let (left, right) = lights.split_at_mut(cut);
        for side in [left, right] {
            if let Some(around) = bounds(side) {
                pending.push((tree.nodes.len() as u32, around, side));
                tree.nodes.push(node(&around, index));
            }
        }
    }
    tree
}

/// Around `lights`; `None` around nothing.
fn bounds(lights: &[Numbered]) -> Option<LightBounds> {
    let all = lights.iter().map(|(_, bounds)| *bounds);
    all.reduce(|a, b| a.union(&b))
}

fn node(around: &LightBounds, parent: u32) -> Node {
    Node {
        group: Group::of(around),
        parent,
        content: Content::Light(NONE),
    }
}

/// Puts `lights`, two or more, in order and says where they are cut in two.
fn cut(lights: &mut [Numbered], around: &LightBounds) -> usize {
    let best = (0..3)
        .filter_map(|axis| Some((axis, best_cut(lights, around, axis)?)))
        .min_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b));
    if let Some((axis, (_, bin))) = best {
        let binning = Binning::of(lights, axis);
        let mut next = 0;
        for i in 0..lights.len() {
            if binning.bin(&lights[i].1) <= bin {
                lights.swap(i, next);
                next += 1;
            }
        }
        if next > 0 && next < lights.len() {
            return next;
        }
    }
    // All in one place.
    lights.len() / 2
}

/// The bins along one axis, over the middles of the lights.
struct Binning {
    axis: usize,
    start: f64,
    scale: f64,
}

impl Binning {
    fn of(lights: &[Numbered], axis: usize) -> Self {
        let middles = lights.iter().map(|(_, bounds)| middle(bounds, axis));
        let (min, max) = middles.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), m| {
            (min.min(m), max.max(m))
        });
        Self {
            axis,
            start: min,
            scale: BINS as f64 / (max - min),
        }
    }

    fn bin(&self, bounds: &LightBounds) -> usize {
        let place = (middle(bounds, self.axis) - self.start) * self.scale;
        (place as usize).min(BINS - 1)
    }
}

fn middle(bounds: &LightBounds, axis: usize) -> f64 {
    f64::from(bounds.bounds.center()[axis])
}

/// The cheapest cut across `axis`: its cost, and the last bin on its lower side.
fn best_cut(lights: &[Numbered], around: &LightBounds, axis: usize) -> Option<(f64, usize)> {
    let binning = Binning::of(lights, axis);
    if !binning.scale.is_finite() {
        return None;
    }
    let mut bins: [Option<LightBounds>; BINS] = [None; BINS];
    for (_, bounds) in lights {
        let bin = &mut bins[binning.bin(bounds)];
        *bin = join(*bin, Some(*bounds));
    }
    let mut above = [None; BINS];
    for i in (1..BINS).rev() {
        above[i - 1] = join(bins[i], above[i]);
    }
    // Thin slices are dear: they leave the group as long as it was.
    let extent = around.bounds.extent();
    let thinness = f64::from(extent.max_element()) / f64::from(extent[axis]);
    let mut below = None;
    let mut best: Option<(f64, usize)> = None;
    for i in 0..BINS - 1 {
        below = join(below, bins[i]);
        if let (Some(below), Some(above)) = (below, above[i]) {
            let cost = thinness * (cost(&below) + cost(&above));
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, i));
            }
        }
    }
    best
}

fn join(a: Option<LightBounds>, b: Option<LightBounds>) -> Option<LightBounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    }
}

/// The paper's measure of a group (equation 1): its power, times its size, times the solid angle
/// that it shines to. For its size the square of the diagonal, which is not 0 for lights in a row.
fn cost(group: &LightBounds) -> f64 {
    let size = group.bounds.extent().as_dvec3().length_squared();
    group.intensity * size * solid_angle(group)
}

/// The solid angle that a cone of normals shines to, weighted by the cosine beyond the cone.
fn solid_angle(group: &LightBounds) -> f64 {
    let normals = f64::from(group.normals_radians);
    let end = (normals + f64::from(group.emission_radians)).min(PI);
    let (sin, cos) = normals.sin_cos();
    let beyond = 2.0 * end * sin - (normals - 2.0 * end).cos() - 2.0 * normals * sin + cos;
    2.0 * PI * (1.0 - cos) + FRAC_PI_2 * beyond
}
