//! Splits into equal halves.

use super::part::{Part, scan};
use super::primitive::Primitive;

/// Splits into halves at the median of the centroids along the longest axis of their box;
/// among equals the lower indices go first.
pub(super) fn split_median(mut part: Part<'_>) -> (Part<'_>, Part<'_>) {
    let axis = part.centroids.to_aabb().longest_axis();
    let middle = part.len() / 2;
    let primitives = part.primitives_mut();
    primitives.select_nth_unstable_by(middle, |a, b| {
        let along = |p: &Primitive| p.centroid()[axis];
        along(a)
            .total_cmp(&along(b))
            .then(a.index().cmp(&b.index()))
    });
    let [left, right] = [&primitives[..middle], &primitives[middle..]].map(scan);
    part.cut(middle, [right.0, left.0], [right.1, left.1])
}
