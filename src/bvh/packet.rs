//! Packets: rays that run nearly the same way go through a tree together.
//!
//! The tree is walked once for all of them, by what their [`Beam`] may meet. At the leaves the beams of
//! groups, as many rays as a vector holds, sort out triangles, and each that is left is tested against all rays
//! of its group at once. Hits are those of single rays, bit for bit: the exact test decides here
//! too.

use super::beam::{Beam, BeamTest, Course, Interval};
use super::caster::{AXES, first_depth, is_ordinary, last_depth, main_axis, turned};
use super::filter::Filter;
use super::hit::{Hit, Search, key};
use super::layout::{Block, ChildRef, Tree};
use super::simd::{Entry, Job, Lanes, Stack, prefetch};
use super::traverse::nearest_child;
use super::triangle::{ExactRay, ExactRays};
use crate::math::Ray;

/// The most rays of a packet.
pub(super) const SIZE: usize = 64;

/// The most groups of a packet: of 8 rays.
const GROUPS: usize = SIZE / 8;

/// Slopes that differ by more are not traced together: the beam would hold much that no ray meets.
const MOST_SPREAD: f32 = 0.25;

/// Packets that have been to so many leaves and are not done are broken up: what the beam holds is too much of too small triangles.
const MOST_LOOKS: usize = 12;

/// Of so many rays at a time, and fewer, each is tested by itself.
const FEW: u32 = 2;

/// One number for each ray.
type PerRay = [f32; SIZE];

/// Rays that have the main axis in common, coordinates in the order of the course's axes.
struct Packet {
    course: Course,
    origin: [PerRay; 3],
    direction: [PerRay; 3],
    /// Slopes along the main axis, each rounded twice.
    shear: [PerRay; 2],
    /// Where hits still matter: least and greatest depth.
    depth: [PerRay; 2],
    /// Which of the two is the far end: 1 where the rays run towards higher coordinates.
    far_end: usize,
    /// A bit for each ray that still looks for something.
    live: u64,
}

impl Packet {
    /// `None` where the rays do not have their main axis in common, or are extreme. `reach` is the largest coordinate
    /// of the tree.
    #[inline(always)]
    fn gather(rays: &[Ray], reach: f32) -> Option<Self> {
        let first = rays.first()?;
        let main = main_axis(first.direction.to_array());
        let axes = AXES[main];
        let is_reversed = first.direction[main] < 0.0;
        let far_end = usize::from(!is_reversed);
        let mut packet = Self {
            course: Course {
                center: turned(first.origin.to_array(), axes),
                axes,
                is_reversed,
                size: reach,
            },
            origin: [[0.0; SIZE]; 3],
            direction: [[0.0; SIZE]; 3],
            shear: [[0.0; SIZE]; 2],
            depth: [[0.0; SIZE]; 2],
            far_end,
            live: u64::MAX >> (SIZE - rays.len().min(SIZE)),
        };
        let mut is_alike = true;
        for i in 0..SIZE {
            // The last ray stands for those that are not there.
            let ray = &rays[i.min(rays.len() - 1)];
            let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
            is_alike &= (main_axis(direction) == main)
                & ((direction[main] < 0.0) == is_reversed)
                & is_ordinary(origin, direction[main], reach)
                & ray.direction.is_finite()
                & !ray.t_max.is_nan();
            let (origin, direction) = (turned(origin, axes), turned(direction, axes));
            for k in 0..3 {
                packet.origin[k][i] = origin[k];
                packet.direction[k][i] = direction[k];
            }
            packet.depth[1 - far_end][i] = ray.t_min.max(0.0);
            packet.depth[far_end][i] = ray.t_max;
        }
        if !is_alike {
            return None;
        }
        for i in 0..SIZE {
            let main = packet.direction[2][i];
            let main_inverse = 1.0 / main;
            packet.shear[0][i] = packet.direction[0][i] * main_inverse;
            packet.shear[1][i] = packet.direction[1][i] * main_inverse;
            packet.depth[1 - far_end][i] = first_depth(packet.depth[1 - far_end][i], main);
            packet.depth[far_end][i] = last_depth(packet.depth[far_end][i], main);
        }
        // Those that are not there look nowhere.
        packet.depth[far_end][rays.len().min(SIZE)..].fill(0.0);
        Some(packet)
    }

    /// Around the rays of a group, and the largest coordinate of their origins.
    #[inline(always)]
    fn beam<S: Lanes<W>, const W: usize>(&self, group: usize) -> (Beam, f32) {
        let [x, y, z] = &self.origin;
        let [x, y, z] = [row::<S, W>(x, group), row(y, group), row(z, group)];
        let [a, b, c] = self.course.center;
        let beam = Beam {
            origins: [
                Interval::around(x.sub(S::splat(a))),
                Interval::around(y.sub(S::splat(b))),
                Interval::around(z.sub(S::splat(c))),
            ],
            slopes: [
                Interval::around(row::<S, W>(&self.shear[0], group)),
                Interval::around(row::<S, W>(&self.shear[1], group)),
            ],
        };
        (beam, x.max_abs(y).max_abs(z).greatest())
    }

    /// The depth behind which no ray of a group needs to look, in the direction of the rays.
    #[inline(always)]
    fn far<S: Lanes<W>, const W: usize>(&self, group: usize) -> f32 {
        let ends = row::<S, W>(&self.depth[self.far_end], group);
        ends.max_abs(ends).greatest()
    }

    /// The rays of a group that still look for something, a bit for each.
    #[inline(always)]
    fn live<const W: usize>(&self, group: usize) -> u32 {
        (self.live >> (group * W)) as u32 & (u32::MAX >> (32 - W))
    }

    #[inline(always)]
    fn exact(&self, i: usize) -> ExactRay {
        let of = |rows: &[PerRay; 3]| [rows[0][i], rows[1][i], rows[2][i]];
        ExactRay::new(of(&self.origin), of(&self.direction))
    }

    /// Keeps `hit` of ray `i` where it is better than what that has; whether it is.
    #[inline(always)]
    fn keep<const ANY: bool>(&mut self, i: usize, search: &mut Search, hit: Hit) -> bool {
        if !search.is_better(hit.t, key(0, hit.triangle)) {
            return false;
        }
        search.keep(hit);
        self.depth[self.far_end][i] = if ANY {
            self.live &= !(1 << i);
            0.0
        } else {
            last_depth(hit.t, self.direction[2][i])
        };
        true
    }
}

/// A vector of one number for each ray of a group.
#[inline(always)]
fn row<S: Lanes<W>, const W: usize>(row: &PerRay, group: usize) -> S {
    S::load(array(row, group))
}

#[inline(always)]
fn array<const W: usize>(row: &PerRay, group: usize) -> &[f32; W] {
    &row.as_chunks::<W>().0[group]
}

/// The way of some rays through a tree, to be compiled for each kind of vectors.
///
/// With `ANY` each ray's first hit, wherever it is, ends its search. Returns the rays whose search is to be gone on with
/// one by one, a bit for each: all of them where they do not run the same way.
pub(super) struct Trace<'a, const ANY: bool, const W: usize> {
    pub tree: &'a Tree<W>,
    /// Largest coordinate of the tree.
    pub reach: f32,
    /// At most [`SIZE`].
    pub rays: &'a [Ray],
    /// One for each ray.
    pub searches: &'a mut [Search],
}

impl<const ANY: bool, const W: usize> Job<W> for Trace<'_, ANY, W> {
    type Output = u64;

    #[inline(always)]
    fn run<S: Lanes<W>>(self) -> u64 {
        let Self {
            tree,
            reach,
            rays,
            searches,
        } = self;
        let Some(mut packet) = Packet::gather(rays, reach) else {
            return u64::MAX;
        };
        let groups = rays.len().div_ceil(W);
        let (mut all, size) = packet.beam::<S, W>(0);
        let mut beams = [all; GROUPS];
        packet.course.size = if size > reach { size } else { reach };
        for (group, kept) in beams.iter_mut().enumerate().take(groups).skip(1) {
            let (beam, size) = packet.beam::<S, W>(group);
            all = all.union(&beam);
            *kept = beam;
            if size > packet.course.size {
                packet.course.size = size;
            }
        }
        let is_narrow = all.slopes[0].high - all.slopes[0].low <= MOST_SPREAD
            && all.slopes[1].high - all.slopes[1].low <= MOST_SPREAD;
        if !is_narrow {
            return packet.live;
        }

        for beam in &mut beams {
            *beam = beam.widened(&packet.course);
        }
        let beam = BeamTest::<S>::new(&packet.course, &all.widened(&packet.course));
        let mut fars = [0.0; GROUPS];
        for (group, far) in fars.iter_mut().enumerate().take(groups) {
            *far = packet.far::<S, W>(group);
        }
        let mut far = greatest(&fars);
        let mut looks = 0;
        let mut stack = Stack::new();
        stack.push(Entry::new(0.0, ChildRef::node(0)));
        while let Some(entry) = stack.pop() {
            if entry.distance() > far {
                continue;
            }
            let mut current = entry.child();
            while !current.is_leaf() {
                let node = &tree.nodes[current.index()];
                let (mask, enter) = beam.children(node, S::splat(far));
                let announce = |entry: Entry| match entry.child() {
                    leaf if leaf.is_leaf() => prefetch(&tree.blocks, leaf.index()),
                    child => prefetch(&tree.nodes, child.index()),
                };
                match nearest_child::<S, false, W>(node, mask, enter, &mut stack, announce) {
                    Some(child) => current = child,
                    None => break,
                }
            }
            if !current.is_leaf() {
                continue;
            }
            let block = &tree.blocks[current.index()];
            let there = u32::MAX >> (32 - current.count());
            for group in 0..groups {
                if packet.live::<W>(group) == 0 {
                    continue;
                }
                let test = BeamTest::<S>::new(&packet.course, &beams[group]);
                let mut triangles = there & test.triangles(block, S::splat(fars[group]));
                let mut is_found = false;
                while triangles != 0 {
                    let lane = triangles.trailing_zeros() as usize % W;
                    triangles &= triangles - 1;
                    is_found |= meet::<S, ANY, W>(&mut packet, searches, block, lane, group);
                }
                if is_found {
                    fars[group] = packet.far::<S, W>(group);
                    far = greatest(&fars);
                }
            }
            if ANY && packet.live == 0 {
                return 0;
            }
            looks += 1;
            if looks > MOST_LOOKS {
                return packet.live;
            }
        }
        0
    }
}

#[inline(always)]
fn greatest(fars: &[f32; GROUPS]) -> f32 {
    let mut greatest = 0.0;
    for &far in fars {
        if far > greatest {
            greatest = far;
        }
    }
    greatest
}

/// Tests the rays of a group against one triangle; whether some found something.
#[inline(always)]
fn meet<S: Lanes<W>, const ANY: bool, const W: usize>(
    packet: &mut Packet,
    searches: &mut [Search],
    block: &Block<W>,
    lane: usize,
    group: usize,
) -> bool {
    let corners = block.corners_of(lane, packet.course.axes);
    let [a, b, c] = &corners;
    let [x, y, z] = &packet.origin;
    let filter = Filter {
        axes: packet.course.axes,
        origin: [row(x, group), row(y, group), row(z, group)],
        shear: [row(&packet.shear[0], group), row(&packet.shear[1], group)],
    };
    let depths = [row(&packet.depth[0], group), row(&packet.depth[1], group)];
    let vectors = [splat::<S, W>(a), splat(b), splat(c)];
    let lanes = filter.candidates(&vectors, depths, packet.live::<W>(group));
    if lanes == 0 {
        return false;
    }
    let triangle = block.triangles[lane];
    if lanes.count_ones() <= FEW {
        return decide_one_by_one::<ANY>(packet, searches, &corners, triangle, group * W, lanes);
    }
    let [ox, oy, oz] = &packet.origin;
    let [dx, dy, dz] = &packet.direction;
    let rays = ExactRays::<W> {
        origin: [array(ox, group), array(oy, group), array(oz, group)],
        direction: [array(dx, group), array(dy, group), array(dz, group)],
    };
    let crossings = rays.cross(&corners);
    let mut found = false;
    let mut hits = lanes & crossings.is_hit;
    while hits != 0 {
        let lane = hits.trailing_zeros() as usize % W;
        hits &= hits - 1;
        let i = group * W + lane;
        let hit = Hit {
            t: crossings.t[lane],
            u: crossings.u[lane],
            v: crossings.v[lane],
            triangle,
            instance: 0,
        };
        found |= packet.keep::<ANY>(i, &mut searches[i], hit);
    }
    let delicate = lanes & crossings.is_delicate;
    if delicate != 0 {
        found |=
            decide_one_by_one::<ANY>(packet, searches, &corners, triangle, group * W, delicate);
    }
    found
}

#[inline(always)]
fn splat<S: Lanes<W>, const W: usize>(point: &[f32; 3]) -> [S; 3] {
    [S::splat(point[0]), S::splat(point[1]), S::splat(point[2])]
}

/// The exact test of one triangle for the rays `first` plus each of `lanes`.
#[inline(never)]
fn decide_one_by_one<const ANY: bool>(
    packet: &mut Packet,
    searches: &mut [Search],
    corners: &[[f32; 3]; 3],
    triangle: u32,
    first: usize,
    mut lanes: u32,
) -> bool {
    let mut found = false;
    while lanes != 0 {
        let i = first + lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        let Some(crossing) = packet.exact(i).cross(corners) else {
            continue;
        };
        let hit = Hit {
            t: crossing.t,
            u: crossing.u,
            v: crossing.v,
            triangle,
            instance: 0,
        };
        found |= packet.keep::<ANY>(i, &mut searches[i], hit);
    }
    found
}
