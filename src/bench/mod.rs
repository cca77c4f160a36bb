//! Measuring the tracing core and whole renders.
//!
//! Triangles and rays go in, from files or made here; times, sizes and counts come out, as medians
//! of repeats with their spread, processor time beside wall time. What is compared takes turns, so
//! that whatever else the machine does hits all alike.

mod clock;
mod features;
mod generated;
mod measure;
mod own_rays;
mod ray_file;
mod ray_set;
mod triangles;

pub use clock::{Elapsed, Spread, Stopwatch, Timing, processor_seconds};
pub use features::{FeatureCell, FeaturePlan, FeatureReport, bench_features};
pub use generated::Generated;
pub use measure::{Plan, RayReport, TreeReport, measure, width_name};
pub use own_rays::own_rays;
pub use ray_file::{read_rays, write_hits, write_rays};
pub use ray_set::{Query, RaySet};
pub use triangles::Triangles;
