//! What measurements say: fits and plots.

pub mod plot;
pub mod power_law;
