//! Samplers: values between keys (glTF 2.0, section 3.11 and appendix C).

use serde::Deserialize;

use crate::import::Problem;
use crate::import::gltf::accessor::{AccessorReader, Selection};
use crate::import::gltf::document::ElementKind;
use crate::import::gltf::graph::unit_rotation;
use crate::math::DQuat;

/// Keys and what is between them.
#[derive(Default, Deserialize)]
#[serde(default)]
pub struct SamplerEntry {
    input: usize,
    output: usize,
    interpolation: Interpolation,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Interpolation {
    Step,
    #[default]
    Linear,
    CubicSpline,
}

/// The numbers of a sampler at a time.
#[derive(Debug)]
pub struct Values {
    /// All of them.
    pub numbers: Vec<f64>,
    /// Whether they are a list, or of vectors, and not a single number.
    pub is_list: bool,
}

/// Two keys and how far the time is from the first to the second.
struct Span {
    keys: [usize; 2],
    seconds: f64,
    /// In `[0, 1)`.
    share: f64,
}

impl SamplerEntry {
    /// The values `seconds` after the start; before the first key they are those of the first, after
    /// the last those of the last. Quaternions where `is_rotation`.
    ///
    /// # Errors
    /// Where keys and values cannot be read, or do not fit together.
    pub fn at(
        &self,
        accessors: &AccessorReader,
        seconds: f64,
        is_rotation: bool,
    ) -> Result<Values, Problem> {
        let problem = |what: String| Problem::Invalid(what);
        let times = accessors.floats::<1>(self.input, &Selection::All)?;
        let keys = times.len();
        let parts = match self.interpolation {
            Interpolation::CubicSpline => 3,
            _ => 1,
        };
        let elements = accessors.count(self.output)?;
        if elements == 0 || keys == 0 || !elements.is_multiple_of(keys * parts) {
            return Err(problem(format!("{elements} values for {keys} keys")));
        }
        let kind = accessors.get(self.output)?.kind;
        if is_rotation && kind != ElementKind::Vec4 {
            return Err(problem("a rotation needs four numbers".into()));
        }
        // Elements of one key: more than one for the weights of several targets.
        let width = elements / (keys * parts);
        let key = |key: usize, part: usize| {
            let start = (key * parts + part) * width;
            numbers(accessors, self.output, kind, start..start + width)
        };
        let span = Span::of(&times, seconds);
        let [before, after] = span.keys;
        let numbers = match self.interpolation {
            Interpolation::Step => key(before, 0)?,
            Interpolation::Linear if is_rotation => {
                slerp(&key(before, 0)?, &key(after, 0)?, span.share)
            }
            Interpolation::Linear => {
                let (before, after) = (key(before, 0)?, key(after, 0)?);
                let pairs = before.iter().zip(&after);
                pairs.map(|(a, b)| a + (b - a) * span.share).collect()
            }
            Interpolation::CubicSpline => {
                let ends = [key(before, 1)?, key(after, 1)?];
                let tangents = [key(before, 2)?, key(after, 0)?];
                hermite(&ends, &tangents, &span)
            }
        };
        Ok(Values {
            numbers,
            is_list: kind != ElementKind::Scalar || width > 1,
        })
    }
}

impl Span {
    fn of(times: &[[f32; 1]], seconds: f64) -> Self {
        let last = times.len() - 1;
        let time = |key: usize| f64::from(times[key][0]);
        let after = times.partition_point(|&[time]| f64::from(time) <= seconds);
        let keys = [after.saturating_sub(1), after.min(last)];
        let length = time(keys[1]) - time(keys[0]);
        let share = (seconds - time(keys[0])) / length;
        Self {
            keys,
            seconds: length,
            // Not between two keys, or between keys that are not in order.
            share: if share > 0.0 && share < 1.0 {
                share
            } else {
                0.0
            },
        }
    }
}

/// The numbers of some elements.
fn numbers(
    accessors: &AccessorReader,
    index: usize,
    kind: ElementKind,
    elements: std::ops::Range<usize>,
) -> Result<Vec<f64>, Problem> {
    fn read<const N: usize>(
        accessors: &AccessorReader,
        index: usize,
        elements: std::ops::Range<usize>,
    ) -> Result<Vec<f64>, Problem> {
        let selection = Selection::Only(elements.map(|element| element as u32).collect());
        let values = accessors.floats::<N>(index, &selection)?;
        Ok(values.into_iter().flatten().map(f64::from).collect())
    }
    match kind {
        ElementKind::Scalar => read::<1>(accessors, index, elements),
        ElementKind::Vec2 => read::<2>(accessors, index, elements),
        ElementKind::Vec3 => read::<3>(accessors, index, elements),
        ElementKind::Vec4 => read::<4>(accessors, index, elements),
        other => Err(Problem::Invalid(format!(
            "accessor {index}: {other} is not a type of animated values"
        ))),
    }
}

/// On the shorter arc; `from`, where there is no arc.
fn slerp(from: &[f64], to: &[f64], share: f64) -> Vec<f64> {
    let unit = |q: &[f64]| match *q {
        [x, y, z, w] => unit_rotation(DQuat::from_xyzw(x, y, z, w)),
        _ => None,
    };
    match (unit(from), unit(to)) {
        (Some(from), Some(to)) => from.slerp(to, share).to_array().to_vec(),
        _ => from.to_vec(),
    }
}

/// A cubic that has these values and, per second, these slopes at its ends.
fn hermite(ends: &[Vec<f64>; 2], tangents: &[Vec<f64>; 2], span: &Span) -> Vec<f64> {
    let t = span.share;
    let (t2, t3) = (t * t, t * t * t);
    let blend = |i: usize| {
        (2.0 * t3 - 3.0 * t2 + 1.0) * ends[0][i]
            + (t3 - 2.0 * t2 + t) * span.seconds * tangents[0][i]
            + (3.0 * t2 - 2.0 * t3) * ends[1][i]
            + (t3 - t2) * span.seconds * tangents[1][i]
    };
    (0..ends[0].len()).map(blend).collect()
}
