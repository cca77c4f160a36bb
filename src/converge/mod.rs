//! Error against run time: a scene rendered by many methods, each measured against one reference.
//!
//! A [`Method`] with a number of samples, rendered with several seeds, is a [`Point`]; doubling numbers of
//! samples make a curve, for which an [`ErrorLaw`] tells how fast its error falls and what of it stays. A
//! [`Study`] holds all of it. The reference knows its own noise, which is subtracted; what is no larger is
//! not known, and stands nowhere as if it were ([`Floor`]).

mod against;
mod chart;
mod choice;
mod csv;
mod digest;
mod fit;
mod floor;
mod measure;
mod method;
mod page;
mod page_tables;
mod point;
mod reference;
mod study;
mod time_to_error;
mod views;

pub use against::{AgainstError, OtherPoint, read_curves};
pub use chart::svg;
pub use csv::csv;
pub use digest::digest;
pub use fit::ErrorLaw;
pub use floor::{Floor, Floors};
pub use measure::{LeftOut, Measured, Plan, Subject, measure};
pub use method::{Method, MethodError};
pub use page::page;
pub use point::{Point, Rays};
pub use reference::{About, Reference};
pub use study::{Machine, ReferenceReport, Seconds, Slope, Study, TimeToError};
pub use time_to_error::{GOALS, Reached};
pub use views::View;
