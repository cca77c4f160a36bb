//! The light tree: its probabilities add up, are those it chooses with, and leave out nothing that shines.

use halfshade::color::Rgb;
use halfshade::light::{Falloff, Light, LightBounds, LightTree, Receiver, SpotLight};
use halfshade::math::{Aabb, UnitVec3, Vec3};

use crate::common::chi_square::survival;
use crate::random;

/// Reproducible numbers in [0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((self.0 >> 40) as f32) / (1u64 << 24) as f32
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }

    fn unit(&mut self) -> UnitVec3 {
        UnitVec3::normalize(self.vector()).unwrap_or(UnitVec3::Z)
    }
}

/// Lights of all kinds, sizes and strengths; every tenth is off.
fn lights(count: usize, seed: u64) -> Vec<Option<LightBounds>> {
    let mut numbers = Numbers(seed);
    (0..count)
        .map(|i| {
            let at = 10.0 * numbers.vector();
            let reach = numbers.next().powi(4) * Vec3::ONE;
            let bounds = Aabb::of_points([at - reach, at + reach]);
            let power = f64::from(numbers.next()).powi(6) + 1e-6;
            let normal = numbers.unit();
            match i % 10 {
                0 => None,
                1..=3 => Some(LightBounds::in_all_directions(bounds, power)),
                4..=5 => Some(LightBounds::flat(bounds, normal, true, power)),
                _ => Some(LightBounds::flat(bounds, normal, false, power)),
            }
        })
        .collect()
}

fn receivers(seed: u64) -> Vec<Receiver> {
    let mut numbers = Numbers(seed);
    (0..12)
        .map(|i| Receiver {
            point: 12.0 * numbers.vector(),
            normal: (i % 3 > 0).then(|| numbers.unit()),
        })
        .collect()
}

#[test]
fn probabilities_add_up_to_one() {
    for count in [2, 3, 30, 1000] {
        let bounds = lights(count, count as u64);
        let tree = LightTree::build(&bounds);
        for receiver in receivers(5) {
            let sum: f64 = (0..count as u32)
                .map(|light| tree.probability(&receiver, light))
                .sum();
            // Less only where a walk may end among lights that do not reach the receiver.
            assert!(sum <= 1.0 + 1e-9, "{count} lights: {sum}");
            if receiver.normal.is_none() && count >= 30 {
                assert!(sum > 0.9, "{count} lights: {sum}");
            }
            for (light, bounds) in (0..).zip(&bounds) {
                if bounds.is_none() {
                    assert_eq!(tree.probability(&receiver, light), 0.0);
                }
            }
        }
    }
}

#[test]
fn lights_that_reach_everywhere_are_chosen_for_sure() {
    let bounds: Vec<_> = lights(500, 8)
        .into_iter()
        .map(|b| b.map(|b| LightBounds::in_all_directions(b.bounds, b.intensity)))
        .collect();
    let tree = LightTree::build(&bounds);
    for mut receiver in receivers(9) {
        receiver.normal = None;
        let sum: f64 = (0..500).map(|l| tree.probability(&receiver, l)).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }
}

/// Chi-square of what is chosen against what is said.
#[test]
fn choices_have_the_probability_that_is_said() {
    const COUNT: u32 = 50_000;
    let bounds = lights(60, 1);
    let tree = LightTree::build(&bounds);
    for (number, receiver) in receivers(2).into_iter().enumerate() {
        let mut counts = vec![0.0f64; bounds.len() + 1];
        for u in random(COUNT, number as u64) {
            let u = f64::from(u.x) + f64::from(u.y) / f64::from(1 << 24);
            match tree.choose(&receiver, u) {
                None => counts[bounds.len()] += 1.0,
                Some((light, probability)) => {
                    let said = tree.probability(&receiver, light);
                    assert!((probability / said - 1.0).abs() < 1e-9);
                    counts[light as usize] += 1.0;
                }
            }
        }
        let mut expected: Vec<f64> = (0..bounds.len() as u32)
            .map(|light| tree.probability(&receiver, light) * f64::from(COUNT))
            .collect();
        expected.push(f64::from(COUNT) - expected.iter().sum::<f64>());
        let (mut statistic, mut cells, mut rest) = (0.0, 0, (0.0, 0.0));
        for (count, expected) in counts.iter().zip(&expected) {
            if *expected >= 5.0 {
                statistic += (count - expected).powi(2) / expected;
                cells += 1;
            } else {
                rest = (rest.0 + count, rest.1 + expected);
            }
        }
        if rest.1 >= 5.0 {
            statistic += (rest.0 - rest.1).powi(2) / rest.1;
            cells += 1;
        }
        let p = survival(statistic, (cells - 1usize).max(1));
        assert!(p > 1e-4, "receiver {number}: p = {p}, {cells} cells");
    }
}

/// A matte emitter that brings any light to a point is never left out: its bounds are conservative.
#[test]
fn what_reaches_a_point_may_be_chosen() {
    let mut numbers = Numbers(77);
    let mut corners = Vec::new();
    let bounds: Vec<_> = (0..300)
        .map(|_| {
            let at = 3.0 * numbers.vector();
            let triangle: [Vec3; 3] = std::array::from_fn(|_| at + 0.4 * numbers.vector());
            corners.push(triangle);
            let [a, b, c] = triangle;
            let cross = (b - a).cross(c - a);
            let normal = UnitVec3::normalize(cross).unwrap();
            let power = f64::from(cross.length());
            Some(LightBounds::flat(
                Aabb::of_points(triangle),
                normal,
                false,
                power,
            ))
        })
        .collect();
    let tree = LightTree::build(&bounds);
    let mut reached = 0;
    for receiver in receivers(4) {
        let point = receiver.point / 4.0;
        let receiver = Receiver { point, ..receiver };
        for (light, [a, b, c]) in (0..).zip(&corners) {
            let normal = (*b - *a).cross(*c - *a);
            let is_lit = normal.dot(point - *a) > 0.0
                && [a, b, c]
                    .into_iter()
                    .any(|corner| receiver.normal.is_none_or(|n| n.dot(*corner - point) > 0.0));
            if is_lit {
                reached += 1;
                assert!(
                    tree.probability(&receiver, light) > 0.0,
                    "light {light} of {point}"
                );
            }
        }
    }
    assert!(reached > 500, "{reached}");
}

/// Near ones, strong ones and those that face the point are preferred.
#[test]
fn importance_follows_distance_power_and_direction() {
    let at = |x: f32| Aabb::of_points([Vec3::new(x, 0.0, 0.0)]);
    let receiver = Receiver {
        point: Vec3::ZERO,
        normal: None,
    };
    let probability =
        |bounds: [LightBounds; 2]| LightTree::build(&bounds.map(Some)).probability(&receiver, 0);
    let round = LightBounds::in_all_directions;
    assert!((probability([round(at(1.0), 1.0), round(at(-2.0), 1.0)]) - 0.8).abs() < 1e-6);
    assert!((probability([round(at(1.0), 3.0), round(at(-1.0), 1.0)]) - 0.75).abs() < 1e-6);
    let x = UnitVec3::normalize(Vec3::X).unwrap();
    let away = LightBounds::flat(at(1.0), x, false, 1.0);
    let toward = LightBounds::flat(at(1.0), -x, false, 1.0);
    assert_eq!(probability([away, round(at(-9.0), 1e-3)]), 0.0);
    assert!(probability([toward, away]) == 1.0);
}

#[test]
fn a_spot_is_chosen_in_its_cone_only() {
    let spot = Light::Spot(SpotLight {
        position: Vec3::Y,
        direction: -UnitVec3::Y,
        intensity: Rgb::WHITE,
        inner_angle_radians: 0.2,
        outer_angle_radians: 0.5,
        radius: 0.0,
        samples: 1,
        falloff: Falloff::INVERSE_SQUARE,
    });
    let other = LightBounds::in_all_directions(Aabb::of_points([Vec3::splat(9.0)]), 1e-9);
    let tree = LightTree::build(&[spot.light_bounds(), Some(other)]);
    for (x, is_in) in [
        (0.0f32, true),
        (0.2, true),
        (0.5, true),
        (0.6, false),
        (3.0, false),
    ] {
        let receiver = Receiver {
            point: Vec3::new(x, 0.0, 0.0),
            normal: None,
        };
        assert_eq!(tree.probability(&receiver, 0) > 0.0, is_in, "at {x}");
    }
}

/// 100,000 lights: the tree is built in moments, and finds the near ones.
#[test]
fn a_hundred_thousand_lights_are_no_burden() {
    let mut numbers = Numbers(3);
    let bounds: Vec<_> = (0..100_000)
        .map(|_| {
            let at = Aabb::of_points([100.0 * numbers.vector()]);
            Some(LightBounds::in_all_directions(at, 1.0))
        })
        .collect();
    let tree = LightTree::build(&bounds);
    let receiver = Receiver {
        point: Vec3::new(1.0, 2.0, 3.0),
        normal: None,
    };
    // An even choice would need 100,000 tries for as much of the light as one lamp brings.
    let squared = |light: u32| {
        let at = bounds[light as usize].unwrap().bounds.min;
        f64::from(at.distance_squared(receiver.point))
    };
    let all: f64 = (0..100_000).map(|l| 1.0 / squared(l)).sum();
    let values: Vec<f64> = random(2_000, 1)
        .map(|u| {
            let u = f64::from(u.x) + f64::from(u.y) / f64::from(1 << 24);
            let (light, probability) = tree.choose(&receiver, u).unwrap();
            1.0 / squared(light) / probability / all
        })
        .collect();
    let mean = values.iter().sum::<f64>() / 2_000.0;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 2_000.0;
    assert!(
        (mean - 1.0).abs() < 5.0 * (variance / 2_000.0).sqrt(),
        "{mean}"
    );
    assert!(variance < 1.0, "one sample has a variance of {variance}");
}
