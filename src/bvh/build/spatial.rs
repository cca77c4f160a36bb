//! The quality builder: triangles may be cut by planes (Stich, Friedrich and Dietrich 2009,
//! "Spatial Splits in Bounding Volume Hierarchies").
//!
//! A reference to a part of a triangle has that part's box; the leaf holds the whole triangle.
//!
//! # Why no hit is lost
//!
//! `caster` shows that a walk reaches every box that holds the point of a hit but for the
//! rounding of the ray. That point is in the triangle's box, and no farther from some point of
//! the triangle than rounding moves it: by E r / A, where E is the error bound of an edge
//! function, r the triangle's reach and A its area as the ray sees it (see `triangle`). `clip`'s
//! margin is more while A > 2^24 E. A triangle starts as one part; each cut divides a part's
//! points among two; and the box of a part holds, of the triangle's box, everything within the
//! margin of the part. So one of the boxes holds the hit.
//!
//! What is left are triangles seen so nearly edge-on that f64 cannot tell where along them the
//! ray passes. Among those, a cut may decide whether one is hit.

use super::binned::{Binned, BinnedSplit, side_cost};
use super::bounds::Bounds;
use super::clip::Clipper;
use super::collapse::Branches;
use super::part::{PARALLEL, PIECE, Part, scan};
use super::primitive::Primitive;
use super::wide::{Splitter, grow_tree};
use crate::math::Vec3;
use glam::Vec3A;
use rayon::prelude::*;

/// Where the sides of the best split of the ordinary kind overlap by less than this share of
/// the whole scene's surface, cutting is not tried (α of Stich et al.).
const LEAST_OVERLAP: f64 = 1e-5;

/// The same as a share of the part's own surface: less is not worth the search.
const LEAST_OWN_OVERLAP: f64 = 0.15;

/// Above small parts, whose trees are compared as a whole, a cut must bring the expected cost
/// down to this share of an ordinary split's. Many cuts that seem to gain a little there send
/// large triangles into all leaves of small neighbours and lose.
const CLEAR_GAIN: f64 = 0.7;

/// A leaf is split in two where that brings the area of leaves down to this share.
const SPLIT_LEAF: f64 = 0.8;

/// [`Builder::Quality`](super::Builder::Quality).
pub(super) struct Spatial<'a> {
    positions: &'a [Vec3],
    indices: &'a [[u32; 3]],
    leaf_size: usize,
    least_overlap: f64,
    /// Cutting must take the cost below so many times that of an ordinary split.
    most_cost: f64,
}

impl<'a> Spatial<'a> {
    /// For the given triangles, which `bounds` is around.
    pub fn new(
        positions: &'a [Vec3],
        indices: &'a [[u32; 3]],
        bounds: &Bounds,
        leaf_size: usize,
    ) -> Self {
        Self {
            positions,
            indices,
            leaf_size,
            least_overlap: LEAST_OVERLAP * bounds.half_area(),
            most_cost: CLEAR_GAIN,
        }
    }

    fn clipper(&self, primitive: &Primitive) -> Option<Clipper> {
        Clipper::new(self.positions, self.indices[primitive.index() as usize])
    }
}

impl Splitter for Spatial<'_> {
    fn leaf_size(&self) -> usize {
        self.leaf_size
    }

    fn split<'a>(&self, mut part: Part<'a>) -> Result<(Part<'a>, Part<'a>), Part<'a>> {
        let Some(binned) = BinnedSplit::find(&part, self.leaf_size) else {
            return Err(part);
        };
        let [right, left] = &binned.sides;
        let least = LEAST_OWN_OVERLAP * part.bounds.half_area();
        if part.room() > 0
            && left.overlap(right).half_area() > least.max(self.least_overlap)
            && let Some(cut) = PlaneSplit::find(self, &part)
            && cut.cost < binned.cost * self.most_cost
            && let Some((left, bounds, centroids)) = cut.apply(self, &mut part)
        {
            return Ok(part.cut(left, bounds, centroids));
        }
        Ok(binned.apply(part))
    }

    /// The better one of two trees: without cuts, and with all that seem to gain.
    fn grow_small<const W: usize>(&self, part: Part<'_>) -> Branches<W> {
        let mut copy = part.primitives().to_vec();
        let plain = grow_tree(
            Part::new(&mut copy),
            &Fine {
                leaf_size: self.leaf_size,
            },
        );
        if part.room() == 0 {
            return plain;
        }
        let eager = Self {
            most_cost: 1.0,
            ..*self
        };
        let cut = grow_tree(part, &eager);
        if cut.cost() < plain.cost() {
            cut
        } else {
            plain
        }
    }

    fn grow_leaf<const W: usize>(
        &self,
        part: Part<'_>,
        depth: usize,
        out: &mut Branches<W>,
    ) -> usize {
        Fine {
            leaf_size: self.leaf_size,
        }
        .grow_leaf(part, depth, out)
    }
}

/// Ordinary splits, also of leaves where that makes them much smaller.
struct Fine {
    leaf_size: usize,
}

impl Splitter for Fine {
    fn leaf_size(&self) -> usize {
        self.leaf_size
    }

    fn split<'a>(&self, part: Part<'a>) -> Result<(Part<'a>, Part<'a>), Part<'a>> {
        Binned {
            leaf_size: self.leaf_size,
        }
        .split(part)
    }

    fn grow_leaf<const W: usize>(
        &self,
        part: Part<'_>,
        depth: usize,
        out: &mut Branches<W>,
    ) -> usize {
        match BinnedSplit::find(&part, self.leaf_size) {
            Some(split) if split.cost < SPLIT_LEAF * part.bounds.half_area() => {
                let bounds = part.bounds;
                let (left, right) = split.apply(part);
                let left = self.grow_leaf(left, depth + 1, out);
                let right = self.grow_leaf(right, depth + 1, out);
                out.add_node(bounds, [left, right])
            }
            _ => out.add_leaf(part.bounds, part.primitives().iter().map(Primitive::index)),
        }
    }
}

/// The cheapest split at a plane between bins.
struct PlaneSplit {
    grid: Grid,
    axis: usize,
    border: usize,
    cost: f64,
    /// Of the right and the left side.
    sides: [(Bounds, u32); 2],
}

impl PlaneSplit {
    fn find(context: &Spatial, part: &Part<'_>) -> Option<Self> {
        match part.len() {
            0..64 => Self::find_among::<4>(context, part),
            64..256 => Self::find_among::<8>(context, part),
            _ => Self::find_among::<16>(context, part),
        }
    }

    fn find_among<const N: usize>(context: &Spatial, part: &Part<'_>) -> Option<Self> {
        let grid = Grid::new::<N>(&part.bounds);
        let bins = grid.fill::<N>(context, part.primitives());
        let most = part.len() + part.room();
        let mut best: Option<Self> = None;
        for (axis, bins) in bins.iter().enumerate() {
            for border in 1..N {
                let sides = bins.sides(border);
                let [(right, rights), (left, lefts)] = &sides;
                let is_allowed = *rights > 0 && *lefts > 0 && (rights + lefts) as usize <= most;
                if !is_allowed {
                    continue;
                }
                let cost = side_cost(left, *lefts, context.leaf_size)
                    + side_cost(right, *rights, context.leaf_size);
                if best.as_ref().is_none_or(|best| cost < best.cost) {
                    best = Some(Self {
                        grid,
                        axis,
                        border,
                        cost,
                        sides,
                    });
                }
            }
        }
        best
    }

    /// Replaces what is in `part` by its left and its right side; returns how many are on the
    /// left and the boxes of right and left, around the primitives and around their centroids.
    /// `None`, and nothing done, where all would be on one side.
    fn apply(
        &self,
        context: &Spatial,
        part: &mut Part<'_>,
    ) -> Option<(usize, [Bounds; 2], [Bounds; 2])> {
        let sort = |primitives: &[Primitive]| {
            let mut sides = [Vec::new(), Vec::with_capacity(primitives.len())];
            primitives
                .iter()
                .for_each(|p| self.place(context, p, &mut sides));
            sides
        };
        let [right, left] = if part.len() <= PARALLEL {
            sort(part.primitives())
        } else {
            let pieces: Vec<_> = part.primitives().par_chunks(PIECE).map(sort).collect();
            let side = |i: usize| pieces.iter().flat_map(|sides| &sides[i]).copied().collect();
            [side(0), side(1)]
        };
        if right.is_empty() || left.is_empty() {
            return None;
        }
        part.refill(&left, &right);
        let [right, left] = [&right, &left].map(|side: &Vec<Primitive>| (scan(side), side.len()));
        Some((left.1, [right.0.0, left.0.0], [right.0.1, left.0.1]))
    }

    /// Adds a primitive to the right or the left side, or a part of it to each.
    fn place(&self, context: &Spatial, primitive: &Primitive, sides: &mut [Vec<Primitive>; 2]) {
        let bounds = primitive.bounds();
        let [first, last] = self
            .grid
            .range(&bounds)
            .map(|bins| bins[self.axis] as usize);
        let side = if last < self.border {
            Side::Left
        } else if first >= self.border {
            Side::Right
        } else {
            self.side_of_crossing(&bounds)
        };
        if side == Side::Both
            && let Some(clipper) = context.clipper(primitive)
        {
            let plane = self.grid.plane(self.axis, self.border);
            let [below, above] = clipper.cut(&bounds, self.axis, plane);
            for (i, part) in [(1, below), (0, above)] {
                if !part.is_empty() {
                    sides[i].push(Primitive::new(part.min, part.max, primitive.index()));
                }
            }
        } else {
            sides[usize::from(side != Side::Right)].push(*primitive);
        }
    }

    /// Where a primitive across the plane costs least ("reference unsplitting").
    fn side_of_crossing(&self, bounds: &Bounds) -> Side {
        let [(right, rights), (left, lefts)] = self.sides;
        let cost = |right: &Bounds, rights: u32, left: &Bounds, lefts: u32| {
            right.half_area() * f64::from(rights) + left.half_area() * f64::from(lefts)
        };
        let both = cost(&right, rights, &left, lefts);
        let on_left = cost(&right, rights - 1, &left.union(bounds), lefts);
        let on_right = cost(&right.union(bounds), rights, &left, lefts - 1);
        if both < on_left && both < on_right {
            Side::Both
        } else if on_left <= on_right {
            Side::Left
        } else {
            Side::Right
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
    Both,
}

/// How places map to bins.
#[derive(Clone, Copy)]
struct Grid {
    base: Vec3A,
    scale: Vec3A,
    width: Vec3A,
    last: Vec3A,
}

impl Grid {
    fn new<const N: usize>(bounds: &Bounds) -> Self {
        let extent = bounds.max - bounds.min;
        Self {
            base: bounds.min,
            scale: Vec3A::select(extent.cmpgt(Vec3A::ZERO), N as f32 / extent, Vec3A::ZERO),
            width: extent / N as f32,
            last: Vec3A::splat((N - 1) as f32),
        }
    }

    /// First and last bin that a box is in, by axis.
    #[inline(always)]
    fn range(&self, bounds: &Bounds) -> [[u32; 3]; 2] {
        [bounds.min, bounds.max].map(|point| {
            let place = (point - self.base) * self.scale;
            let place = place.min(self.last).max(Vec3A::ZERO);
            place.to_array().map(|x| x as u32)
        })
    }

    /// Where `bin` begins.
    #[inline(always)]
    fn plane(&self, axis: usize, bin: usize) -> f32 {
        self.base[axis] + bin as f32 * self.width[axis]
    }

    fn fill<const N: usize>(&self, context: &Spatial, primitives: &[Primitive]) -> [Bins<N>; 3] {
        let fill_piece = |primitives: &[Primitive]| {
            let mut bins = [Bins::EMPTY; 3];
            primitives
                .iter()
                .for_each(|p| self.add_to(context, &mut bins, p));
            bins
        };
        if primitives.len() <= PARALLEL {
            return fill_piece(primitives);
        }
        primitives.par_chunks(PIECE).map(fill_piece).reduce(
            || [Bins::EMPTY; 3],
            |mut bins, others| {
                bins.iter_mut().zip(&others).for_each(|(b, o)| b.add(o));
                bins
            },
        )
    }

    fn add_to<const N: usize>(
        &self,
        context: &Spatial,
        bins: &mut [Bins<N>; 3],
        primitive: &Primitive,
    ) {
        let bounds = primitive.bounds();
        let [first, last] = self.range(&bounds);
        let clipper = if first == last {
            None
        } else {
            context.clipper(primitive)
        };
        for (axis, bins) in bins.iter_mut().enumerate() {
            let (first, last) = (first[axis] as usize % N, last[axis] as usize % N);
            bins.first[first] += 1;
            bins.last[last] += 1;
            let mut rest = bounds;
            if let Some(clipper) = &clipper {
                for bin in first..last {
                    let [below, above] = clipper.cut(&rest, axis, self.plane(axis, bin + 1));
                    bins.bounds[bin].add(&below);
                    rest = above;
                }
            }
            bins.bounds[last].add(&rest);
        }
    }
}

/// Along one axis: boxes of what is inside of each bin, and how many begin and end there.
struct Bins<const N: usize> {
    bounds: [Bounds; N],
    first: [u32; N],
    last: [u32; N],
}

impl<const N: usize> Bins<N> {
    const EMPTY: Self = Self {
        bounds: [Bounds::EMPTY; N],
        first: [0; N],
        last: [0; N],
    };

    fn add(&mut self, other: &Self) {
        for i in 0..N {
            self.bounds[i].add(&other.bounds[i]);
            self.first[i] += other.first[i];
            self.last[i] += other.last[i];
        }
    }

    /// What is on the right and on the left of `border`.
    fn sides(&self, border: usize) -> [(Bounds, u32); 2] {
        let around = |bins: &[Bounds]| {
            let mut all = Bounds::EMPTY;
            bins.iter().for_each(|b| all.add(b));
            all
        };
        let (left, right) = self.bounds.split_at(border);
        [
            (around(right), self.last[border..].iter().sum()),
            (around(left), self.first[..border].iter().sum()),
        ]
    }
}
