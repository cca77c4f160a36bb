//! The rays of a packet meet the triangles of a block.

use super::{FEW, Packet, row};
use crate::bvh::beam::{BeamTest, bounds};
use crate::bvh::filter::{Certain, Filter, corners_in};
use crate::bvh::hit::Hit;
use crate::bvh::layout::Tree;
use crate::bvh::simd::Lanes;

/// More triangles than this that a group may meet are tested by ray, where fewer rays may meet the block.
const MANY: u32 = 3;

impl Packet<'_> {
    /// Tests the rays of a group against triangles of a block; whether some found something. `bounds` are the
    /// block's, for whoever needs them first to set.
    #[inline(always)]
    pub fn meet<S: Lanes<W>, const ANY: bool, const W: usize>(
        &mut self,
        tree: &Tree<W>,
        place: usize,
        triangles: u32,
        group: usize,
        bounds: &mut Option<[[f32; 2]; 3]>,
    ) -> bool {
        let count = triangles.count_ones();
        if count > MANY {
            let block = &tree.blocks[place];
            let bounds = match bounds {
                Some(known) => known,
                None => bounds.insert(self::bounds::<S, W>(block)),
            };
            let rays = self.near::<S, W>(bounds, group);
            if rays.count_ones() < count {
                return self.meet_by_ray::<S, ANY, W>(tree, place, triangles, rays, group);
            }
        }
        let mut is_found = false;
        let mut rest = triangles;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize % W;
            rest &= rest - 1;
            is_found |= self.meet_one::<S, ANY, W>(tree, place, lane, group);
        }
        is_found
    }

    /// The rays of a group that may meet a box.
    #[inline(always)]
    fn near<S: Lanes<W>, const W: usize>(&self, bounds: &[[f32; 2]; 3], group: usize) -> u32 {
        let [x, y, z] = &self.origin;
        let [a, b, c] = self.course.center;
        let origins = [
            row::<S, W>(x, group).sub(S::splat(a)),
            row::<S, W>(y, group).sub(S::splat(b)),
            row::<S, W>(z, group).sub(S::splat(c)),
        ];
        let slopes = [row(&self.shear[0], group), row(&self.shear[1], group)];
        let far = row::<S, W>(&self.depth[self.far_end], group);
        let test = BeamTest::of_rays(&self.course, origins, slopes);
        self.live::<W>(group) & test.rays(bounds, far.max_abs(far))
    }

    /// Tests some rays of a group, one by one, against triangles of a block.
    #[inline(always)]
    fn meet_by_ray<S: Lanes<W>, const ANY: bool, const W: usize>(
        &mut self,
        tree: &Tree<W>,
        place: usize,
        triangles: u32,
        mut rays: u32,
        group: usize,
    ) -> bool {
        let block = &tree.blocks[place];
        let corners = corners_in::<S, W>(block, self.course.axes);
        let mut is_found = false;
        while rays != 0 {
            let lane = rays.trailing_zeros() as usize % W;
            rays &= rays - 1;
            let i = group * W + lane;
            let filter = Filter {
                axes: self.course.axes,
                origin: [
                    S::splat(self.origin[0][i]),
                    S::splat(self.origin[1][i]),
                    S::splat(self.origin[2][i]),
                ],
                shear: [S::splat(self.shear[0][i]), S::splat(self.shear[1][i])],
                is_reversed: self.course.is_reversed,
            };
            let depths = [S::splat(self.depth[0][i]), S::splat(self.depth[1][i])];
            let seen = filter.see(&corners);
            let lanes = seen.candidates(depths, triangles);
            if lanes == 0 {
                continue;
            }
            let certain = seen.certain(self.course.is_reversed);
            let mut sure = lanes & certain.lanes & S::splat(self.begin[i]).lt(certain.near);
            let mut doubtful = lanes & !sure;
            if ANY {
                sure &= certain.far.lt(S::splat(self.surely[i]));
                if sure != 0 {
                    self.end(1 << i);
                    is_found = true;
                    continue;
                }
                doubtful = lanes;
            } else if sure != 0 {
                let end = self.ahead(self.depth[self.far_end][i]);
                let nearest = certain.nearest(sure, self.surely[i], end);
                if let Some(lane) = nearest.lane {
                    self.holds |= 1 << i;
                    self.held[i] = (place * W + lane) as u32;
                    self.surely[i] = nearest.surely;
                    self.depth[self.far_end][i] = self.ahead(nearest.end);
                    is_found = true;
                }
                doubtful |= nearest.doubtful;
            }
            if doubtful != 0 {
                doubtful &= !filter.certainly_behind(&corners, &seen);
            }
            if doubtful != 0 {
                is_found |= self.look_at::<ANY, W>(tree, place, doubtful, i);
            }
        }
        is_found
    }

    /// Tests the rays of a group against the triangle in a lane of a block; whether some found something.
    #[inline(always)]
    fn meet_one<S: Lanes<W>, const ANY: bool, const W: usize>(
        &mut self,
        tree: &Tree<W>,
        place: usize,
        lane: usize,
        group: usize,
    ) -> bool {
        let block = &tree.blocks[place];
        let corners = block.corners_of(lane, self.course.axes);
        let [a, b, c] = &corners;
        let [x, y, z] = &self.origin;
        let filter = Filter {
            axes: self.course.axes,
            origin: [row(x, group), row(y, group), row(z, group)],
            shear: [row(&self.shear[0], group), row(&self.shear[1], group)],
            is_reversed: self.course.is_reversed,
        };
        let depths = [row(&self.depth[0], group), row(&self.depth[1], group)];
        let vectors = [splat::<S, W>(a), splat(b), splat(c)];
        let seen = filter.see(&vectors);
        let lanes = seen.candidates(depths, self.live::<W>(group));
        if lanes == 0 {
            return false;
        }
        let certain = seen.certain(self.course.is_reversed);
        let sure = lanes
            & certain.lanes
            & row::<S, W>(&self.begin, group).lt(certain.near)
            & certain.far.lt(row(&self.surely, group));
        let mut is_found = sure != 0;
        if ANY {
            self.end(u64::from(sure) << (group * W));
        } else {
            self.hold(&certain, sure, group, (place * W + lane) as u32);
        }
        let mut doubtful = lanes & !sure;
        if doubtful != 0 {
            doubtful &= !filter.certainly_behind(&vectors, &seen);
        }
        if doubtful != 0 {
            let triangle = block.triangles[lane];
            is_found |= self.decide::<ANY, W>(tree, &corners, triangle, group, doubtful);
        }
        is_found
    }

    /// Lets the rays `lanes` of a group hold a triangle.
    #[inline(always)]
    fn hold<S: Lanes<W>, const W: usize>(
        &mut self,
        certain: &Certain<S>,
        mut lanes: u32,
        group: usize,
        triangle: u32,
    ) {
        let (mut near, mut far) = ([0.0; W], [0.0; W]);
        certain.near.store(&mut near);
        certain.far.store(&mut far);
        self.holds |= u64::from(lanes) << (group * W);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % W;
            lanes &= lanes - 1;
            let i = group * W + lane;
            self.held[i] = triangle;
            self.surely[i] = near[lane];
            self.depth[self.far_end][i] = self.ahead(far[lane]);
        }
    }

    /// The exact test of one triangle for the rays `lanes` of a group; whether some found something better.
    #[inline(always)]
    fn decide<const ANY: bool, const W: usize>(
        &mut self,
        tree: &Tree<W>,
        corners: &[[f32; 3]; 3],
        triangle: u32,
        group: usize,
        lanes: u32,
    ) -> bool {
        self.settle(tree, self.holds & u64::from(lanes) << (group * W));
        if lanes.count_ones() <= FEW {
            return self.look::<ANY, W>(corners, triangle, group, lanes);
        }
        let [a, b, c] = corners;
        let crossings = self.cross::<false, W>(&[all(a), all(b), all(c)], group);
        let mut is_found = false;
        let mut hits = lanes & crossings.is_hit;
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize % W;
            hits &= hits - 1;
            let hit = Hit::of(crossings.get(lane), 0, triangle);
            is_found |= self.keep::<ANY>(group * W + lane, &hit);
        }
        is_found | self.look::<ANY, W>(corners, triangle, group, lanes & crossings.is_delicate)
    }

    /// The exact test of one triangle for the rays `lanes` of a group, one by one; whether some found something better.
    #[inline(never)]
    fn look<const ANY: bool, const W: usize>(
        &mut self,
        corners: &[[f32; 3]; 3],
        triangle: u32,
        group: usize,
        mut lanes: u32,
    ) -> bool {
        let mut is_found = false;
        while lanes != 0 {
            let i = group * W + lanes.trailing_zeros() as usize % W;
            lanes &= lanes - 1;
            if let Some(crossing) = self.exact(i).cross(corners) {
                is_found |= self.keep::<ANY>(i, &Hit::of(crossing, 0, triangle));
            }
        }
        is_found
    }

    /// The exact test of some triangles of a block for ray `i`; whether it found something better.
    #[inline(never)]
    fn look_at<const ANY: bool, const W: usize>(
        &mut self,
        tree: &Tree<W>,
        place: usize,
        mut triangles: u32,
        i: usize,
    ) -> bool {
        self.settle(tree, self.holds & 1 << i);
        let block = &tree.blocks[place];
        let mut is_found = false;
        while triangles != 0 {
            let lane = triangles.trailing_zeros() as usize % W;
            triangles &= triangles - 1;
            let corners = block.corners_of(lane, self.course.axes);
            if let Some(crossing) = self.exact(i).cross(&corners) {
                is_found |= self.keep::<ANY>(i, &Hit::of(crossing, 0, block.triangles[lane]));
            }
        }
        is_found
    }
}

/// The same point for each ray of a group, by axis.
#[inline(always)]
fn all<const W: usize>(point: &[f32; 3]) -> [[f32; W]; 3] {
    [[point[0]; W], [point[1]; W], [point[2]; W]]
}

#[inline(always)]
fn splat<S: Lanes<W>, const W: usize>(point: &[f32; 3]) -> [S; 3] {
    [S::splat(point[0]), S::splat(point[1]), S::splat(point[2])]
}
