//! Rows: a number for each of up to 64 samples that are computed together.
//!
//! What is computed for rows is a loop over the function that computes it for one sample: straight
//! arithmetic, which the compiler turns into vectors without changing a bit of it. [`widely`] runs
//! such a loop compiled for the widest vectors that the processor has.

use glam::Vec3;
use pulp::Arch;

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

/// Runs `job` compiled for the widest vectors of the processor; the result has the same bits with all.
pub fn widely<J: RowJob>(job: J) -> J::Output {
    Arch::new().dispatch(job)
}
