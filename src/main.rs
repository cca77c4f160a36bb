//! Halfshade.
fn main() {}
