//! Samples of scattering follow the density that is said of them, and carry the weight that
//! belongs to it.

use std::f64::consts::TAU;

use halfshade::color::Rgb;
use halfshade::material::{Bsdf, Lookup, MAX_UV_SETS, Material, View};
use halfshade::math::{DVec3, Frame, UnitVec3, Vec2};
use halfshade::texture::{TexturedRgb, TexturedScalar};

use crate::common::chi_square::{Moments, p_value};
use crate::materials::{self, Case, cases};

/// Rows of equal solid angle over the sphere, and columns of each.
const ROWS: usize = 24;
const COLUMNS: usize = 24;
/// Cuts of each side of a bin when its density is integrated.
const CUTS: usize = 16;

/// How a flat surface with the normal z is seen from so many degrees above it.
pub fn view(degrees_above: f64, is_inside: bool) -> View {
    let (sin, cos) = degrees_above.to_radians().sin_cos();
    let turned = DVec3::new(cos * 0.8, cos * 0.6, sin);
    View {
        frame: Frame {
            tangent: halfshade::math::Vec3::X,
            bitangent: halfshade::math::Vec3::Y,
            normal: UnitVec3::Z,
        },
        wo: UnitVec3::normalize(turned.as_vec3()).unwrap(),
        coat_normal: UnitVec3::Z,
        is_inside,
    }
}

/// As paths use it.
pub fn bsdf(material: &Material) -> Bsdf {
    let lookup = Lookup {
        textures: &[],
        images: &[],
        uvs: [Vec2::ZERO; MAX_UV_SETS],
        color: [1.0; 4],
    };
    material.bsdf(&lookup).conserving()
}

/// A mirror of an MTL file has its colour as a highlight, too.
#[test]
fn colors_beyond_1_take_from_highlights_first() {
    let of = |diffuse: f32, specular: f32, reflect: f32| {
        let material = materials::phong(|p| {
            p.diffuse = TexturedRgb::constant(Rgb::splat(diffuse));
            p.specular = TexturedRgb::constant(Rgb::splat(specular));
            p.exponent = TexturedScalar::constant(100.0);
            p.reflect = Rgb::splat(reflect);
        });
        let bsdf = bsdf(&material);
        // What of a white sky a mirror and everything sends back.
        let all = mean_weight(&bsdf, &view(90.0, false), 20_000)[0].mean();
        [bsdf.diffuse().g, bsdf.specular.reflect.g, all as f32]
    };
    for (given, kept) in [
        ([0.0, 0.9, 0.9], [0.0, 0.9, 1.0]),
        ([0.8, 0.5, 0.0], [0.8, 0.0, 1.0]),
        ([0.3, 0.2, 0.1], [0.3, 0.1, 0.6]),
        ([0.8, 0.5, 0.8], [0.5, 0.5, 1.0]),
    ] {
        let got = of(given[0], given[1], given[2]);
        let is_near = |i: usize| (got[i] - kept[i]).abs() < 0.01;
        assert!((0..3).all(is_near), "{given:?}: {got:?}");
    }
}

/// Independent numbers in `[0, 1)` (SplitMix64).
fn random(state: &mut u64) -> f32 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 40) as f32 / 16_777_216.0
}

/// Three of them.
fn point(state: &mut u64) -> (f32, Vec2) {
    let u_lobe = random(state);
    (u_lobe, Vec2::new(random(state), random(state)))
}

fn direction(z: f64, phi: f64) -> UnitVec3 {
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let v = DVec3::new(ring * phi.cos(), ring * phi.sin(), z);
    UnitVec3::normalize(v.as_vec3()).unwrap()
}

fn bin_of(wi: UnitVec3) -> usize {
    let row = ((f64::from(wi.z) * 0.5 + 0.5) * ROWS as f64) as usize;
    let phi = f64::from(wi.y).atan2(f64::from(wi.x)).rem_euclid(TAU);
    let column = (phi / TAU * COLUMNS as f64) as usize;
    row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
}

/// The density's integral over each bin.
fn expected(bsdf: &Bsdf, view: &View) -> Vec<f64> {
    let mut shares = vec![0.0; ROWS * COLUMNS];
    let row_of = |z: f64| ((z * 0.5 + 0.5) * ROWS as f64) as usize;
    let half = ROWS / 2;
    for row in 0..half {
        // Even steps of the root of 1 - z: near the pole those are even angles.
        let root = |z: f64| (1.0 - z).sqrt();
        let [far, near] = [row, row + 1].map(|row| root(row as f64 / half as f64));
        let step = (far - near) / CUTS as f64;
        for cut in 0..CUTS {
            let root = near + (cut as f64 + 0.5) * step;
            let z = 1.0 - root * root;
            for column in 0..COLUMNS * CUTS {
                let phi = TAU * (column as f64 + 0.5) / (COLUMNS * CUTS) as f64;
                let area = 2.0 * root * step * TAU / (COLUMNS * CUTS) as f64;
                for z in [z, -z] {
                    let bin = row_of(z) * COLUMNS + column / CUTS;
                    shares[bin] += f64::from(bsdf.pdf(view, direction(z, phi))) * area;
                }
            }
        }
    }
    shares
}

#[test]
fn samples_follow_their_density() {
    const SAMPLES: u32 = 30_000;
    let mut least: (f64, String) = (1.0, String::new());
    let mut tests = 0;
    for Case {
        name,
        material,
        is_inside,
        ..
    } in cases().iter().filter(|case| case.is_wide)
    {
        let bsdf = bsdf(material);
        for degrees in [20.0, 45.0, 80.0] {
            let view = view(degrees, *is_inside);
            let shares = expected(&bsdf, &view);
            let mut counts = vec![0; shares.len()];
            let mut elsewhere = 0;
            let mut state = 7;
            for _ in 0..SAMPLES {
                let (u_lobe, u) = point(&mut state);
                match bsdf.sample(&view, u_lobe, u) {
                    Some(sample) if !sample.is_specular => counts[bin_of(sample.wi)] += 1,
                    _ => elsewhere += 1,
                }
            }
            let what = format!("{name}, {degrees} degrees");
            let total: f64 = shares.iter().sum();
            assert!(total < 1.0 + 1e-2, "{what}: densities add up to {total}");
            // Bins that expect little are put together, with what comes from nowhere.
            let mut rest = (elsewhere, (1.0 - total).max(0.0));
            let (mut kept, mut probabilities) = (Vec::new(), Vec::new());
            for (&count, &share) in counts.iter().zip(&shares) {
                if share * f64::from(SAMPLES) < 12.0 {
                    rest = (rest.0 + count, rest.1 + share);
                } else {
                    kept.push(count);
                    probabilities.push(share);
                }
            }
            if rest.1 * f64::from(SAMPLES) >= 12.0 {
                kept.push(rest.0);
                probabilities.push(rest.1);
            } else {
                assert!(
                    rest.0 < 60,
                    "{what}: {} samples where none are expected",
                    rest.0
                );
            }
            let p = p_value(&kept, &probabilities);
            tests += 1;
            if p < least.0 {
                least = (p, what);
            }
        }
    }
    let limit = 1e-3 / f64::from(tests);
    assert!(least.0 > limit, "p {:e} < {limit:e}: {}", least.0, least.1);
}

#[test]
fn weights_are_value_times_cosine_over_density() {
    for Case {
        name,
        material,
        is_inside,
        ..
    } in &cases()
    {
        let bsdf = bsdf(material);
        for degrees in [3.0, 25.0, 60.0, 90.0] {
            let view = view(degrees, *is_inside);
            let mut state = 1;
            for _ in 0..2000 {
                let (u_lobe, u) = point(&mut state);
                let Some(sample) = bsdf.sample(&view, u_lobe, u) else {
                    continue;
                };
                let what = format!("{name}, {degrees} degrees, {sample:?}");
                assert_eq!(sample.is_transmitted, sample.wi.z < 0.0, "{what}");
                assert!(sample.weight.is_finite(), "{what}");
                assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{what}");
                if sample.is_specular {
                    assert_eq!(sample.pdf, 0.0, "{what}");
                    continue;
                }
                let pdf = bsdf.pdf(&view, sample.wi);
                assert!((pdf - sample.pdf).abs() <= 1e-4 * pdf, "{what}: {pdf}");
                let exact = bsdf.value(&view, sample.wi) * (sample.wi.z.abs() / pdf);
                let error = (exact - sample.weight).map(f32::abs).max_channel();
                assert!(error <= 1e-4 * exact.max_channel(), "{what}: {exact:?}");
            }
        }
    }
}

/// The share of the light of a uniform sky that comes to the viewer, per channel.
pub fn mean_weight(bsdf: &Bsdf, view: &View, samples: u32) -> [Moments; 3] {
    let mut moments = [Moments::default(); 3];
    let mut state = 3;
    for _ in 0..samples {
        let (u_lobe, u) = point(&mut state);
        let sample = bsdf.sample(view, u_lobe, u);
        let weight = sample.map_or(Rgb::BLACK, |sample| sample.weight);
        for (moments, channel) in moments.iter_mut().zip(weight.channels()) {
            moments.add(channel.into());
        }
    }
    moments
}

#[test]
fn no_lobe_gives_back_more_than_it_gets() {
    let mut faults = Vec::new();
    for Case {
        name,
        material,
        is_inside,
        ..
    } in &cases()
    {
        let bsdf = bsdf(material);
        for degrees in [1.0, 4.0, 12.0, 35.0, 90.0] {
            let drawn = mean_weight(&bsdf, &view(degrees, *is_inside), 5000);
            for (channel, drawn) in drawn.iter().enumerate() {
                let least = drawn.mean() - 5.0 * drawn.standard_error();
                // Tables are within 4e-3.
                if least > 1.004 {
                    faults.push(format!("{name}, {degrees} degrees, {channel}: {least}"));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn reflection_is_the_same_both_ways() {
    for Case {
        name,
        material,
        is_inside,
        ..
    } in &cases()
    {
        let bsdf = bsdf(material);
        let mut state = 5;
        for _ in 0..1500 {
            let (a, u) = point(&mut state);
            let there = direction(f64::from(a) * 0.99 + 0.01, TAU * f64::from(u.x));
            let back = direction(f64::from(u.y) * 0.99 + 0.01, 40.0 * f64::from(a));
            let seen = |wo| View {
                wo,
                ..view(90.0, *is_inside)
            };
            let f = bsdf.value(&seen(there), back);
            let g = bsdf.value(&seen(back), there);
            let error = (f - g).map(f32::abs).max_channel();
            assert!(
                error <= 2e-4 * f.max_channel().max(g.max_channel()),
                "{name}: {f:?} {g:?}"
            );
        }
    }
}

/// Basic radiance L/n², as paths carry it: what is refracted from outside to inside weighs more
/// than the way back by the square of the index.
#[test]
fn refraction_is_the_same_both_ways() {
    for (roughness, index) in [(0.3, 1.5), (0.6, 1.33), (1.0, 1.5), (1.0, 2.4)] {
        let bsdf = bsdf(&materials::body(roughness, index));
        let mut state = 6;
        let mut met = 0;
        for _ in 0..1500 {
            let (a, u) = point(&mut state);
            let [above, below] = [a, u.x].map(|z| f64::from(z) * 0.99 + 0.01);
            let [here, there] = [f64::from(u.y), 40.0 * f64::from(a)].map(|turn| TAU * turn);
            // From the other side the frame is turned about x.
            let outside = View {
                wo: direction(above, here),
                ..view(90.0, false)
            };
            let inside = View {
                wo: direction(below, -there),
                ..view(90.0, true)
            };
            let f = bsdf.value(&outside, direction(-below, there)).g;
            let g = bsdf.value(&inside, direction(-above, -here)).g * index * index;
            met += u32::from(f > 0.0);
            let what = format!("roughness {roughness}, index {index}");
            assert!((f - g).abs() <= 2e-3 * f.max(g) + 1e-6, "{what}: {f} {g}");
        }
        assert!(met > 500, "{met}");
    }
}

/// What rough surfaces lose: light that meets several facets is added by tables.
#[test]
fn white_lobes_lose_little() {
    type Kind = (&'static str, fn(f32) -> Material, bool, f64);
    let kinds: [Kind; 7] = [
        ("metal", materials::metal, false, 0.015),
        ("plastic", materials::plastic, false, 0.015),
        (
            "pane",
            |roughness| materials::glass(roughness, false, 0.0),
            false,
            0.02,
        ),
        (
            "body",
            |roughness| materials::body(roughness, 1.5),
            false,
            0.015,
        ),
        (
            "body from inside",
            |roughness| materials::body(roughness, 1.5),
            true,
            0.015,
        ),
        (
            "diamond",
            |roughness| materials::body(roughness, 2.4),
            true,
            0.015,
        ),
        (
            "prism",
            |roughness| materials::glass(roughness, true, 3.0),
            true,
            0.015,
        ),
    ];
    for (name, material, is_inside, most) in kinds {
        let mut text = String::new();
        for roughness in [0.3, 0.45, 0.6, 0.8, 1.0f32] {
            let bsdf = bsdf(&material(roughness));
            let losses = [12.0, 35.0, 60.0, 90.0].map(|degrees| {
                let [_, green, _] = mean_weight(&bsdf, &view(degrees, is_inside), 20_000);
                let loss = 1.0 - green.mean();
                (loss, loss - 4.0 * green.standard_error())
            });
            let largest = losses.map(|(loss, _)| loss).into_iter().fold(0.0, f64::max);
            let least = losses
                .map(|(_, least)| least)
                .into_iter()
                .fold(0.0, f64::max);
            assert!(
                least < most,
                "{name}, roughness {roughness}: {least} is lost"
            );
            text += &format!(" {roughness}: {:.1} %", 100.0 * largest);
        }
        println!("{name}: the most that is lost from any side, by roughness:{text}");
    }
}
