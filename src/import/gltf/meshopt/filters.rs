//! What elements of mode 0 stand for. All filters work in place.

use bytemuck::Pod;

/// Calls `decode` on each element of four integers.
fn each<T: Pod>(bytes: &mut [u8], decode: impl Fn(&mut [T; 4])) {
    for bytes in bytes.chunks_exact_mut(size_of::<[T; 4]>()) {
        let mut element: [T; 4] = bytemuck::pod_read_unaligned(bytes);
        decode(&mut element);
        bytes.copy_from_slice(bytemuck::bytes_of(&element));
    }
}

/// Unit vectors as points of an octahedron; the fourth number is left alone.
pub fn octahedral(bytes: &mut [u8], stride: usize) {
    match stride {
        4 => each(bytes, |element: &mut [i8; 4]| {
            let [x, y, one, _] = element.map(f32::from);
            let rounded = unit_vector(x, y, one).map(|v| (v * 127.0).round() as i8);
            element[..3].copy_from_slice(&rounded);
        }),
        _ => each(bytes, |element: &mut [i16; 4]| {
            let [x, y, one, _] = element.map(f32::from);
            let rounded = unit_vector(x, y, one).map(|v| (v * 32767.0).round() as i16);
            element[..3].copy_from_slice(&rounded);
        }),
    }
}

fn unit_vector(x: f32, y: f32, one: f32) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // What lies outside of the upper half is folded onto the lower one.
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

/// Unit quaternions without their largest component.
pub fn quaternion(bytes: &mut [u8]) {
    each(bytes, |element: &mut [i16; 4]| {
        let largest = (element[3] & 3) as usize;
        let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(element[3] | 3);
        let [x, y, z] = [0, 1, 2].map(|i| f32::from(element[i]) * scale);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        for (i, value) in [w, x, y, z].into_iter().enumerate() {
            element[(largest + i) % 4] = (value * 32767.0).round() as i16;
        }
    });
}

/// Floats as mantissa times power of two.
pub fn exponential(bytes: &mut [u8]) {
    for word in bytes.as_chunks_mut::<4>().0 {
        let value = i32::from_le_bytes(*word);
        let (exponent, mantissa) = (value >> 24, value << 8 >> 8);
        // Exact in double precision, so that it is rounded once, and then only when subnormal.
        let float = f64::from(mantissa) * 2_f64.powi(exponent);
        *word = (float as f32).to_le_bytes();
    }
}

/// Colours as brightness and differences (YCoCg), with alpha.
pub fn color(bytes: &mut [u8], stride: usize) {
    match stride {
        4 => each(bytes, |element: &mut [u8; 4]| {
            let [y, orange, green, alpha] = *element;
            let differences = [orange, green].map(|v| i32::from(v.cast_signed()));
            let channels = channels(i32::from(y), differences, u32::from(alpha));
            *element = channels.map(|v| (v * 255.0).round() as u8);
        }),
        _ => each(bytes, |element: &mut [u16; 4]| {
            let [y, orange, green, alpha] = *element;
            let differences = [orange, green].map(|v| i32::from(v.cast_signed()));
            let channels = channels(i32::from(y), differences, u32::from(alpha));
            *element = channels.map(|v| (v * 65535.0).round() as u16);
        }),
    }
}

/// Red, green, blue and alpha, 1 at most. How many bits the numbers have is told by the highest of
/// alpha, which has one fewer.
fn channels(y: i32, [orange, green]: [i32; 2], alpha: u32) -> [f32; 4] {
    let bits = u32::BITS - alpha.leading_zeros();
    let largest = (1_u32 << bits) - 1;
    let low = alpha & (largest >> 1);
    let alpha = (low << 1 | low & 1) as f32;
    let [red, blue] = [y + orange - green, y - orange - green];
    [red as f32, (y + green) as f32, blue as f32, alpha].map(|v| v / largest as f32)
}
