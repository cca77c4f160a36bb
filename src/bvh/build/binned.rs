//! Splits by the surface area heuristic at the borders of bins (Wald 2007, "On fast Construction
//! of SAH-based Bounding Volume Hierarchies").

use glam::Vec3A;
use rayon::prelude::*;

use super::bounds::Bounds;
use super::part::{PARALLEL, PIECE, Part};
use super::partition::partition;
use super::primitive::Primitive;
use super::wide::Splitter;

/// Splits by the surface area heuristic.
pub(super) struct Binned {
    /// Most primitives of a leaf.
    pub leaf_size: usize,
}

impl Splitter for Binned {
    fn leaf_size(&self) -> usize {
        self.leaf_size
    }

    fn split<'a>(&self, part: Part<'a>) -> Result<(Part<'a>, Part<'a>), Part<'a>> {
        match BinnedSplit::find(&part, self.leaf_size) {
            Some(split) => Ok(split.apply(part)),
            None => Err(part),
        }
    }
}

/// The cheapest split of a part at a border of bins.
pub(super) struct BinnedSplit {
    binning: Binning,
    axis: usize,
    /// First bin of the right side.
    border: usize,
    /// Around the right and the left side.
    pub sides: [Bounds; 2],
    /// Of both sides together.
    pub cost: f64,
}

impl BinnedSplit {
    /// `None` where all centroids fall into one bin.
    pub fn find(part: &Part<'_>, block_size: usize) -> Option<Self> {
        // Few primitives need few bins.
        match part.len() {
            0..128 => Self::find_among::<8>(part, block_size),
            128..1024 => Self::find_among::<16>(part, block_size),
            _ => Self::find_among::<32>(part, block_size),
        }
    }

    fn find_among<const N: usize>(part: &Part<'_>, block_size: usize) -> Option<Self> {
        let binning = Binning::new::<N>(&part.centroids);
        let bins = binning.fill::<N>(part.primitives());
        let mut best: Option<Self> = None;
        for (axis, bins) in bins.iter().enumerate() {
            let Some((cost, border)) = bins.best_border(block_size) else {
                continue;
            };
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Self {
                    binning,
                    axis,
                    border,
                    sides: bins.sides(border),
                    cost,
                });
            }
        }
        best
    }

    /// Does it.
    pub fn apply(self, mut part: Part<'_>) -> (Part<'_>, Part<'_>) {
        let done = partition(part.primitives_mut(), |p| {
            self.binning.bins_of(p)[self.axis] < self.border as u32
        });
        part.cut(done.left, self.sides, done.centroids)
    }
}

/// What a ray is expected to cost in a side of a split, but for a factor.
///
/// It does not meet all of the *blocks* of `block_size` primitives that the side will need (a
/// block is tested at once), as the classical heuristic has it: that a subtree costs far less is
/// what Wodniok and Goesele 2016 compute ("Recursive SAH-based Bounding Volume Hierarchy
/// Construction"). Of surfaces, rays meet about the square root; counting so takes a quarter
/// off the work of rays among large and small triangles, and a little elsewhere.
pub(super) fn side_cost(bounds: &Bounds, count: u32, block_size: usize) -> f64 {
    bounds.half_area() * f64::from(count.div_ceil(block_size as u32)).sqrt()
}

/// How centroids map to bins.
#[derive(Clone, Copy)]
struct Binning {
    base: Vec3A,
    scale: Vec3A,
    last: Vec3A,
}

/// 2^23: floats from here to 2^24 have their integer part in the low bits.
const INTEGERS: f32 = 8_388_608.0;

impl Binning {
    fn new<const N: usize>(centroids: &Bounds) -> Self {
        let extent = centroids.max - centroids.min;
        // An axis without extent has all centroids in one bin and no border.
        let scale = Vec3A::select(extent.cmpgt(Vec3A::ZERO), N as f32 / extent, Vec3A::ZERO);
        Self {
            base: centroids.min,
            scale,
            last: Vec3A::splat((N - 1) as f32),
        }
    }

    /// The bin by axis, below a power of two once more bits are masked off; the same in every
    /// call, also where products overflow.
    #[inline(always)]
    fn bins_of(&self, primitive: &Primitive) -> [u32; 3] {
        let place = (primitive.centroid() - self.base) * self.scale - 0.5;
        let rounded = place.min(self.last).max(Vec3A::ZERO) + INTEGERS;
        rounded.to_array().map(|x| x.to_bits() & 31)
    }

    fn fill<const N: usize>(&self, primitives: &[Primitive]) -> [Bins<N>; 3] {
        if primitives.len() <= PARALLEL {
            return self.fill_serially(primitives);
        }
        primitives
            .par_chunks(PIECE)
            .fold(
                || [Bins::EMPTY; 3],
                |mut bins, piece| {
                    self.add_to(&mut bins, piece);
                    bins
                },
            )
            .reduce(
                || [Bins::EMPTY; 3],
                |mut bins, others| {
                    bins.iter_mut().zip(&others).for_each(|(b, o)| b.add(o));
                    bins
                },
            )
    }

    fn fill_serially<const N: usize>(&self, primitives: &[Primitive]) -> [Bins<N>; 3] {
        let mut bins = [Bins::EMPTY; 3];
        self.add_to(&mut bins, primitives);
        bins
    }

    fn add_to<const N: usize>(&self, bins: &mut [Bins<N>; 3], primitives: &[Primitive]) {
        for primitive in primitives {
            let bounds = primitive.bounds();
            let [x, y, z] = self.bins_of(primitive);
            for (bins, index) in bins.iter_mut().zip([x, y, z]) {
                let index = index as usize % N;
                bins.bounds[index].add(&bounds);
                bins.counts[index] += 1;
            }
        }
    }
}

/// Along one axis.
struct Bins<const N: usize> {
    bounds: [Bounds; N],
    counts: [u32; N],
}

impl<const N: usize> Bins<N> {
    const EMPTY: Self = Self {
        bounds: [Bounds::EMPTY; N],
        counts: [0; N],
    };

    fn add(&mut self, other: &Self) {
        for i in 0..N {
            self.bounds[i].add(&other.bounds[i]);
            self.counts[i] += other.counts[i];
        }
    }

    /// Least cost, and the first bin of the right side; `None` where only one bin has any.
    fn best_border(&self, block_size: usize) -> Option<(f64, usize)> {
        let mut right_costs = [f64::INFINITY; N];
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        for i in (1..N).rev() {
            bounds.add(&self.bounds[i]);
            count += self.counts[i];
            if count > 0 {
                right_costs[i] = side_cost(&bounds, count, block_size);
            }
        }
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        let mut best = None;
        let mut best_cost = f64::INFINITY;
        for (border, right_cost) in right_costs.into_iter().enumerate().skip(1) {
            bounds.add(&self.bounds[border - 1]);
            count += self.counts[border - 1];
            if count == 0 {
                continue;
            }
            let cost = side_cost(&bounds, count, block_size) + right_cost;
            if cost < best_cost {
                best_cost = cost;
                best = Some((cost, border));
            }
        }
        best
    }

    /// Around the right and the left of `border`.
    fn sides(&self, border: usize) -> [Bounds; 2] {
        let around = |bins: &[Bounds]| {
            let mut all = Bounds::EMPTY;
            bins.iter().for_each(|b| all.add(b));
            all
        };
        let (left, right) = self.bounds.split_at(border);
        [around(right), around(left)]
    }
}
