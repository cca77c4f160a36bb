//! What is compared: ways to sample a picture.

use std::fmt::{self, Display};
use std::str::FromStr;

use thiserror::Error;

use crate::import::scene_file::suggestion;
use crate::render::Limits;
use crate::sampling::{Pattern, Target};
use crate::scene::{MAX_LIGHT_SAMPLES, MAX_SAMPLES, Settings};

/// A way to sample a picture; a curve, or with [`Method::samples`] a single point.
///
/// Written like `jittered:circle:16`: a pattern, then in any order a target, a number of shadow rays
/// per light, `adaptive`; and `@81` for a number of camera samples. `jittered:81@81` is the seed
/// project's brute force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    /// Layout of the samples.
    pub pattern: Pattern,
    /// What part of its pixel a camera sample may land in.
    pub target: Target,
    /// Shadow rays per light and shading point; `None`: what each light says.
    pub light_samples: Option<u32>,
    /// Whether samples go where the error is.
    pub is_adaptive: bool,
    /// The number of camera samples that it is measured with; `None`: doubling numbers.
    pub samples: Option<u32>,
}

/// Why a text names no method.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("\"{text}\" is no method: {problem}")]
pub struct MethodError {
    text: String,
    problem: String,
}

const ADAPTIVE: &str = "adaptive";
/// Samples of a jittered pattern's round, where samples are allotted.
const ADAPTIVE_ROUND: u32 = 16;

impl Method {
    /// What is compared unless something else is asked for: every pattern with what the scene's lights
    /// say, what `--error` does, and the brute force.
    pub fn usual() -> Vec<Self> {
        let mut methods: Vec<Self> = [
            Pattern::Sobol,
            Pattern::Jittered,
            Pattern::Random,
            Pattern::Grid,
        ]
        .map(Self::of_pattern)
        .into();
        methods.insert(
            1,
            Self {
                is_adaptive: true,
                ..methods[0]
            },
        );
        methods.push(Self {
            light_samples: Some(81),
            samples: Some(81),
            ..Self::of_pattern(Pattern::Jittered)
        });
        methods
    }

    /// Every pattern with every target and 1, 4, 16 and 81 shadow rays.
    pub fn all() -> Vec<Self> {
        let mut methods = Vec::new();
        for &pattern in Pattern::ALL {
            for &target in Target::ALL {
                methods.extend([1, 4, 16, 81].map(|light_samples| Self {
                    target,
                    light_samples: Some(light_samples),
                    ..Self::of_pattern(pattern)
                }));
            }
        }
        methods
    }

    fn of_pattern(pattern: Pattern) -> Self {
        Self {
            pattern,
            target: Target::Rectangle,
            light_samples: None,
            is_adaptive: false,
            samples: None,
        }
    }

    /// How a picture with `samples` camera samples in a pixel is rendered.
    pub fn settings(&self, scene: &Settings, samples: u32, seed: u64) -> (Settings, Limits) {
        let mut settings = scene.clone();
        settings.sampling.pattern = self.pattern;
        settings.sampling.target = self.target;
        settings.sampling.samples = samples;
        settings.sampling.seed = seed;
        settings.light_samples = self.light_samples.or(settings.light_samples);
        let mut limits = Limits::of(&settings);
        if self.is_adaptive {
            limits.samples = samples;
            limits.is_adaptive = true;
            settings.sampling.samples = samples.min(ADAPTIVE_ROUND);
        }
        (settings, limits)
    }

    fn part(&mut self, part: &str) -> Result<(), String> {
        if let Some(&target) = Target::ALL.iter().find(|target| target.name() == part) {
            self.target = target;
        } else if part == ADAPTIVE {
            self.is_adaptive = true;
        } else if part.starts_with(|c: char| c.is_ascii_digit()) {
            self.light_samples = Some(count(part, MAX_LIGHT_SAMPLES)?);
        } else {
            let targets = Target::ALL.iter().map(|target| target.name());
            let known: Vec<&str> = targets.chain([ADAPTIVE]).collect();
            let suggestion = suggestion(part, &known);
            return Err(format!(
                "after its pattern, \"{part}\"; {suggestion}, or a number of shadow rays"
            ));
        }
        Ok(())
    }
}

fn count(text: &str, most: u32) -> Result<u32, String> {
    let count: Option<u32> = text.parse().ok();
    count
        .filter(|count| (1..=most).contains(count))
        .ok_or_else(|| format!("\"{text}\" is no whole number from 1 to {most}"))
}

fn parsed(text: &str) -> Result<Method, String> {
    let (parts, samples) = match text.split_once('@') {
        Some((parts, samples)) => (parts, Some(count(samples, MAX_SAMPLES)?)),
        None => (text, None),
    };
    let mut parts = parts.split(':');
    let name = parts.next().unwrap_or_default();
    let pattern = Pattern::ALL.iter().find(|pattern| pattern.name() == name);
    let Some(&pattern) = pattern else {
        let known: Vec<&str> = Pattern::ALL.iter().map(|pattern| pattern.name()).collect();
        return Err(suggestion(name, &known));
    };
    let mut method = Method::of_pattern(pattern);
    parts.try_for_each(|part| method.part(part))?;
    method.samples = samples;
    if method.is_adaptive && pattern.sets() < 2 {
        return Err("a grid has no error of its own to go by".to_owned());
    }
    Ok(method)
}

impl FromStr for Method {
    type Err = MethodError;

    fn from_str(text: &str) -> Result<Self, MethodError> {
        let text = text.trim();
        parsed(text).map_err(|problem| MethodError {
            text: text.to_owned(),
            problem,
        })
    }
}

impl Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.pattern.name())?;
        if self.target != Target::default() {
            write!(f, ":{}", self.target.name())?;
        }
        if let Some(light_samples) = self.light_samples {
            write!(f, ":{light_samples}")?;
        }
        if self.is_adaptive {
            write!(f, ":{ADAPTIVE}")?;
        }
        match self.samples {
            Some(samples) => write!(f, "@{samples}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_read_by_its_name() {
        let mut methods = Method::all();
        methods.extend(Method::usual());
        assert_eq!(methods.len(), 32 + 6);
        for method in methods {
            assert_eq!(method.to_string().parse(), Ok(method));
        }
    }

    #[test]
    fn a_method_that_cannot_be_says_why() {
        for (text, expected) in [
            ("sobel", "did you mean \"sobol\"?"),
            ("sobol:disk", "known: rectangle, circle, adaptive"),
            ("sobol:0", "no whole number from 1"),
            ("sobol@x", "no whole number from 1"),
            ("grid:adaptive", "no error of its own"),
        ] {
            let error = text.parse::<Method>().unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }

    #[test]
    fn a_method_goes_above_the_scene() {
        let scene = Settings {
            light_samples: Some(4),
            ..Settings::default()
        };
        let method: Method = "jittered:circle:81@81".parse().unwrap();
        let (settings, limits) = method.settings(&scene, 81, 7);
        assert_eq!(
            (settings.light_samples, settings.sampling.seed),
            (Some(81), 7)
        );
        assert_eq!(settings.sampling.target, Target::Circle);
        // Two sets of 7 × 6 cells.
        assert_eq!((limits.samples, limits.is_adaptive), (84, false));
        let adaptive: Method = "sobol:adaptive".parse().unwrap();
        let (settings, limits) = adaptive.settings(&scene, 64, 7);
        assert_eq!(settings.light_samples, Some(4));
        assert_eq!((limits.samples, limits.is_adaptive), (64, true));
    }
}
