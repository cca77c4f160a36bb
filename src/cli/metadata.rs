//! What an EXR file says about how it was made.

use halfshade::film::{ErrorEstimate, Film};
use halfshade::scene::Settings;

use super::options::RenderOptions;

/// Keys and values: all that the picture depends on beside the files of the scene.
pub fn metadata(
    options: &RenderOptions,
    settings: &Settings,
    film: &Film,
    error: Option<&ErrorEstimate>,
) -> Vec<(&'static str, String)> {
    let crop = film.rect;
    let sampling = &settings.sampling;
    let scene = &options.scene;
    // The name alone: a path says more about the user than about the picture.
    let name = scene.scene.file_name().unwrap_or_default();
    let mut metadata = vec![
        ("scene", name.to_string_lossy().into_owned()),
        ("size", format!("{}x{}", settings.size.x, settings.size.y)),
        (
            "crop",
            format!("{},{},{},{}", crop.x, crop.y, crop.width, crop.height),
        ),
        ("integrator", settings.integrator.name().to_owned()),
        ("max_depth", settings.depth().to_string()),
        ("samples", samples(film)),
        ("pattern", sampling.pattern.name().to_owned()),
        ("target", sampling.target.name().to_owned()),
        ("seed", sampling.seed.to_string()),
    ];
    if !settings.shadow_terminator {
        metadata.push(("shadow_terminator", "false".to_owned()));
    }
    if let Some(samples) = settings.light_samples {
        metadata.push(("light_samples", samples.to_string()));
    }
    if let Some(camera) = &options.picture.camera {
        metadata.push(("camera", camera.clone()));
    }
    if let Some(error) = error {
        metadata.push(("estimated_relative_rmse", error.estimate.to_string()));
    }
    if let Some(seconds) = scene.reading.time_code {
        metadata.push(("time_code", seconds.to_string()));
    }
    if let Some(animation) = &scene.reading.animation {
        metadata.push(("animation", animation.clone()));
    }
    for (path, value) in &scene.reading.set {
        metadata.push(("set", format!("{path}={value}")));
    }
    metadata
}

/// Samples of a pixel, and on average where they differ.
fn samples(film: &Film) -> String {
    match film.sample_counts() {
        (min, _, max) if min == max => min.to_string(),
        (min, mean, max) => format!("{min} to {max}, mean {mean}"),
    }
}
