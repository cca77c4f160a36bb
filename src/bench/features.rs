//! What a scene's features cost: the same picture with and without each, and on trees of every
//! builder.
//!
//! A picture that would take too long is rendered with fewer samples, and then fewer pixels, all
//! over it; its time is scaled up, and is marked.

use std::sync::atomic::AtomicBool;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use serde::Serialize;

use crate::bvh::Builder;
use crate::camera::Camera;
use crate::film::Rect;
use crate::light::Light;
use crate::math::UVec2;
use crate::prepare::{PreparedScene, prepare};
use crate::render::{Job, render};
use crate::scene::{Placed, Scene, Settings};

use super::{Elapsed, Stopwatch, Timing};

/// How features are measured.
#[derive(Clone, Copy, Debug)]
pub struct FeaturePlan {
    /// Times that each picture is rendered.
    pub repeats: usize,
    /// Seconds that all repeats of one picture may take, about.
    pub limit: f64,
    /// The larger number of threads; the smaller is 1.
    pub threads: usize,
}

/// What the features of a scene cost.
#[derive(Clone, Debug, Serialize)]
pub struct FeatureReport {
    /// Without and with supersampling, each without and with soft shadows; best builder, all threads.
    pub sampling: Vec<FeatureCell>,
    /// Everything on, for every builder and one and all threads; without a tree first.
    pub bvh: Vec<FeatureCell>,
    /// Lights with an area, which have no hard counterpart and stay as they are.
    pub always_soft_lights: usize,
}

/// One picture. Times are medians of repeats.
#[derive(Clone, Debug, Serialize)]
pub struct FeatureCell {
    /// Camera samples of a pixel.
    pub samples: u32,
    /// Whether lights have the radii that their author gave them; otherwise 0.
    pub soft_shadows: bool,
    /// The name of the builder.
    pub builder: &'static str,
    /// Threads that prepared and rendered.
    pub threads: usize,
    /// Wall time of what happens before the first ray, measured once.
    pub prepare_seconds: f64,
    /// Wall time of the whole picture.
    pub seconds: f64,
    /// All that is known of the time.
    pub time: Timing,
    /// `seconds`, in those of the first picture of the table.
    pub ratio: f64,
    /// Rays of the whole picture, all kinds.
    pub rays: u64,
    /// Millions of rays in a second of wall time.
    pub mrays_per_second: f64,
    /// Which share of the picture's samples was rendered: where below 1, times and rays are
    /// scaled up from it.
    pub measured_share: f64,
}

/// Renders `scene` as `settings` say and with its features off in turn, as seen by `camera`.
///
/// # Errors
/// Where threads cannot be started.
pub fn bench_features(
    scene: &Scene,
    settings: &Settings,
    camera: &Placed<Camera>,
    plan: &FeaturePlan,
) -> Result<FeatureReport, ThreadPoolBuildError> {
    let threads = if plan.threads > 1 {
        vec![1, plan.threads]
    } else {
        vec![1]
    };
    let pools = threads
        .iter()
        .map(|&n| ThreadPoolBuilder::new().num_threads(n).build())
        .collect::<Result<Vec<_>, _>>()?;
    let mut studio = Studio::new(scene, settings, camera, pools);
    let last = threads.len() - 1;
    let sampling = [(1, false), (1, true)]
        .into_iter()
        .chain([false, true].map(|is_soft| (settings.sampling.samples, is_soft)))
        .map(|(samples, is_soft)| Variant {
            samples,
            is_soft,
            tree: studio.default_tree,
            pool: last,
        })
        .collect();
    let bvh = (0..studio.trees.len())
        .flat_map(|tree| {
            (0..threads.len()).map(move |pool| Variant {
                samples: settings.sampling.samples,
                is_soft: true,
                tree,
                pool,
            })
        })
        .collect();
    Ok(FeatureReport {
        sampling: studio.measure(sampling, plan),
        bvh: studio.measure(bvh, plan),
        always_soft_lights: studio.hard_lights.iter().filter(|l| !l.is_delta()).count(),
    })
}

/// The light without its radius, as long as it still gives light then.
fn hard(light: &Light) -> Light {
    let mut light = *light;
    match &mut light {
        Light::Point(light) => light.radius = 0.0,
        Light::Spot(light) => light.radius = 0.0,
        Light::Distant(light) => light.angle_radians = 0.0,
        Light::Disk(_) | Light::Rectangle(_) | Light::Sphere(_) => {}
    }
    light
}

/// Which picture is rendered.
#[derive(Clone, Copy)]
struct Variant {
    samples: u32,
    is_soft: bool,
    /// Index of a [`Tree`].
    tree: usize,
    /// Index of a thread pool.
    pool: usize,
}

/// The scene, prepared with one builder.
struct Tree<'a> {
    builder: Builder,
    scene: PreparedScene<'a>,
    /// By thread pool.
    prepare_seconds: Vec<f64>,
}

/// All that pictures are made with.
struct Studio<'a> {
    settings: &'a Settings,
    camera: &'a Placed<Camera>,
    pools: Vec<ThreadPool>,
    trees: Vec<Tree<'a>>,
    default_tree: usize,
    soft_lights: Vec<Light>,
    hard_lights: Vec<Light>,
}

impl<'a> Studio<'a> {
    fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        camera: &'a Placed<Camera>,
        pools: Vec<ThreadPool>,
    ) -> Self {
        let mut builders = Builder::ALL.to_vec();
        builders.sort_by_key(|&builder| builder != Builder::None);
        let trees: Vec<Tree> = builders
            .iter()
            .map(|&builder| Tree::new(scene, builder, &pools))
            .collect();
        let soft_lights = trees.first().map_or(Vec::new(), |t| t.scene.lights.clone());
        Self {
            settings,
            camera,
            pools,
            default_tree: builders
                .iter()
                .position(|&builder| builder == Builder::default())
                .unwrap_or(0),
            trees,
            hard_lights: soft_lights.iter().map(hard).collect(),
            soft_lights,
        }
    }

    /// Measures all variants, in turns.
    fn measure(&mut self, variants: Vec<Variant>, plan: &FeaturePlan) -> Vec<FeatureCell> {
        let repeats = plan.repeats.max(1);
        let limit = plan.limit / repeats as f64;
        let budgets: Vec<u64> = variants.iter().map(|&v| self.budget(v, limit)).collect();
        let mut runs = vec![Vec::new(); variants.len()];
        for _ in 0..repeats {
            for (i, &variant) in variants.iter().enumerate() {
                runs[i].push(self.run(variant, budgets[i]));
            }
        }
        let mut cells: Vec<FeatureCell> = variants
            .iter()
            .zip(&runs)
            .map(|(&variant, runs)| self.cell(variant, runs))
            .collect();
        let first = cells.first().map_or(1.0, |cell| cell.seconds);
        for cell in &mut cells {
            cell.ratio = cell.seconds / first;
        }
        cells
    }

    /// How many camera samples of a picture can be rendered in `limit` seconds: all, or about as many.
    fn budget(&mut self, variant: Variant, limit: f64) -> u64 {
        let full = camera_samples(&self.settings_of(variant));
        let mut budget = full.min(64);
        loop {
            let run = self.run(variant, budget);
            let in_limit = (limit / run.elapsed.wall * run.samples as f64) as u64;
            // From a small start, whose time says little, in steps.
            let next = in_limit.min(budget.saturating_mul(64)).min(full);
            if budget >= full || next < 2 * budget {
                return next.clamp(budget.min(64), full);
            }
            budget = next;
        }
    }

    fn settings_of(&self, variant: Variant) -> Settings {
        let mut settings = self.settings.clone();
        settings.sampling.samples = variant.samples;
        settings
    }

    /// Renders about `budget` camera samples of a picture.
    fn run(&mut self, variant: Variant, budget: u64) -> Run {
        let settings = reduced(&self.settings_of(variant), budget);
        let tree = &mut self.trees[variant.tree];
        let lights = if variant.is_soft {
            &self.soft_lights
        } else {
            &self.hard_lights
        };
        tree.scene.lights.clone_from(lights);
        let job = Job {
            camera: tree.scene.camera(self.camera),
            scene: &tree.scene,
            settings: &settings,
            crop: Rect::full(settings.size),
            layers: Vec::new(),
        };
        let (elapsed, film) = self.pools[variant.pool].install(|| {
            let stopwatch = Stopwatch::start();
            let film = render(&job, &AtomicBool::new(false), &|_| {});
            (stopwatch.read(), film)
        });
        Run {
            elapsed,
            samples: camera_samples(&settings),
            rays: film.rays.camera + film.rays.shadow + film.rays.secondary,
        }
    }

    /// What repeats of one picture say; its ratio is still to come.
    fn cell(&self, variant: Variant, runs: &[Run]) -> FeatureCell {
        let full = camera_samples(&self.settings_of(variant));
        let measured = runs.first().map_or(full, |run| run.samples);
        let scale = full as f64 / measured as f64;
        let elapsed: Vec<Elapsed> = runs.iter().map(|run| run.elapsed).collect();
        let time = Timing::of(&elapsed).scaled(scale);
        let rays = runs.first().map_or(0, |run| run.rays) as f64 * scale;
        let tree = &self.trees[variant.tree];
        FeatureCell {
            samples: self.settings_of(variant).sampling.samples_per_pixel(),
            soft_shadows: variant.is_soft,
            builder: tree.builder.name(),
            threads: self.pools[variant.pool].current_num_threads(),
            prepare_seconds: tree.prepare_seconds[variant.pool],
            seconds: time.wall.median,
            time,
            ratio: 1.0,
            rays: rays.round() as u64,
            mrays_per_second: rays / time.wall.median / 1e6,
            measured_share: 1.0 / scale,
        }
    }
}

impl<'a> Tree<'a> {
    fn new(scene: &'a Scene, builder: Builder, pools: &[ThreadPool]) -> Self {
        let mut prepare_seconds = Vec::with_capacity(pools.len());
        let mut prepared = None;
        for pool in pools {
            // Not two at a time.
            drop(prepared.take());
            let stopwatch = Stopwatch::start();
            prepared = Some(pool.install(|| prepare(scene, builder)));
            prepare_seconds.push(stopwatch.read().wall);
        }
        Self {
            builder,
            scene: prepared.unwrap_or_else(|| prepare(scene, builder)).scene,
            prepare_seconds,
        }
    }
}

/// One render.
#[derive(Clone, Copy)]
struct Run {
    elapsed: Elapsed,
    /// Camera samples in all.
    samples: u64,
    /// Rays of all kinds.
    rays: u64,
}

fn camera_samples(settings: &Settings) -> u64 {
    let UVec2 { x, y } = settings.size;
    u64::from(x) * u64::from(y) * u64::from(settings.sampling.samples_per_pixel())
}

/// `settings` with about `budget` camera samples, spread over the whole picture: fewer in a pixel
/// first, then fewer pixels.
fn reduced(settings: &Settings, budget: u64) -> Settings {
    let mut settings = settings.clone();
    if budget >= camera_samples(&settings) {
        return settings;
    }
    let pixels = u64::from(settings.size.x) * u64::from(settings.size.y);
    let samples = (budget / pixels).max(1);
    settings.sampling.samples = u32::try_from(samples).unwrap_or(u32::MAX);
    if budget < pixels {
        let scale = (budget as f64 / pixels as f64).sqrt();
        let side = |side: u32| (f64::from(side) * scale).round().max(1.0) as u32;
        settings.size = UVec2::new(side(settings.size.x), side(settings.size.y));
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::light::{Falloff, PointLight};
    use crate::math::Vec3;

    fn settings(x: u32, y: u32, samples: u32) -> Settings {
        let mut settings = Settings {
            size: UVec2::new(x, y),
            ..Settings::default()
        };
        settings.sampling.samples = samples;
        settings
    }

    #[test]
    fn fewer_samples_come_before_fewer_pixels() {
        let full = settings(200, 100, 16);
        assert_eq!(reduced(&full, 320_000), full);
        assert_eq!(reduced(&full, 100_000), settings(200, 100, 5));
        assert_eq!(reduced(&full, 5_000), settings(100, 50, 1));
        assert_eq!(reduced(&full, 0), settings(1, 1, 1));
    }

    #[test]
    fn a_hard_light_needs_one_ray_unless_it_has_an_area() {
        let point = PointLight {
            position: Vec3::Y,
            intensity: Rgb::splat(1.0),
            radius: 0.5,
            samples: 81,
            falloff: Falloff::INVERSE_SQUARE,
        };
        let lights = [Light::Point(point)];
        assert_eq!(lights.map(|light| light.samples()), [81]);
        assert_eq!(lights.map(|light| hard(&light).samples()), [1]);
    }
}
