//! Mode 2: indices, each as its distance from one of two before it.

use super::Fault;
use super::reader::Reader;

/// `count` indices.
pub fn decode(stream: &[u8], count: usize) -> Result<Vec<u32>, Fault> {
    let (header, mut reader, _) = Reader::split(stream, 4)?;
    if header != 0xd1 {
        return Err("it is of a version that is not known");
    }
    let mut last = [0_u32; 2];
    let mut index = || {
        let value = reader.variable_integer()?;
        let delta = (value >> 2) ^ (value >> 1 & 1).wrapping_neg();
        let last = &mut last[(value & 1) as usize];
        *last = last.wrapping_add(delta);
        Ok(*last)
    };
    let indices = (0..count).map(|_| index()).collect::<Result<_, Fault>>()?;
    reader.finish()?;
    Ok(indices)
}
