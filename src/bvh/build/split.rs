//! Ways to split a range of primitives in two.

use super::primitive::{Bounds, PARALLEL_SCAN, Part, Primitive};
use rayon::prelude::*;

/// Most bins an axis is cut into.
const MAX_BINS: usize = 32;

/// Splits where the surface area heuristic says that it costs least, at the borders of bins
/// (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
///
/// A side's cost is its area times the number of *blocks* of `block_size` triangles it will
/// need, for a block is tested at once. Falls back to [`split_median`] where no border leaves
/// something on both sides.
pub(super) fn split_sah(part: Part<'_>, block_size: usize) -> (Part<'_>, Part<'_>) {
    let binning = Binning::new(&part);
    let bins = binning.fill(part.primitives);
    match binning.best_border(&bins, block_size) {
        Some((axis, border)) => partition(part, |p| binning.bin(p, axis) < border),
        None => split_median(part),
    }
}

/// Splits into halves at the median of the centroids along the longest axis of their box;
/// among equals the lower indices go first.
pub(super) fn split_median(part: Part<'_>) -> (Part<'_>, Part<'_>) {
    let axis = part.centroids.to_aabb().longest_axis();
    let middle = part.primitives.len() / 2;
    part.primitives.select_nth_unstable_by(middle, |a, b| {
        let along = |p: &Primitive| p.centroid()[axis];
        along(a)
            .total_cmp(&along(b))
            .then(a.index().cmp(&b.index()))
    });
    let (left, right) = part.primitives.split_at_mut(middle);
    (Part::new(left), Part::new(right))
}

/// Reorders so that those `on_left` come first.
fn partition(part: Part<'_>, on_left: impl Fn(&Primitive) -> bool) -> (Part<'_>, Part<'_>) {
    let primitives = part.primitives;
    let (mut low, mut high) = (0, primitives.len());
    while low < high {
        if on_left(&primitives[low]) {
            low += 1;
        } else {
            high -= 1;
            primitives.swap(low, high);
        }
    }
    let (left, right) = primitives.split_at_mut(low);
    (Part::new(left), Part::new(right))
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        count: 0,
    };

    fn add(&mut self, other: &Self) {
        self.bounds.add(&other.bounds);
        self.count += other.count;
    }
}

/// By axis, then along it.
type Bins = [[Bin; MAX_BINS]; 3];

/// How centroids map to bins.
struct Binning {
    base: glam::Vec3A,
    scale: glam::Vec3A,
    count: usize,
}

impl Binning {
    fn new(part: &Part<'_>) -> Self {
        // Few primitives need few bins (Embree's rule of thumb is the same).
        let count = MAX_BINS.min(4 + part.primitives.len() / 16);
        let extent = part.centroids.max - part.centroids.min;
        // An axis without extent has all centroids in bin 0 and no border.
        let scale = glam::Vec3A::select(
            extent.cmpgt(glam::Vec3A::ZERO),
            count as f32 / extent,
            glam::Vec3A::ZERO,
        );
        Self {
            base: part.centroids.min,
            scale,
            count,
        }
    }

    /// Casts saturate, so that a product that overflowed or is NaN still names a bin.
    #[inline(always)]
    fn bin(&self, primitive: &Primitive, axis: usize) -> usize {
        let x = (primitive.centroid()[axis] - self.base[axis]) * self.scale[axis];
        (x as usize).min(self.count - 1)
    }

    fn fill(&self, primitives: &[Primitive]) -> Bins {
        if primitives.len() <= PARALLEL_SCAN {
            return self.fill_serially(primitives);
        }
        primitives
            .par_chunks(PARALLEL_SCAN / 4)
            .map(|chunk| self.fill_serially(chunk))
            .reduce(
                || [[Bin::EMPTY; MAX_BINS]; 3],
                |mut bins, others| {
                    for (bin, other) in bins.iter_mut().flatten().zip(others.iter().flatten()) {
                        bin.add(other);
                    }
                    bins
                },
            )
    }

    fn fill_serially(&self, primitives: &[Primitive]) -> Bins {
        let mut bins = [[Bin::EMPTY; MAX_BINS]; 3];
        for primitive in primitives {
            let place = (primitive.centroid() - self.base) * self.scale;
            for axis in 0..3 {
                let index = (place[axis] as usize).min(self.count - 1);
                let bin = &mut bins[axis][index % MAX_BINS];
                bin.bounds.add_primitive(primitive);
                bin.count += 1;
            }
        }
        bins
    }

    /// Axis and first bin of the right side of the cheapest border; `None` where there is none.
    fn best_border(&self, bins: &Bins, block_size: usize) -> Option<(usize, usize)> {
        let blocks = |count: u32| f64::from(count.div_ceil(block_size as u32));
        let cost = |side: &Bin| side.bounds.half_area() * blocks(side.count);
        let mut best = None;
        let mut best_cost = f64::INFINITY;
        for axis in 0..3 {
            let bins = &bins[axis][..self.count];
            let mut right_costs = [f64::INFINITY; MAX_BINS];
            let mut right = Bin::EMPTY;
            for (bin, right_cost) in bins.iter().zip(&mut right_costs).skip(1).rev() {
                right.add(bin);
                if right.count > 0 {
                    *right_cost = cost(&right);
                }
            }
            let mut left = Bin::EMPTY;
            for border in 1..self.count {
                left.add(&bins[border - 1]);
                if left.count == 0 {
                    continue;
                }
                let total = cost(&left) + right_costs[border];
                if total < best_cost {
                    best_cost = total;
                    best = Some((axis, border));
                }
            }
        }
        best
    }
}
