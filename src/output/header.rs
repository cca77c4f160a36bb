//! Puts the attributes in the header of an EXR file into the order of their names.
//!
//! The encoder keeps them in a map whose order is never the same; the same picture is to make the
//! same bytes.

use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};

/// Magic number and version.
const START: u64 = 8;

/// Sorts the header of the one-part file in `file`; the size of nothing changes.
pub fn sort_attributes(file: &mut (impl Read + Write + Seek)) -> io::Result<()> {
    file.seek(SeekFrom::Start(START))?;
    let mut attributes = Vec::new();
    let mut reader = BufReader::new(&mut *file);
    while let Some(attribute) = attribute(&mut reader)? {
        attributes.push(attribute);
    }
    drop(reader);
    // Each begins with its name and a zero.
    attributes.sort();
    file.seek(SeekFrom::Start(START))?;
    file.write_all(&attributes.concat())?;
    file.seek(SeekFrom::End(0)).map(drop)
}

/// The bytes of the next attribute: name, type, size of the value, value; `None` at the end.
fn attribute(reader: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    text(reader, &mut bytes)?;
    if bytes == [0] {
        return Ok(None);
    }
    text(reader, &mut bytes)?;
    let mut size = [0; 4];
    reader.read_exact(&mut size)?;
    bytes.extend(size);
    let size = u32::from_le_bytes(size).into();
    if reader.take(size).read_to_end(&mut bytes)? as u64 != size {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(Some(bytes))
}

/// Appends what stands before the next zero, and the zero.
fn text(reader: &mut impl Read, bytes: &mut Vec<u8>) -> io::Result<()> {
    loop {
        let mut byte = [0];
        reader.read_exact(&mut byte)?;
        bytes.extend(byte);
        if byte == [0] {
            return Ok(());
        }
    }
}
