//! Bytes from front to back.

use super::Fault;

/// What is left of a stream.
pub struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Splits `stream` into its header byte, what is read, and a tail of `tail` bytes.
    pub fn split(stream: &'a [u8], tail: usize) -> Result<(u8, Self, &'a [u8]), Fault> {
        let (&header, rest) = stream.split_first().ok_or("it is empty")?;
        let middle = rest.len().checked_sub(tail).ok_or("it has no tail")?;
        let (rest, tail) = rest.split_at(middle);
        Ok((header, Self { rest }, tail))
    }

    /// The next `count` bytes.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let (taken, rest) = self
            .rest
            .split_at_checked(count)
            .ok_or("it ends too early")?;
        self.rest = rest;
        Ok(taken)
    }

    /// The next byte.
    pub fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.take(1)?[0])
    }

    /// An integer of 7 bits a byte, the lowest first (unsigned LEB128).
    pub fn variable_integer(&mut self) -> Result<u32, Fault> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err("an integer of more than five bytes")
    }

    /// Makes sure that nothing is left.
    pub fn finish(self) -> Result<(), Fault> {
        if self.rest.is_empty() {
            Ok(())
        } else {
            Err("it goes on after its last element")
        }
    }
}
