//! Rows: a number for each of up to 64 samples that are computed together.
//!
//! What is computed for rows is a loop over the function that computes it for one sample: straight
//! arithmetic, which the compiler turns into vectors without changing a bit of it. [`widely`] runs
//! such a loop compiled for the widest vectors that the processor has.

use glam::Vec3;
use pulp::Arch;

use super::Ray;

/// Something to be compiled for each instruction set: its `call` must be `#[inline(always)]`, and so must be
/// what that calls. It writes to rows of its own, which it returns: the compiler knows that nothing else
/// reads them meanwhile.
pub use pulp::NullaryFnOnce as RowJob;

/// The most samples that are computed together.
pub const ROW: usize = 64;

/// Below so many samples each by itself is quicker than a whole row.
pub const FEW: usize = 12;

/// One number for each sample.
pub type Row = [f32; ROW];

/// One vector for each sample, by axis.
#[derive(Clone, Copy, Debug)]
pub struct VectorRow(pub [Row; 3]);

impl VectorRow {
    /// All of them zero.
    pub const ZERO: Self = Self([[0.0; ROW]; 3]);

    /// The z axis for each.
    pub const Z: Self = Self([[0.0; ROW], [0.0; ROW], [1.0; ROW]]);

    /// The vector of sample `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[i], y[i], z[i])
    }

    /// Makes `v` the vector of sample `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Vec3) {
        let [x, y, z] = &mut self.0;
        (x[i], y[i], z[i]) = (v.x, v.y, v.z);
    }
}

/// Up to [`ROW`] rays.
#[derive(Clone, Copy, Debug)]
pub struct RayRow {
    /// Where they start.
    pub origins: VectorRow,
    /// Where they go.
    pub directions: VectorRow,
    /// As of [`Ray`].
    pub t_min: Row,
    /// As of [`Ray`].
    pub t_max: Row,
    count: usize,
}

impl RayRow {
    /// No rays.
    pub const EMPTY: Self = Self {
        origins: VectorRow::ZERO,
        directions: VectorRow::ZERO,
        t_min: [0.0; ROW],
        t_max: [0.0; ROW],
        count: 0,
    };

    /// How many there are.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.count
    }

    /// `count` rays without an end, whose origins and directions are still to be set.
    #[inline(always)]
    pub fn endless(count: usize) -> Self {
        Self {
            t_max: [f32::INFINITY; ROW],
            count,
            ..Self::EMPTY
        }
    }

    /// Adds a ray; there must be room.
    #[inline(always)]
    pub fn push(&mut self, ray: &Ray) {
        self.set(self.count, ray);
        self.count += 1;
    }

    #[inline(always)]
    fn set(&mut self, i: usize, ray: &Ray) {
        self.origins.set(i, ray.origin);
        self.directions.set(i, ray.direction);
        self.t_min[i] = ray.t_min;
        self.t_max[i] = ray.t_max;
    }

    /// Keeps the rays with a bit in `of`, and moves them together.
    pub fn keep(&mut self, of: u64) {
        self.count = of.count_ones() as usize;
        for (to, from) in places(of).enumerate().filter(|(to, from)| to != from) {
            self.set(to, &self.get(from));
        }
    }

    /// Ray `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Ray {
        Ray {
            origin: self.origins.get(i),
            direction: self.directions.get(i),
            t_min: self.t_min[i],
            t_max: self.t_max[i],
        }
    }
}

/// Of [`ROW`] rays at most.
impl<'a> FromIterator<&'a Ray> for RayRow {
    fn from_iter<I: IntoIterator<Item = &'a Ray>>(rays: I) -> Self {
        let mut row = Self::EMPTY;
        rays.into_iter().for_each(|ray| row.push(ray));
        row
    }
}

/// Runs `job` compiled for the widest vectors of the processor; the result has the same bits with all.
pub fn widely<J: RowJob>(job: J) -> J::Output {
    Arch::new().dispatch(job)
}

/// A bit for each of the first `count` samples of a row.
#[inline(always)]
pub fn first_places(count: usize) -> u64 {
    u64::MAX.checked_shr((ROW - count) as u32).unwrap_or(0)
}

/// The places of the bits of `row`, in rising order.
#[inline(always)]
pub fn places(mut row: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (row != 0).then(|| {
            let place = row.trailing_zeros() as usize % ROW;
            row &= row - 1;
            place
        })
    })
}

/// A bit for each sample of which this is so.
#[inline(always)]
pub fn those_where(is_so: &[bool; ROW]) -> u64 {
    (0..ROW).fold(0, |all, i| all | u64::from(is_so[i]) << i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_that_are_kept_move_together_in_their_order() {
        for of in [0, 1, u64::MAX, 1 << 63, 0x8421_0000_ffff_0013] {
            let mut rays = RayRow::EMPTY;
            for i in 0..ROW {
                rays.push(&Ray::new(Vec3::splat(i as f32), Vec3::X));
            }
            rays.keep(of);
            assert_eq!(rays.count(), of.count_ones() as usize);
            for (to, from) in places(of).enumerate() {
                assert!(of >> from & 1 == 1);
                assert_eq!(rays.get(to).origin, Vec3::splat(from as f32));
            }
        }
        for count in [0, 1, 63, ROW] {
            assert_eq!(places(first_places(count)).count(), count);
            assert!(places(first_places(count)).eq(0..count));
        }
    }
}
