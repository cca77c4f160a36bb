//! Reflection at a thin film (Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for
//! the Modeling of Varying Iridescence").

use std::f32::consts::PI;

use super::fresnel::{fresnel_dielectric, schlick_weight};
use crate::color::Rgb;

/// A film that is as thin as the waves of light are long.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// Share of the reflection that it changes, in `[0, 1]`.
    pub strength: f32,
    /// Its index of refraction.
    pub index: f32,
    /// Its thickness, nm.
    pub thickness: f32,
}

impl Film {
    /// Reflectance at `cos` for a base of reflectance `f0` at normal incidence, `plain` without
    /// the film.
    pub fn over(&self, f0: Rgb, plain: Rgb, cos: f32) -> Rgb {
        plain.lerp(self.reflectance(f0, cos), self.strength)
    }

    /// The most that a reflectance `f0` at normal incidence becomes, as far as Schlick's formula
    /// towards `f90` can tell: for what lies below.
    pub fn bound(&self, f0: Rgb, f90: f32) -> Rgb {
        [1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1f32]
            .into_iter()
            .map(|cos| {
                let white = schlick_weight(cos);
                let plain = f0.lerp(Rgb::splat(f90), white);
                let seen = self.over(f0, plain, cos);
                seen.map(|f| ((f - white * f90) / (1.0 - white)).clamp(0.0, 1.0))
            })
            .fold(f0, max)
    }

    fn reflectance(&self, f0: Rgb, cos: f32) -> Rgb {
        // A film that fades away must leave nothing behind.
        let t = (self.thickness / 0.03).clamp(0.0, 1.0);
        let index = 1.0 + (self.index - 1.0) * (t * t * (3.0 - 2.0 * t));
        let sin2 = (1.0 - cos * cos) / (index * index);
        if sin2 >= 1.0 {
            return Rgb::WHITE;
        }
        let inner = (1.0 - sin2).sqrt();
        let way = 2.0 * index * self.thickness * inner;

        let outer = fresnel_dielectric(cos, index);
        let through = 1.0 - outer;
        let outer_phase = if index < 1.0 { 0.0 } else { PI };

        // The base as a dielectric of the same reflectance, seen from inside the film.
        let base = f0.map(|f| {
            let root = f.clamp(0.0, 0.9999).sqrt();
            (1.0 + root) / (1.0 - root)
        });
        let inner_white = schlick_weight(inner);
        let bottom = base.map(|base| {
            let f0 = ((base - index) / (base + index)).powi(2);
            f0 + (1.0 - f0) * inner_white
        });
        let phase = base.map(|base| outer_phase + if base < index { PI } else { 0.0 });

        let both = (bottom * outer).map(|r| r.clamp(1e-5, 0.9999));
        let step = both.map(f32::sqrt);
        let [br, bg, bb] = bottom.channels();
        let [or, og, ob] = both.channels();
        let series =
            Rgb::new(br / (1.0 - or), bg / (1.0 - og), bb / (1.0 - ob)) * (through * through);
        let mut sum = series + Rgb::splat(outer);
        let mut amplitude = series - Rgb::splat(through);
        for order in [1.0, 2.0] {
            amplitude *= step;
            sum += amplitude * (sensitivity(order * way, phase * order) * 2.0);
        }
        sum.map(|f| f.clamp(0.0, 1.0))
    }
}

/// The Fourier transform of the eye's sensitivity at a difference of ways in nm and a phase, as
/// linear Rec. 709: Gaussians fitted to the CIE's functions (Belcour and Barla, appendix).
fn sensitivity(way: f32, phase: Rgb) -> Rgb {
    // Height, mean and variance of a Gaussian over 2π per metre.
    let wave = |height: f32, mean: f32, variance: f32, phase: f32| {
        let turn = 2.0 * PI * way * 1e-9;
        height
            * (2.0 * PI * variance).sqrt()
            * (mean * turn + phase).cos()
            * (-variance * turn * turn).exp()
    };
    let x = wave(5.4856e-13, 1.6810e6, 4.3278e9, phase.r)
        + wave(9.7470e-14, 2.2399e6, 4.5282e9, phase.r);
    let y = wave(4.4201e-13, 1.7953e6, 9.3046e9, phase.g);
    let z = wave(5.2481e-13, 2.2084e6, 6.6121e9, phase.b);
    let [x, y, z] = [x, y, z].map(|v| v / 1.0685e-7);
    Rgb::new(
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    )
}

fn max(a: Rgb, b: Rgb) -> Rgb {
    Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(thickness: f32) -> Film {
        Film {
            strength: 1.0,
            index: 1.3,
            thickness,
        }
    }

    /// No film is no film: then what is left is Schlick's formula.
    #[test]
    fn a_film_without_thickness_changes_nothing() {
        for cos in [0.1, 0.4, 1.0f32] {
            let f0 = Rgb::new(0.04, 0.3, 0.9);
            let plain = f0.lerp(Rgb::WHITE, schlick_weight(cos));
            let error = (film(0.0).reflectance(f0, cos) - plain).map(f32::abs);
            assert!(error.max_channel() < 0.01, "cos {cos}: {error:?}");
        }
    }

    /// Waves of many lengths have no phase in common: what is left adds up as intensities do.
    #[test]
    fn a_thick_film_has_no_colour() {
        let got = film(30_000.0).reflectance(Rgb::splat(0.04), 1.0);
        let outer = (0.3f32 / 2.3).powi(2);
        let bottom = (0.2f32 / 2.8).powi(2);
        let exact = outer + (1.0 - outer).powi(2) * bottom / (1.0 - outer * bottom);
        let error = (got - Rgb::splat(exact)).map(f32::abs).max_channel();
        assert!(error < 1e-4, "{got:?} {exact}");
    }

    /// A quarter of a wave between two borders that both flip the phase takes light away; half
    /// a wave adds it (at green, 555 nm).
    #[test]
    fn films_extinguish_and_enhance() {
        let at = |part: f32| {
            film(555.0 * part / 1.3)
                .reflectance(Rgb::splat(0.04), 1.0)
                .g
        };
        assert!(at(0.25) < 0.35 * at(0.5), "{} {}", at(0.25), at(0.5));
    }
}
