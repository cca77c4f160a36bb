//! The node hierarchy: that it is a forest, where its nodes are, and which are shown.
//!
//! Everything is iterative: a chain of a million nodes is legal.

#[cfg(feature = "draco")]
use std::collections::BTreeSet;

use serde::Deserialize;

use super::document::{Document, Node};
use super::extensions::NODE_VISIBILITY;
use crate::import::{WarningCode, Warnings};
use crate::math::{DAffine3, DMat4, DQuat, DVec3};

/// Something wrong at a place.
pub type Misplaced = (String, String);

/// Where nodes are in the world, and which are shown.
#[derive(Debug)]
pub struct Graph {
    worlds: Worlds,
    /// The nodes of the scene, parents before their children, in file order.
    pub shown: Vec<usize>,
    /// By node: whether it is hidden; empty where none is.
    hidden: Vec<bool>,
}

/// From nodes' coordinates to the world's. Nodes without a transform share that of their parent.
#[derive(Debug)]
struct Worlds {
    transforms: Vec<DAffine3>,
    /// By node: which of the transforms, or [`Worlds::NOWHERE`].
    of_node: Vec<u32>,
}

impl Worlds {
    /// The place of what is outside of all nodes.
    const ROOT: u32 = 0;
    /// The place of nodes whose transform is not finite.
    const NOWHERE: u32 = u32::MAX;
}

impl Graph {
    /// From the coordinates of node `index` to the world's; `None` where that is not finite.
    pub fn world(&self, index: usize) -> Option<&DAffine3> {
        let place = *self.worlds.of_node.get(index)?;
        self.worlds.transforms.get(place as usize)
    }

    /// The meshes of the nodes that are shown.
    #[cfg(feature = "draco")]
    pub fn meshes(&self, document: &Document) -> BTreeSet<usize> {
        let shown = self.shown.iter().filter(|&&node| !self.is_hidden(node));
        shown
            .filter_map(|&node| document.nodes[node].mesh)
            .collect()
    }

    /// Whether the mesh and the light of node `index` are not shown (`KHR_node_visibility`).
    pub fn is_hidden(&self, index: usize) -> bool {
        self.hidden.get(index).copied().unwrap_or(false)
    }

    /// Of the document's default scene, or its first, or of all its nodes.
    ///
    /// # Errors
    /// Place and problem, where the nodes are not a forest or the scene names what is not there.
    pub fn of(document: &Document, warnings: &mut Warnings) -> Result<Self, Misplaced> {
        let parents = parents(document)?;
        let roots: Vec<usize> = (0..parents.len())
            .filter(|&i| parents[i].is_none())
            .collect();
        let order = depth_first(document, &roots);
        if order.len() < document.nodes.len() {
            return Err(cycle(document, &order));
        }
        let worlds = world_transforms(document, &parents, &order, warnings);
        let hidden = hidden(document, &parents, &order, warnings);
        let shown = match shown_roots(document, warnings)? {
            Some(roots) => depth_first(document, &roots),
            None => order,
        };
        Ok(Self {
            worlds,
            shown,
            hidden,
        })
    }
}

/// The extension's object in a node.
#[derive(Deserialize)]
struct Visibility {
    #[serde(default = "visible")]
    visible: bool,
}

fn visible() -> bool {
    true
}

/// By node: whether it or a node above it is hidden; empty where none is.
fn hidden(
    document: &Document,
    parents: &[Option<usize>],
    order: &[usize],
    warnings: &mut Warnings,
) -> Vec<bool> {
    let mut hidden = Vec::new();
    for &index in order {
        let extensions = &document.nodes[index].extensions;
        let own = extensions.read::<Visibility>(NODE_VISIBILITY);
        let own = own.unwrap_or_else(|what| {
            let message = format!("{}: {what}", document.node_place(index));
            warnings.add(WarningCode::BadValue, message);
            None
        });
        let is_visible = own.is_none_or(|own| own.visible);
        if !is_visible && hidden.is_empty() {
            hidden = vec![false; parents.len()];
        }
        if let Some(parent) = parents[index]
            && !hidden.is_empty()
        {
            hidden[index] = hidden[parent];
        }
        if !is_visible {
            hidden[index] = true;
        }
    }
    hidden
}

/// The parent of each node; `None` for roots.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, Misplaced> {
    let mut parents = vec![None; document.nodes.len()];
    for (index, node) in document.nodes.iter().enumerate() {
        for &child in &node.children {
            let Some(parent) = parents.get_mut(child) else {
                let count = document.nodes.len();
                let what = format!("its child {child} is not there: there are only {count} nodes");
                return Err((document.node_place(index), what));
            };
            if let Some(other) = parent.replace(index) {
                let (first, second) = (document.node_place(other), document.node_place(index));
                let what = format!("has two parents, {first} and {second}");
                return Err((document.node_place(child), what));
            }
        }
    }
    Ok(parents)
}

/// `roots` and all below them, each once, parents first.
fn depth_first(document: &Document, roots: &[usize]) -> Vec<usize> {
    let mut is_visited = vec![false; document.nodes.len()];
    let mut order = Vec::with_capacity(document.nodes.len());
    let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(index) = stack.pop() {
        if !std::mem::replace(&mut is_visited[index], true) {
            order.push(index);
            stack.extend(document.nodes[index].children.iter().rev());
        }
    }
    order
}

/// Each node has one parent, so what no root leads to are cycles and what hangs on them.
fn cycle(document: &Document, reached: &[usize]) -> Misplaced {
    let mut is_reached = vec![false; document.nodes.len()];
    for &index in reached {
        is_reached[index] = true;
    }
    let first = is_reached.iter().position(|reached| !reached);
    let place = document.node_place(first.unwrap_or_default());
    (place, "is below itself: the nodes form a cycle".into())
}

/// The nodes that the scene lists; `None` for all.
fn shown_roots(
    document: &Document,
    warnings: &mut Warnings,
) -> Result<Option<Vec<usize>>, Misplaced> {
    let index = document.scene.unwrap_or(0);
    let Some(scene) = document.scenes.get(index) else {
        if document.scene.is_some() {
            let count = document.scenes.len();
            return Err((format!("scene {index}"), format!("there are only {count}")));
        }
        if !document.nodes.is_empty() {
            let message = "the file has no scene: all of its nodes are shown";
            warnings.add(WarningCode::BadValue, message);
        }
        return Ok(None);
    };
    let count = document.nodes.len();
    if let Some(node) = scene.nodes.iter().find(|&&node| node >= count) {
        let what = format!("node {node} is not there: there are only {count}");
        return Err((format!("scene {index}"), what));
    }
    Ok(Some(scene.nodes.clone()))
}

fn world_transforms(
    document: &Document,
    parents: &[Option<usize>],
    order: &[usize],
    warnings: &mut Warnings,
) -> Worlds {
    let mut transforms = vec![DAffine3::IDENTITY];
    let mut of_node = vec![Worlds::NOWHERE; parents.len()];
    for &index in order {
        let above = parents[index].map_or(Worlds::ROOT, |parent| of_node[parent]);
        let node = &document.nodes[index];
        if !node.has_transform() {
            of_node[index] = above;
            continue;
        }
        // Below a node that has no place, nothing has; one warning is enough.
        let Some(&above) = transforms.get(above as usize) else {
            continue;
        };
        let place = || document.node_place(index);
        let own = above * local_transform(node, place, warnings);
        if own.is_finite() {
            of_node[index] = transforms.len() as u32;
            transforms.push(own);
        } else {
            let message = format!(
                "{}: its transform is not finite; it is left out with all below it",
                document.node_place(index)
            );
            warnings.add(WarningCode::BadValue, message);
        }
    }
    Worlds {
        transforms,
        of_node,
    }
}

fn local_transform(node: &Node, place: impl Fn() -> String, warnings: &mut Warnings) -> DAffine3 {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(matrix);
        let bottom = matrix.row(3);
        if bottom.truncate() != DVec3::ZERO || bottom.w != 1.0 {
            let message = format!("{}: the bottom row of its matrix is not 0 0 0 1", place());
            warnings.add(WarningCode::BadValue, message);
        }
        return DAffine3::from_mat4(matrix);
    }
    let vector = |v: &Option<Box<[f64; 3]>>, default| v.as_deref().map_or(default, |&v| v.into());
    let rotation = node.rotation.as_deref().map_or(DQuat::IDENTITY, |&q| {
        unit_rotation(DQuat::from_array(q)).unwrap_or_else(|| {
            let message = format!("{}: its rotation is not a quaternion", place());
            warnings.add(WarningCode::BadValue, message);
            DQuat::IDENTITY
        })
    });
    DAffine3::from_scale_rotation_translation(
        vector(&node.scale, DVec3::ONE),
        rotation,
        vector(&node.translation, DVec3::ZERO),
    )
}

/// `rotation` with length 1; `None` where it has none. Quantised and decimal quaternions are
/// never quite of length 1.
pub fn unit_rotation(rotation: DQuat) -> Option<DQuat> {
    let rotation = rotation / rotation.length();
    rotation.is_finite().then_some(rotation)
}
