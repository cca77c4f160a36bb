//! Animations: what a document says at a given time.
//!
//! The values of that time replace those of the JSON before it becomes a [`Document`]: nothing after
//! this knows of animations, and whatever is read can be animated (`KHR_animation_pointer`).

mod pointer;
mod sampler;

use serde::Deserialize;
use serde_json::Value;

use super::accessor::AccessorReader;
use super::document::{Document, Extensions, place};
use super::extensions::ANIMATION_POINTER;
use crate::import::{Pose, Problem, WarningCode, Warnings};
use sampler::SamplerEntry;

#[derive(Default, Deserialize)]
#[serde(default)]
struct AnimationEntry {
    name: Option<String>,
    channels: Vec<ChannelEntry>,
    samplers: Vec<SamplerEntry>,
}

/// What a sampler moves.
#[derive(Default, Deserialize)]
#[serde(default)]
struct ChannelEntry {
    sampler: usize,
    target: TargetEntry,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct TargetEntry {
    node: Option<usize>,
    path: String,
    extensions: Extensions,
}

/// The extension's object in a target.
#[derive(Deserialize)]
struct PointerEntry {
    pointer: String,
}

/// The document of `json` as it is at the time of `pose`; `None` where it has no animations.
///
/// A channel that is broken is left out with a warning.
///
/// # Errors
/// Where there is no such animation, or its values do not make a document.
pub fn posed(
    json: &[u8],
    accessors: &AccessorReader,
    pose: &Pose,
    warnings: &mut Warnings,
) -> Result<Option<Document>, Problem> {
    if accessors.document.animations.is_empty() {
        return Ok(None);
    }
    let invalid = |error: serde_json::Error| Problem::Invalid(format!("its animation: {error}"));
    let mut root: Value = serde_json::from_slice(json).map_err(invalid)?;
    let animations = root.get_mut("animations").map(Value::take);
    let animations: Vec<AnimationEntry> =
        serde_json::from_value(animations.unwrap_or_default()).map_err(invalid)?;
    let index = choose(&animations, pose.animation.as_deref())?;
    let animation = &animations[index];
    for (number, channel) in animation.channels.iter().enumerate() {
        let moved = animation.target_at(channel, accessors, pose.seconds);
        let moved = moved.and_then(|moved| match moved {
            Some((target, value)) => pointer::set(&mut root, &target, value),
            None => Ok(()),
        });
        if let Err(what) = moved {
            let place = place("animation", index, animation.name.as_deref());
            let message = format!("{place}, channel {number}: {what}; it is left out");
            warnings.add(WarningCode::BadValue, message);
        }
    }
    // The list was taken out; what is left of it is how long it was.
    root["animations"] = animations.iter().map(|_| Value::Null).collect();
    serde_json::from_value(root).map(Some).map_err(invalid)
}

/// The first animation, or the one of this name or else of this number.
fn choose(animations: &[AnimationEntry], name: Option<&str>) -> Result<usize, Problem> {
    let Some(name) = name else { return Ok(0) };
    let by_name = animations
        .iter()
        .position(|animation| animation.name.as_deref() == Some(name));
    let by_number = || name.parse().ok().filter(|&n: &usize| n < animations.len());
    by_name.or_else(by_number).ok_or_else(|| {
        let named = animations.iter().map(|animation| animation.name.as_deref());
        let list: Vec<String> = named
            .enumerate()
            .map(|(number, name)| match name {
                Some(name) => format!("{number} {name:?}"),
                None => number.to_string(),
            })
            .collect();
        let list = list.join(", ");
        Problem::Invalid(format!(
            "no animation is called {name:?}; there are: {list}"
        ))
    })
}

impl AnimationEntry {
    /// What a channel moves, as a pointer into the document, and to what; `None` where it moves
    /// nothing.
    fn target_at(
        &self,
        channel: &ChannelEntry,
        accessors: &AccessorReader,
        seconds: f64,
    ) -> Result<Option<(String, Value)>, String> {
        let target = &channel.target;
        let target = match (target.node, target.path.as_str()) {
            (_, "pointer") => {
                let pointer = target.extensions.read::<PointerEntry>(ANIMATION_POINTER)?;
                pointer.ok_or("it has no pointer")?.pointer
            }
            (None, _) => return Ok(None),
            (Some(node), path @ ("translation" | "rotation" | "scale" | "weights")) => {
                if node >= accessors.document.nodes.len() {
                    return Err(format!("node {node} is not there"));
                }
                format!("/nodes/{node}/{path}")
            }
            (_, path) => return Err(format!("path {path:?} is not known")),
        };
        let sampler = self.samplers.get(channel.sampler);
        let sampler =
            sampler.ok_or_else(|| format!("its sampler {} is not there", channel.sampler))?;
        let is_rotation = target.starts_with("/nodes/") && target.ends_with("/rotation");
        let values = sampler
            .at(accessors, seconds, is_rotation)
            .map_err(|problem| problem.to_string())?;
        Ok(Some((target.clone(), pointer::value(&target, values)?)))
    }
}
