//! The light of the surroundings: a picture of all directions.

use std::f64::consts::{PI, TAU};

use crate::color::Rgb;
use crate::math::{DVec3, UnitVec3, Vec2};

/// Radiance from every direction, as a picture in latitude and longitude.
///
/// The middle of the picture is at -z and its right half towards +x; the top row is up (+y). Values
/// between the centres of pixels are interpolated.
#[derive(Clone, Debug)]
pub struct Environment {
    /// File name or other name for messages.
    pub name: String,
    width: u32,
    height: u32,
    /// Row by row from the top.
    pixels: Vec<[f32; 3]>,
    /// Sine and cosine of how far it is turned about y.
    turn: [f64; 2],
    /// What every value is multiplied with.
    factor: Rgb,
}

impl Environment {
    /// `width` × `height` pixels, linear radiance W/(m² sr), times `factor`. Turned by `rotate_radians`
    /// about y, counter-clockwise seen from above.
    ///
    /// `None` where there are no pixels, or another number of them. Values that are negative or not
    /// finite count as 0.
    pub fn new(
        name: impl Into<String>,
        [width, height]: [u32; 2],
        mut pixels: Vec<[f32; 3]>,
        factor: Rgb,
        rotate_radians: f64,
    ) -> Option<Self> {
        let count = width as usize * height as usize;
        if count == 0 || pixels.len() != count || factor.is_black() {
            return None;
        }
        for value in pixels.as_flattened_mut() {
            // NaN too.
            if !(*value >= 0.0 && value.is_finite()) {
                *value = 0.0;
            }
        }
        Some(Self {
            name: name.into(),
            width,
            height,
            pixels,
            turn: rotate_radians.sin_cos().into(),
            factor,
        })
    }

    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Radiance that comes from `direction` (which points there), W/(m² sr).
    pub fn radiance(&self, direction: UnitVec3) -> Rgb {
        let [u, v] = self.place(direction.as_dvec3());
        let x = u * f64::from(self.width) - 0.5;
        let y = v * f64::from(self.height) - 0.5;
        let (fx, fy) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
        let (x, y) = (x.floor() as i64, y.floor() as i64);
        let top = self.pixel(x, y).lerp(self.pixel(x + 1, y), fx);
        let bottom = self.pixel(x, y + 1).lerp(self.pixel(x + 1, y + 1), fx);
        top.lerp(bottom, fy) * self.factor
    }

    /// Columns go on around the picture; rows end at the poles.
    fn pixel(&self, x: i64, y: i64) -> Rgb {
        let x = x.rem_euclid(i64::from(self.width)) as usize;
        let y = y.clamp(0, i64::from(self.height) - 1) as usize;
        Rgb::from(self.pixels[y * self.width as usize + x])
    }

    /// Where in the picture a direction is, `[0, 1]²`.
    fn place(&self, direction: DVec3) -> [f64; 2] {
        let [sin, cos] = self.turn;
        let x = direction.x * cos - direction.z * sin;
        let z = direction.x * sin + direction.z * cos;
        let across = (x * x + z * z).sqrt();
        // The angle from +y; by the arctangent, which keeps its digits at the poles.
        [0.5 + x.atan2(-z) / TAU, across.atan2(direction.y) / PI]
    }

    /// The inverse of [`Self::place`], and the sine of the angle from +y.
    fn direction(&self, u: f64, v: f64) -> (DVec3, f64) {
        let (sin_across, cos_across) = ((u - 0.5) * TAU).sin_cos();
        let (sin_down, cos_down) = (v * PI).sin_cos();
        let (x, z) = (sin_across * sin_down, -cos_across * sin_down);
        let [sin, cos] = self.turn;
        let direction = DVec3::new(x * cos + z * sin, cos_down, z * cos - x * sin);
        (direction, sin_down)
    }

    /// Bytes of the pixels in memory.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.pixels.as_slice())
    }
}

/// Picks directions of an [`Environment`] by how bright they are.
///
/// A row, then a pixel of it, each in proportion to its luminance times its solid angle; then any
/// point of the pixel (Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", section A.5.6).
#[derive(Clone, Debug)]
pub struct EnvironmentSampler<'a> {
    environment: &'a Environment,
    /// Shares of all rows up to each; ends at 1.
    rows: Vec<f64>,
    /// By row: shares of its pixels up to each; ends at 1, or is all 0 in a black row.
    columns: Vec<f32>,
    /// Mean radiance over all directions, by luminance.
    mean: f64,
}

/// A direction that was picked.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentSample {
    /// Towards the light.
    pub wi: UnitVec3,
    /// Radiance from there, W/(m² sr).
    pub radiance: Rgb,
    /// By solid angle.
    pub density: f64,
}

impl<'a> EnvironmentSampler<'a> {
    /// `None` where all is black.
    pub fn new(environment: &'a Environment) -> Option<Self> {
        let (width, height) = (environment.width as usize, environment.height as usize);
        let mut columns = Vec::with_capacity(width * height);
        let mut rows = Vec::with_capacity(height);
        let mut sum = 0.0;
        for y in 0..height {
            let sin = ((y as f64 + 0.5) / height as f64 * PI).sin();
            sum += sin
                * push_shares(
                    &mut columns,
                    (0..width).map(|x| environment.mean_near(x, y)),
                );
            rows.push(sum);
        }
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        for row in &mut rows {
            *row /= sum;
        }
        Some(Self {
            environment,
            rows,
            columns,
            mean: sum / (width * height) as f64 * 0.5 * PI,
        })
    }

    /// The direction for `u` in `[0, 1)²`.
    pub fn sample(&self, u: Vec2) -> Option<EnvironmentSample> {
        let width = self.environment.width as usize;
        let (y, inside_y) = pick(&self.rows, f64::from(u.y), |&share| share);
        let row = &self.columns[y * width..(y + 1) * width];
        let (x, inside_x) = pick(row, f64::from(u.x), |&share| f64::from(share));
        let u = (x as f64 + inside_x) / width as f64;
        let v = (y as f64 + inside_y) / f64::from(self.environment.height);
        let (direction, sin) = self.environment.direction(u, v);
        let wi = UnitVec3::normalize_f64(direction)?;
        let density = self.density_of(x, y, sin);
        (density > 0.0 && density.is_finite()).then(|| EnvironmentSample {
            wi,
            radiance: self.environment.radiance(wi),
            density,
        })
    }

    /// The density by solid angle with which [`Self::sample`] takes `wi`.
    pub fn density(&self, wi: UnitVec3) -> f64 {
        let [u, v] = self.environment.place(wi.as_dvec3());
        let [width, height] = self.environment.size().map(|n| n as usize);
        let x = ((u * width as f64) as usize).min(width - 1);
        let y = ((v * height as f64) as usize).min(height - 1);
        let density = self.density_of(x, y, (v * PI).sin());
        if density.is_finite() { density } else { 0.0 }
    }

    /// The same inside of the pixel, where the angle from +y has the sine `sin`.
    fn density_of(&self, x: usize, y: usize, sin: f64) -> f64 {
        let width = self.environment.width as usize;
        let row = &self.columns[y * width..(y + 1) * width];
        let share = |end: f64, start: Option<f64>| end - start.unwrap_or(0.0);
        let of_rows = share(self.rows[y], y.checked_sub(1).map(|y| self.rows[y]));
        let of_row = share(row[x].into(), x.checked_sub(1).map(|x| row[x].into()));
        let pixels = (width * self.rows.len()) as f64;
        of_rows * of_row * pixels / (2.0 * PI * PI * sin)
    }

    /// Its irradiance on a sphere of any size, by luminance: π times the mean radiance, W/m².
    pub fn mean_irradiance(&self) -> f64 {
        let factor = f64::from(self.environment.factor.luminance());
        PI * self.mean * factor
    }
}

impl Environment {
    /// Luminance of a pixel, averaged over what interpolation shows of it.
    fn mean_near(&self, x: usize, y: usize) -> f64 {
        const WEIGHTS: [f64; 3] = [0.125, 0.75, 0.125];
        let (x, y) = (x as i64, y as i64);
        let mut sum = 0.0;
        for (dy, wy) in (-1..).zip(WEIGHTS) {
            for (dx, wx) in (-1..).zip(WEIGHTS) {
                sum += wx * wy * f64::from(self.pixel(x + dx, y + dy).luminance());
            }
        }
        sum
    }
}

/// Appends the shares of all `values` up to each, and returns their sum.
fn push_shares(shares: &mut Vec<f32>, values: impl Iterator<Item = f64> + Clone) -> f64 {
    let total: f64 = values.clone().sum();
    let mut sum = 0.0;
    let scale = if total > 0.0 { 1.0 / total } else { 0.0 };
    shares.extend(values.map(|value| {
        sum += value;
        (sum * scale) as f32
    }));
    // The last is 1 in spite of rounding.
    if let (Some(last), true) = (shares.last_mut(), total > 0.0) {
        *last = 1.0;
    }
    total
}

/// The entry of rising `shares` that `u` falls into, and where in it, `[0, 1)`.
fn pick<T>(shares: &[T], u: f64, value: impl Fn(&T) -> f64) -> (usize, f64) {
    let index = shares.partition_point(|share| value(share) <= u);
    let index = index.min(shares.len() - 1);
    let start = index.checked_sub(1).map_or(0.0, |i| value(&shares[i]));
    let end = value(&shares[index]);
    let inside = if end > start {
        (u - start) / (end - start)
    } else {
        0.5
    };
    (index, inside.clamp(0.0, 1.0 - f64::EPSILON))
}
