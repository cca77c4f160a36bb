//! G4 and G5: nothing depends on the size of the scene.

use rayon::prelude::*;

use crate::film::Film;
use crate::sampling::Pattern;
use crate::stress::scenes::{bits, picture, relative_rmse};
use crate::stress::still_life::{camera, scene, settings};
use crate::stress::{Check, Effort, Sweep};

/// G4: the very same bits at 2^-40 to 2^40.
pub fn powers_of_two(effort: Effort) -> Vec<Check> {
    let step = effort.pick(8, 1);
    let reference = bits(&film(1.0));
    let points: Vec<_> = (-40..=40)
        .step_by(step)
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|k| {
            let scale = 2f32.powi(k);
            let scaled = bits(&film(scale));
            let moved = reference.iter().zip(&scaled).filter(|(a, b)| a != b);
            (f64::from(scale), moved.count() as f64)
        })
        .collect();
    let sweep = Sweep::of("scale", "pixels that differ", points);
    let what = "everything in one scene, 2^-40..2^40: pixels that differ in a bit";
    vec![Check::worst(what, 0.0, sweep)]
}

/// G5: the same picture but for rounding at 1e-12 to 1e12.
pub fn powers_of_ten(effort: Effort) -> Vec<Check> {
    let reference = film(1.0);
    let step = effort.pick(3, 1);
    let points: Vec<_> = (-12..=12)
        .step_by(step)
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|k| {
            let scale = 10f32.powi(k);
            (f64::from(scale), relative_rmse(&reference, &film(scale)))
        })
        .collect();
    let sweep = Sweep::of("scale", "relative RMSE against scale 1", points);
    vec![Check::worst(
        "everything in one scene, 1e-12..1e12: relative RMSE",
        1e-5,
        sweep,
    )]
}

fn film(scale: f32) -> Film {
    picture(&scene(scale), &camera(scale), &settings(Pattern::Sobol))
}
