//! The fast builder: triangles in clusters of neighbours along the Morton curve, the surface area
//! heuristic over and within clusters.
//!
//! Sorting finds the neighbours without a look at the levels above; the tree over the clusters
//! then is a hundredth of the work and makes up for what the curve does not see (the idea of
//! Pantaleoni and Luebke 2010, "HLBVH: Hierarchical LBVH Construction for Real-Time Ray
//! Tracing", with the mini-trees of Ganestam et al. 2015, "Bonsai: Rapid Bounding Volume
//! Hierarchy Generation using Mini Trees").

use rayon::prelude::*;

use super::SMALL;
use super::binned::Binned;
use super::bounds::Bounds;
use super::collapse::Branches;
use super::fragment::Fragment;
use super::morton::{Curve, Key, code, number, scatter};
use super::part::Part;
use super::primitive::Primitive;
use super::wide::{Splitter, grow, make_tree};

/// Most triangles of a cluster.
const CLUSTER: usize = 64;

/// Builds the tree of `primitives`, whose centroids are in `centroids`.
pub(super) fn make_clustered_tree<const W: usize>(
    primitives: Vec<Primitive>,
    centroids: &Bounds,
) -> Fragment<W> {
    let clusters = Clusters::<W>::new(primitives, centroids);
    let mut boxes: Vec<Primitive> = (0..clusters.starts.len())
        .into_par_iter()
        .map(|i| {
            let mut bounds = Bounds::EMPTY;
            clusters
                .members(i)
                .iter()
                .for_each(|p| bounds.add(&p.bounds()));
            Primitive::new(bounds.min, bounds.max, i as u32)
        })
        .collect();
    make_tree(Part::new(&mut boxes), &clusters)
}

/// Primitives, cluster by cluster.
struct Clusters<const W: usize> {
    sorted: Vec<Primitive>,
    /// Where each cluster begins.
    starts: Vec<u32>,
}

impl<const W: usize> Clusters<W> {
    fn new(primitives: Vec<Primitive>, centroids: &Bounds) -> Self {
        let curve = Curve::new(centroids);
        let keys: Vec<Key> = primitives
            .par_iter()
            .enumerate()
            .with_min_len(1 << 12)
            .map(|(i, p)| curve.key(p.centroid(), i as u32))
            .collect();
        let (mut keys, buckets) = scatter(&keys);
        let mut rest = keys.as_mut_slice();
        let buckets: Vec<&mut [Key]> = buckets
            .into_iter()
            .map(|size| {
                let (bucket, others) = std::mem::take(&mut rest).split_at_mut(size);
                rest = others;
                bucket
            })
            .collect();
        let sizes: Vec<Vec<u32>> = buckets
            .into_par_iter()
            .map(|bucket| {
                let mut sizes = Vec::new();
                bucket.sort_unstable();
                cut(bucket, &primitives, &mut sizes);
                sizes
            })
            .collect();
        let mut end = 0;
        let starts = sizes.into_iter().flatten().map(|size| {
            end += size;
            end - size
        });
        Self {
            starts: starts.collect(),
            sorted: keys
                .par_iter()
                .with_min_len(1 << 12)
                .map(|&key| primitives[number(key)])
                .collect(),
        }
    }

    fn members(&self, cluster: usize) -> &[Primitive] {
        let end = self.starts.get(cluster + 1);
        let end = end.map_or(self.sorted.len(), |&end| end as usize);
        &self.sorted[self.starts[cluster] as usize..end]
    }
}

/// Cuts sorted keys into clusters where the highest bit of their codes changes.
///
/// What falls into a single cell is sorted anew along a finer curve. That makes the cell a
/// thousandth as large, so the range of floats ends it soon.
fn cut(keys: &mut [Key], primitives: &[Primitive], sizes: &mut Vec<u32>) {
    let (Some(&first), Some(&last)) = (keys.first(), keys.last()) else {
        return;
    };
    if keys.len() <= CLUSTER {
        sizes.push(keys.len() as u32);
        return;
    }
    let differing = code(first) ^ code(last);
    if differing != 0 {
        let bit = 1 << differing.ilog2();
        let middle = keys.partition_point(|&key| code(key) & bit == 0);
        let (low, high) = keys.split_at_mut(middle);
        cut(low, primitives, sizes);
        cut(high, primitives, sizes);
        return;
    }
    let mut centroids = Bounds::EMPTY;
    for &key in &*keys {
        centroids.add_point(primitives[number(key)].centroid());
    }
    let finer = Curve::new(&centroids);
    for key in &mut *keys {
        let i = number(*key);
        *key = finer.key(primitives[i].centroid(), i as u32);
    }
    keys.sort_unstable();
    if code(keys[0]) == code(keys[keys.len() - 1]) {
        sizes.extend(keys.chunks(CLUSTER).map(|chunk| chunk.len() as u32));
    } else {
        cut(keys, primitives, sizes);
    }
}

/// Over clusters, which open at the bottom.
impl<const N: usize> Splitter for Clusters<N> {
    fn leaf_size(&self) -> usize {
        1
    }

    fn small(&self) -> usize {
        SMALL / CLUSTER
    }

    fn split<'a>(&self, part: Part<'a>) -> Result<(Part<'a>, Part<'a>), Part<'a>> {
        Binned { leaf_size: 1 }.split(part)
    }

    fn grow_leaf<const W: usize>(
        &self,
        part: Part<'_>,
        depth: usize,
        out: &mut Branches<W>,
    ) -> usize {
        let mut members = self.members(part.primitives()[0].index() as usize).to_vec();
        grow(
            Part::new(&mut members),
            &Binned { leaf_size: N },
            depth,
            out,
        )
    }
}
