//! Statements that hold for the faces behind them: objects, materials, smoothing groups.

use std::collections::HashMap;

use super::geometry::{Geometry, Part, Run};
use super::names::Names;

/// What holds from some face on.
pub struct Change {
    /// The first face that it holds for, counted from the first of its block.
    pub face: usize,
    /// What it sets.
    pub to: Setting,
}

/// What one statement sets.
pub enum Setting {
    /// `o`
    Object(Box<[u8]>),
    /// `usemtl`
    Material(Box<[u8]>),
    /// `s`; 0: none
    Smoothing(u32),
}

/// The faces of a file by what holds for them, from its first statement on.
#[derive(Default)]
pub struct Runs {
    objects: Names,
    materials: Names,
    smoothing: u32,
    part_ids: HashMap<Part, u32>,
    parts: Vec<Part>,
    runs: Vec<Run>,
    faces: usize,
}

impl Runs {
    /// Adds a block of `faces` faces.
    pub fn add(&mut self, changes: &[Change], faces: usize) {
        let mut first = 0;
        for change in changes {
            self.add_faces(change.face - first);
            first = change.face;
            match &change.to {
                Setting::Object(name) => self.objects.select(name),
                Setting::Material(name) => self.materials.select(name),
                Setting::Smoothing(group) => self.smoothing = *group,
            }
        }
        self.add_faces(faces - first);
    }

    fn add_faces(&mut self, faces: usize) {
        if faces == 0 {
            return;
        }
        let part = Part {
            object: self.objects.current(),
            material: self.materials.current(),
        };
        let next = self.parts.len() as u32;
        let id = *self.part_ids.entry(part).or_insert(next);
        if id == next {
            self.parts.push(part);
        }
        let last = self.runs.last();
        if last.is_none_or(|run| run.part != id || run.smoothing != self.smoothing) {
            self.runs.push(Run {
                first_face: self.faces as u32,
                part: id,
                smoothing: self.smoothing,
            });
        }
        self.faces += faces;
    }

    /// Hands the lists over to `geometry`.
    pub fn finish(self, geometry: &mut Geometry) {
        geometry.objects = self.objects.into_list();
        geometry.materials = self.materials.into_list();
        geometry.parts = self.parts;
        geometry.runs = self.runs;
    }
}
