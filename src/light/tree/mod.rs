//! Choosing one light among many, by how much each may give to a point.
//!
//! A binary tree over the lights, each node with bounds of where its lights are, which way they
//! shine and how strong they are (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
//! Adaptive Tree Splitting"). A walk from the root picks a child by those bounds at every node, so
//! that choosing, and saying how likely a choice is, takes the logarithm of the number of lights.

mod bounds;
mod build;
mod importance;

pub use bounds::{LightBounds, Receiver};
use importance::Group;

/// A tree over lights that are somewhere: all but those that are infinitely far away.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    /// The first is the root; siblings stand side by side.
    nodes: Vec<Node>,
    /// By light: its leaf; `NONE` for those without power, which are never chosen.
    leaves: Vec<u32>,
}

/// The leaf of a light that has none, and the parent of the root.
const NONE: u32 = u32::MAX;

#[derive(Clone, Debug)]
struct Node {
    group: Group,
    parent: u32,
    content: Content,
}

#[derive(Clone, Copy, Debug)]
enum Content {
    /// The number of a light.
    Light(u32),
    /// The first of two nodes.
    Children(u32),
}

impl LightTree {
    /// A tree over `lights`; those without power, `None`, are left out but counted.
    pub fn build(lights: &[Option<LightBounds>]) -> Self {
        build::build(lights)
    }

    /// Whether there is nothing to choose.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// A light for `receiver` by the number `u` in `[0, 1)`, and the probability of that choice.
    ///
    /// `None` where the walk comes to lights none of which can reach the receiver.
    pub fn choose(&self, receiver: &Receiver, mut u: f64) -> Option<(u32, f64)> {
        let mut node = self.nodes.first()?;
        let mut probability = 1.0;
        loop {
            let first = match node.content {
                Content::Light(light) => return Some((light, probability)),
                Content::Children(first) => first as usize,
            };
            let share = self.share_of_first(first, receiver)?;
            let is_first = u < share;
            let (child, chance) = if is_first {
                u /= share;
                (first, share)
            } else {
                u = (u - share) / (1.0 - share);
                (first + 1, 1.0 - share)
            };
            // Rounding may bring it to 1.
            u = u.min(1.0 - f64::EPSILON);
            probability *= chance;
            node = &self.nodes[child];
        }
    }

    /// The probability with which [`Self::choose`] picks `light`.
    pub fn probability(&self, receiver: &Receiver, light: u32) -> f64 {
        let mut node = self.leaves[light as usize];
        if node == NONE {
            return 0.0;
        }
        let mut probability = 1.0;
        loop {
            let parent = self.nodes[node as usize].parent;
            if parent == NONE {
                return probability;
            }
            let Content::Children(first) = self.nodes[parent as usize].content else {
                return probability;
            };
            let share = match self.share_of_first(first as usize, receiver) {
                None => return 0.0,
                Some(share) if first == node => share,
                Some(share) => 1.0 - share,
            };
            probability *= share;
            node = parent;
        }
    }

    /// The probability of the first of two siblings; `None` where neither reaches `receiver`.
    fn share_of_first(&self, first: usize, receiver: &Receiver) -> Option<f64> {
        let [a, b] = [first, first + 1].map(|i| self.nodes[i].group.importance(receiver));
        let sum = a + b;
        (sum > 0.0).then(|| a / sum)
    }

    /// Bytes of its arrays.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.leaves.as_slice())
    }
}
