//! What a sample tells beside its radiance, for the layers of a picture: what the camera sees, and
//! which light took which way.
//!
//! An integrator tells it through [`super::RayLog::see`] and [`super::RayLog::light`], while it follows the
//! ray that it follows anyway.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::scene::Scene;

/// Something that a ray from the camera meets.
#[derive(Clone, Copy, Debug)]
pub enum Sight {
    /// A triangle of the scene.
    Surface(Hit),
    /// The surface of a light, which is no triangle.
    Light {
        /// Where along the ray.
        t: f32,
    },
}

impl Sight {
    /// Where along the ray it is met.
    pub fn t(self) -> f32 {
        match self {
            Self::Surface(hit) => hit.t,
            Self::Light { t } => t,
        }
    }
}

/// Something that is seen, and how much of the ray ends there.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// What it is.
    pub sight: Sight,
    /// The share of the ray that it covers, `[0, 1]`: what is before it let the rest pass. Glass covers
    /// what is behind it; only the alpha of a material lets anything pass.
    pub share: f32,
}

/// What gave off light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// What surrounds the scene, ambient light included.
    Background,
    /// A surface that emits.
    Surface,
    /// The light with this number.
    Light(u32),
}

/// A part of the light of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightPart {
    /// What comes straight from where it was given off.
    Emission,
    /// What was scattered once on its way.
    Direct,
    /// What was scattered more than once.
    Indirect,
    /// All that comes from the group with this number of [`LightGroups`].
    Group(u32),
}

/// Which lights share a layer: those of one name. What surrounds the scene and what surfaces emit are
/// groups of their own, so that all groups add up to the picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LightGroups {
    names: Vec<String>,
    of_light: Vec<u32>,
}

impl LightGroups {
    const BACKGROUND: u32 = 0;
    const SURFACES: u32 = 1;

    /// The groups of the lights of `scene`; a light without a name is a group by itself, called by its number.
    pub fn of(scene: &Scene) -> Self {
        let mut names = vec!["background".to_owned(), "surfaces".to_owned()];
        let mut known = BTreeMap::new();
        let group = |(number, name): (usize, &str)| {
            let mut name: String = match name {
                "" => number.to_string(),
                name => name.chars().map(plain).collect(),
            };
            while names[..2].contains(&name) {
                name.push('_');
            }
            *known.entry(name).or_insert_with_key(|name| {
                names.push(name.clone());
                names.len() as u32 - 1
            })
        };
        let lights = scene.lights.iter().map(|light| light.name.as_str());
        let of_light = lights.enumerate().map(group).collect();
        Self { names, of_light }
    }

    /// Their names, of letters, digits, `-` and `_`.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    fn group(&self, source: Source) -> Option<usize> {
        let group = match source {
            Source::Background => Self::BACKGROUND,
            Source::Surface => Self::SURFACES,
            Source::Light(number) => *self.of_light.get(number as usize)?,
        };
        Some(group as usize)
    }
}

/// A character that any reader of EXR files takes in the name of a layer.
fn plain(c: char) -> char {
    if c.is_ascii_alphanumeric() || c == '-' {
        c
    } else {
        '_'
    }
}

/// What one sample tells.
#[derive(Clone, Debug, Default)]
pub struct Account {
    /// What is seen, from front to back.
    pub seen: Vec<Seen>,
    /// Emission, direct and indirect light.
    by_events: [Rgb; 3],
    by_group: Vec<Rgb>,
    groups: Arc<LightGroups>,
}

impl Account {
    /// An account that keeps the light of each of `groups` apart.
    pub fn new(groups: LightGroups) -> Self {
        Self {
            by_group: vec![Rgb::BLACK; groups.names.len()],
            groups: Arc::new(groups),
            ..Self::default()
        }
    }

    /// Forgets the last sample.
    pub fn clear(&mut self) {
        self.seen.clear();
        self.by_events = Default::default();
        self.by_group.fill(Rgb::BLACK);
    }

    /// Adds light of `source` that was scattered `events` times.
    pub fn add(&mut self, source: Source, events: u32, radiance: Rgb) {
        self.by_events[events.min(2) as usize] += radiance;
        let group = self.groups.group(source);
        if let Some(sum) = group.and_then(|group| self.by_group.get_mut(group)) {
            *sum += radiance;
        }
    }

    /// The share of the ray that something covers, `[0, 1]`.
    pub fn coverage(&self) -> f32 {
        self.seen
            .iter()
            .map(|seen| seen.share)
            .sum::<f32>()
            .min(1.0)
    }

    /// Radiance of a part of the light.
    pub fn light(&self, part: LightPart) -> Rgb {
        match part {
            LightPart::Emission => self.by_events[0],
            LightPart::Direct => self.by_events[1],
            LightPart::Indirect => self.by_events[2],
            LightPart::Group(group) => {
                let sum = self.by_group.get(group as usize);
                sum.copied().unwrap_or_default()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{Falloff, Light, PointLight};
    use crate::math::{DVec3, Vec3};
    use crate::scene::Placed;

    fn scene(names: &[&str]) -> Scene {
        let light = |name: &&str| Placed {
            name: (*name).to_owned(),
            origin: DVec3::ZERO,
            item: Light::Point(PointLight {
                position: Vec3::ZERO,
                intensity: Rgb::WHITE,
                radius: 0.0,
                samples: 1,
                falloff: Falloff::INVERSE_SQUARE,
            }),
        };
        Scene {
            lights: names.iter().map(light).collect(),
            ..Scene::default()
        }
    }

    #[test]
    fn lights_of_one_name_share_a_group_and_no_name_is_taken_twice() {
        let scene = scene(&["key light", "", "fill", "key light", "background"]);
        let groups = LightGroups::of(&scene);
        let names = [
            "background",
            "surfaces",
            "key_light",
            "1",
            "fill",
            "background_",
        ];
        assert_eq!(groups.names(), names);
        assert_eq!(groups.of_light, [2, 3, 4, 2, 5]);
    }

    #[test]
    fn light_is_told_apart_by_events_and_by_source() {
        let mut account = Account::new(LightGroups::of(&scene(&["a", "b"])));
        for (source, events, radiance) in [
            (Source::Light(1), 0, 1.0),
            (Source::Light(0), 1, 2.0),
            (Source::Light(1), 5, 4.0),
            (Source::Background, 2, 8.0),
            (Source::Surface, 0, 16.0),
        ] {
            account.add(source, events, Rgb::splat(radiance));
        }
        let of = |part| account.light(part).g;
        let by_events = [LightPart::Emission, LightPart::Direct, LightPart::Indirect];
        assert_eq!(by_events.map(of), [17.0, 2.0, 12.0]);
        assert_eq!(
            [0, 1, 2, 3].map(|n| of(LightPart::Group(n))),
            [8.0, 16.0, 2.0, 5.0]
        );
    }
}
