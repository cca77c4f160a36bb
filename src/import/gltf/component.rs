//! The number types that accessors are made of.

/// A number as it lies in a buffer, little-endian and not aligned.
pub trait Component: Copy {
    /// Bytes of one.
    const SIZE: usize;

    /// From the first [`Self::SIZE`] bytes.
    fn read_le(bytes: &[u8]) -> Self;
}

macro_rules! component {
    ($($number:ty)*) => {$(
        impl Component for $number {
            const SIZE: usize = size_of::<Self>();

            fn read_le(bytes: &[u8]) -> Self {
                let mut own = [0; size_of::<Self>()];
                own.copy_from_slice(&bytes[..Self::SIZE]);
                Self::from_le_bytes(own)
            }
        }
    )*};
}

component!(i8 u8 i16 u16 u32 f32);

/// `componentType` of each, as OpenGL numbers them.
pub mod code {
    pub const I8: u32 = 5120;
    pub const U8: u32 = 5121;
    pub const I16: u32 = 5122;
    pub const U16: u32 = 5123;
    pub const U32: u32 = 5125;
    pub const F32: u32 = 5126;
}

/// A signed integer as a number in `[-1, 1]` (glTF 2.0, section 3.11): the lowest two values are
/// both -1.
pub fn signed_normalized(value: impl Into<f32>, largest: impl Into<f32>) -> f32 {
    (value.into() / largest.into()).max(-1.0)
}
