//! Mode 0: elements of any kind, as differences of their bytes.

use super::Fault;
use super::reader::Reader;

/// Elements that share headers.
const GROUP: usize = 16;
/// Elements of a block at most.
const MAX_BLOCK: usize = 256;
/// Bytes of a block at most.
const MAX_BLOCK_BYTES: usize = 8192;

/// How many bits a difference has in a group, by header; 8 is a byte as it is.
const VERSION_0_BITS: [u32; 4] = [0, 2, 4, 8];
/// The same in version 1, by control mode.
const VERSION_1_BITS: [[u32; 4]; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

/// What the bytes of a channel, four in a row, are differences of.
#[derive(Clone, Copy)]
enum Channel {
    Bytes,
    Halves,
    /// Exclusive or, rotated by so many bits.
    Words(u32),
}

impl Channel {
    fn from_code(code: u8) -> Result<Self, Fault> {
        match (code & 15, code >> 4) {
            (0, 0) => Ok(Self::Bytes),
            (1, 0) => Ok(Self::Halves),
            (2, rotation) => Ok(Self::Words(u32::from(rotation))),
            _ => Err("a channel mode that is not known"),
        }
    }

    /// The element after `last`, whose difference is `delta`.
    fn next(self, last: [u8; 4], delta: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Bytes => std::array::from_fn(|i| last[i].wrapping_add(unzigzag8(delta[i]))),
            Self::Halves => {
                let half = |[low, high]: [u8; 2], [delta_low, delta_high]: [u8; 2]| {
                    let delta = unzigzag16(u16::from_le_bytes([delta_low, delta_high]));
                    let last = u16::from_le_bytes([low, high]);
                    last.wrapping_add(delta).to_le_bytes()
                };
                let [a, b, c, d] = last;
                let [da, db, dc, dd] = delta;
                let [[a, b], [c, d]] = [half([a, b], [da, db]), half([c, d], [dc, dd])];
                [a, b, c, d]
            }
            Self::Words(rotation) => {
                let delta = u32::from_le_bytes(delta).rotate_left(rotation);
                (u32::from_le_bytes(last) ^ delta).to_le_bytes()
            }
        }
    }
}

fn unzigzag8(value: u8) -> u8 {
    (value >> 1) ^ (value & 1).wrapping_neg()
}

fn unzigzag16(value: u16) -> u16 {
    (value >> 1) ^ (value & 1).wrapping_neg()
}

/// `count` elements of `stride` bytes, a multiple of 4.
pub fn decode(stream: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, Fault> {
    let (tail, padded) = match stream.first() {
        Some(0xa0) => (stride, stride.max(32)),
        Some(0xa1) => (stride + stride / 4, (stride + stride / 4).max(24)),
        _ => return Err("it is of a version that is not known"),
    };
    let (header, mut reader, padded) = Reader::split(stream, padded)?;
    let (baseline, codes) = padded[padded.len() - tail..].split_at(stride);
    let channels: Vec<Channel> = match header {
        0xa0 => vec![Channel::Bytes; stride / 4],
        _ => codes
            .iter()
            .map(|&code| Channel::from_code(code))
            .collect::<Result<_, _>>()?,
    };
    let mut elements = Vec::with_capacity(count * stride);
    let mut last = baseline.to_vec();
    let mut deltas = vec![0; stride * MAX_BLOCK];
    let max_block = (MAX_BLOCK_BYTES / stride / GROUP * GROUP).min(MAX_BLOCK);
    let mut left = count;
    while left > 0 {
        let block = left.min(max_block);
        left -= block;
        read_block(&mut reader, header, block, &mut deltas)?;
        for element in 0..block {
            for (channel, last) in channels.iter().zip(last.as_chunks_mut::<4>().0) {
                let first = elements.len() % stride;
                let delta = std::array::from_fn(|i| deltas[(first + i) * MAX_BLOCK + element]);
                *last = channel.next(*last, delta);
                elements.extend_from_slice(last);
            }
        }
    }
    reader.finish()?;
    Ok(elements)
}

/// The differences of a block: all of the first byte, then all of the second, and so on.
fn read_block(
    reader: &mut Reader,
    header: u8,
    block: usize,
    deltas: &mut [u8],
) -> Result<(), Fault> {
    let stride = deltas.len() / MAX_BLOCK;
    let controls = match header {
        0xa0 => None,
        _ => Some(reader.take(stride / 4)?),
    };
    for (byte, deltas) in deltas.chunks_exact_mut(MAX_BLOCK).enumerate() {
        let deltas = &mut deltas[..block.next_multiple_of(GROUP)];
        let control = controls.map(|controls| controls[byte / 4] >> (byte % 4 * 2) & 3);
        match control {
            None => read_groups(reader, VERSION_0_BITS, deltas)?,
            Some(2) => deltas.fill(0),
            Some(3) => deltas[..block].copy_from_slice(reader.take(block)?),
            Some(mode) => read_groups(reader, VERSION_1_BITS[usize::from(mode)], deltas)?,
        }
    }
    Ok(())
}

/// The differences of one byte of the elements, in groups of their own number of bits.
fn read_groups(reader: &mut Reader, bits: [u32; 4], deltas: &mut [u8]) -> Result<(), Fault> {
    let groups = deltas.len() / GROUP;
    let headers = reader.take(groups.div_ceil(4))?;
    for (group, deltas) in deltas.chunks_exact_mut(GROUP).enumerate() {
        let header = headers[group / 4] >> (group % 4 * 2) & 3;
        read_group(reader, bits[usize::from(header)], deltas)?;
    }
    Ok(())
}

/// A group of differences of `bits` each; those with all bits set follow as whole bytes.
pub fn read_group(reader: &mut Reader, bits: u32, deltas: &mut [u8]) -> Result<(), Fault> {
    match bits {
        0 => deltas.fill(0),
        8 => deltas.copy_from_slice(reader.take(GROUP)?),
        _ => {
            let packed = reader.take(GROUP / 8 * bits as usize)?;
            let sentinel = (1 << bits) - 1;
            let per_byte = 8 / bits as usize;
            for (i, delta) in deltas.iter_mut().enumerate() {
                // One bit: the lowest first. More: the highest first.
                let place = match bits {
                    1 => i % per_byte,
                    _ => per_byte - 1 - i % per_byte,
                };
                let value = packed[i / per_byte] >> (place * bits as usize) & sentinel;
                *delta = match value == sentinel {
                    true => reader.byte()?,
                    false => value,
                };
            }
        }
    }
    Ok(())
}
