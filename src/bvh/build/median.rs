//! Splits into equal halves.

use super::part::Part;
use super::primitive::Primitive;

/// Splits into halves at the median of the centroids along the longest axis of their box;
/// among equals the lower indices go first.
pub(super) fn split_median(part: Part<'_>) -> (Part<'_>, Part<'_>) {
    let axis = part.centroids.to_aabb().longest_axis();
    let middle = part.len() / 2;
    part.primitives.select_nth_unstable_by(middle, |a, b| {
        let along = |p: &Primitive| p.centroid()[axis];
        along(a)
            .total_cmp(&along(b))
            .then(a.index().cmp(&b.index()))
    });
    let (left, right) = part.primitives.split_at_mut(middle);
    (Part::new(left), Part::new(right))
}
