//! Environments: where their pixels are, and samples in proportion to what they hold.

use std::f64::consts::{FRAC_PI_2, PI};

use halfshade::color::Rgb;
use halfshade::light::{Environment, EnvironmentSampler};
use halfshade::math::{DVec3, UnitVec3, Vec3};

use crate::common::chi_square::survival;
use crate::random;

fn environment(size: [u32; 2], rotate: f64, pixel: impl Fn(u32, u32) -> f32) -> Environment {
    let pixels = (0..size[1])
        .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
        .map(|(x, y)| [pixel(x, y); 3])
        .collect();
    Environment::new("test", size, pixels, Rgb::WHITE, rotate).unwrap()
}

fn toward(x: f32, y: f32, z: f32) -> UnitVec3 {
    UnitVec3::normalize(Vec3::new(x, y, z)).unwrap()
}

/// A sky with a sun of one pixel, a gradient and a black ground.
fn sky(rotate: f64) -> Environment {
    environment([64, 32], rotate, |x, y| match (x, y) {
        (20, 9) => 500.0,
        (_, 16..) => 0.0,
        (x, y) => 0.1 + 0.02 * x as f32 + 0.1 * y as f32,
    })
}

#[test]
fn the_middle_is_ahead_and_the_top_is_up() {
    // Columns 0 1 2 3: behind on the left, left, right, behind on the right.
    let map = environment([4, 2], 0.0, |x, y| (10 * y + x) as f32);
    let seen = |direction| map.radiance(direction).g;
    // Centres of pixels are at azimuths of 45 degrees and 45 degrees up and down.
    for (x, z, column) in [
        (-1.0, 1.0, 0.0),
        (-1.0, -1.0, 1.0),
        (1.0, -1.0, 2.0),
        (1.0, 1.0, 3.0),
    ] {
        let up = 2f32.sqrt();
        assert!((seen(toward(x, up, z)) - column).abs() < 1e-4);
        assert!((seen(toward(x, -up, z)) - column - 10.0).abs() < 1e-4);
    }
    // A quarter turn brings what was ahead (-z) to the left (-x).
    let turned = environment([4, 2], FRAC_PI_2, |x, y| (10 * y + x) as f32);
    for (before, after) in [
        (toward(-1.0, 0.5, -2.0), toward(-2.0, 0.5, 1.0)),
        (toward(2.0, 0.5, -1.0), toward(-1.0, 0.5, -2.0)),
    ] {
        assert!((turned.radiance(after).g - seen(before)).abs() < 1e-4);
    }
}

/// Chi-square over the sphere: samples fall where their density says.
#[test]
fn samples_have_the_density_that_they_claim() {
    const COUNT: u32 = 200_000;
    const BANDS: usize = 12;
    const SECTORS: usize = 16;
    for rotate in [0.0, 1.0] {
        let map = sky(rotate);
        let sampler = EnvironmentSampler::new(&map).unwrap();
        // Cells of equal solid angle: height and azimuth.
        let cell = |d: DVec3| {
            let band = (((d.y + 1.0) * 0.5 * BANDS as f64) as usize).min(BANDS - 1);
            let turn = d.z.atan2(d.x) / (2.0 * PI) + 0.5;
            band * SECTORS + ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
        };
        let mut counts = [0.0f64; BANDS * SECTORS];
        for u in random(COUNT, 3) {
            let sample = sampler.sample(u).unwrap();
            counts[cell(sample.wi.as_dvec3())] += 1.0;
            let density = sampler.density(sample.wi);
            // At the border of two pixels rounding decides which of them it is.
            let is_near = (density / sample.density - 1.0).abs() < 1e-3;
            assert!(
                is_near || is_at_border(&map, &sampler, sample.wi),
                "{density}"
            );
        }
        // The integral of the density over each cell, by many midpoints.
        const STEPS: usize = 60;
        let mut expected = [0.0f64; BANDS * SECTORS];
        let (heights, turns) = (BANDS * STEPS, SECTORS * STEPS);
        let patch = 4.0 * PI / (heights * turns) as f64;
        for i in 0..heights {
            for j in 0..turns {
                let y = (i as f64 + 0.5) / heights as f64 * 2.0 - 1.0;
                let angle = ((j as f64 + 0.5) / turns as f64 - 0.5) * 2.0 * PI;
                let r = (1.0 - y * y).sqrt();
                let d = DVec3::new(r * angle.cos(), y, r * angle.sin());
                let wi = UnitVec3::normalize_f64(d).unwrap();
                expected[cell(d)] += sampler.density(wi) * patch * f64::from(COUNT);
            }
        }
        let total: f64 = expected.iter().sum();
        assert!((total / f64::from(COUNT) - 1.0).abs() < 2e-3, "{total}");
        // What the midpoints are off by in the cells of the sun counts as well.
        let statistic: f64 = counts
            .iter()
            .zip(expected)
            .filter(|(_, e)| *e > 5.0)
            .map(|(c, e)| (c - e).powi(2) / (e + (0.01 * e).powi(2)))
            .sum();
        let p = survival(statistic, BANDS * SECTORS - 1);
        assert!(p > 1e-4, "turned {rotate}: p = {p}");
        let in_the_dark: f64 = (counts.iter().zip(expected))
            .filter(|(_, e)| *e == 0.0)
            .map(|(c, _)| c)
            .sum();
        assert_eq!(in_the_dark, 0.0);
    }
}

fn is_at_border(map: &Environment, sampler: &EnvironmentSampler, wi: UnitVec3) -> bool {
    assert!(map.size()[0] > 0);
    let near = [Vec3::X, Vec3::Y, Vec3::Z]
        .into_iter()
        .flat_map(|axis| [axis, -axis]);
    let densities: Vec<f64> = near
        .filter_map(|axis| UnitVec3::normalize(*wi + axis * 1e-6))
        .map(|wi| sampler.density(wi))
        .collect();
    let max = densities.iter().copied().fold(0.0, f64::max);
    densities.iter().any(|d| (d / max - 1.0).abs() > 1e-3)
}

/// The irradiance on a plane from samples is that from all directions.
#[test]
fn samples_bring_the_irradiance() {
    let map = sky(0.3);
    let sampler = EnvironmentSampler::new(&map).unwrap();
    let sum: f64 = random(100_000, 1)
        .map(|u| {
            let sample = sampler.sample(u).unwrap();
            f64::from(sample.radiance.g) * f64::from(sample.wi.y).max(0.0) / sample.density
        })
        .sum();
    let mut exact = 0.0;
    const STEPS: usize = 1000;
    for i in 0..STEPS {
        for j in 0..2 * STEPS {
            let down = (i as f64 + 0.5) / STEPS as f64 * FRAC_PI_2;
            let (sin, cos) = down.sin_cos();
            let angle = (j as f64 + 0.5) / STEPS as f64 * PI;
            let d = DVec3::new(sin * angle.cos(), cos, sin * angle.sin());
            let radiance = map.radiance(UnitVec3::normalize_f64(d).unwrap());
            exact += f64::from(radiance.g) * cos * sin;
        }
    }
    exact *= FRAC_PI_2 / STEPS as f64 * PI / STEPS as f64;
    assert!(
        (sum / 100_000.0 / exact - 1.0).abs() < 0.01,
        "{sum} {exact}"
    );
    // And the mean over all directions is what it says.
    let mean: f64 = random(100_000, 2)
        .map(|u| {
            let sample = sampler.sample(u).unwrap();
            f64::from(sample.radiance.luminance()) / sample.density
        })
        .sum::<f64>()
        / (100_000.0 * 4.0 * PI);
    let said = sampler.mean_irradiance() / PI;
    assert!((mean / said - 1.0).abs() < 0.01, "{mean} {said}");
}

#[test]
fn what_is_not_radiance_counts_as_none() {
    let values = [f32::NAN, -1.0, f32::INFINITY, 0.0];
    let dark = environment([4, 1], 0.0, |x, _| values[x as usize]);
    assert!(EnvironmentSampler::new(&dark).is_none());
    assert_eq!(dark.radiance(UnitVec3::Y), Rgb::BLACK);
    assert!(Environment::new("", [0, 0], vec![], Rgb::WHITE, 0.0).is_none());
    assert!(Environment::new("", [2, 2], vec![[1.0; 3]; 3], Rgb::WHITE, 0.0).is_none());
}
