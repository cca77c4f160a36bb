//! What a tree is like.

use super::layout::{ChildRef, Tree};

/// Size and shape of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeStats {
    /// Triangles in it: those given, without those that can never be hit.
    pub triangles: usize,
    /// Inner nodes.
    pub nodes: usize,
    /// Blocks of triangles.
    pub leaves: usize,
    /// Levels of inner nodes.
    pub depth: usize,
    /// Expected number of node and leaf visits of a random line that meets the root's box and
    /// hits nothing: areas of nodes and leaves, as shares of the root's.
    pub sah_cost: f64,
    /// Children per node, on average.
    pub children_per_node: f64,
    /// Triangles per leaf, on average.
    pub triangles_per_leaf: f64,
}

impl TreeStats {
    pub(super) fn of<const W: usize>(tree: &Tree<W>) -> Self {
        let root_area = f64::from(tree.bounds.half_area());
        let (mut area, mut children, mut depth) = (root_area, 0usize, 0);
        let mut open = vec![(ChildRef::node(0), 1)];
        while let Some((node, level)) = open.pop().filter(|_| !tree.nodes.is_empty()) {
            depth = depth.max(level);
            for (bounds, child) in tree.nodes[node.index()].iter() {
                children += 1;
                area += f64::from(bounds.half_area());
                if !child.is_leaf() {
                    open.push((child, level + 1));
                }
            }
        }
        let share = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        let leaves = tree.blocks.len();
        Self {
            triangles: tree.triangles,
            nodes: tree.nodes.len(),
            leaves,
            depth,
            sah_cost: if tree.nodes.is_empty() {
                leaves as f64
            } else {
                share(area, root_area)
            },
            children_per_node: share(children as f64, tree.nodes.len() as f64),
            triangles_per_leaf: share(tree.triangles as f64, leaves as f64),
        }
    }
}
