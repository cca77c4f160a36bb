//! The two wrappings of a glTF document: plain JSON, and `.glb` with JSON and bytes in one file.

use crate::import::Problem;

/// `glTF`, little-endian.
const MAGIC: &[u8] = b"glTF";
/// Magic, version and length.
const HEADER_BYTES: usize = 12;
/// Length and type.
const CHUNK_HEADER_BYTES: usize = 8;
const JSON_CHUNK: &[u8] = b"JSON";
const BINARY_CHUNK: &[u8] = b"BIN\0";
/// What some editors put before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The parts of a file.
#[derive(Debug, PartialEq, Eq)]
pub struct Container<'a> {
    /// The document.
    pub json: &'a [u8],
    /// The bytes of a `.glb`'s own buffer; `None` where it has none.
    pub binary: Option<&'a [u8]>,
}

/// Takes a file apart. What it is is told by its first bytes, not by its name.
///
/// # Errors
/// Where a `.glb` is cut short, of another version, or does not begin with JSON.
pub fn split(file: &[u8]) -> Result<Container<'_>, Problem> {
    if file.starts_with(MAGIC) {
        return split_binary(file);
    }
    Ok(Container {
        json: file.strip_prefix(BYTE_ORDER_MARK).unwrap_or(file),
        binary: None,
    })
}

fn split_binary(file: &[u8]) -> Result<Container<'_>, Problem> {
    let (Some(version), Some(length)) = (number(file, 4), number(file, 8)) else {
        return Err(cut_short(HEADER_BYTES as u64, file));
    };
    if version != 2 {
        return Err(Problem::Unsupported(format!("glTF version {version}")));
    }
    if u64::from(length) > file.len() as u64 {
        return Err(cut_short(u64::from(length), file));
    }
    let body = file
        .get(HEADER_BYTES..length as usize)
        .ok_or_else(|| Problem::Invalid("the header's length is less than the header".into()))?;
    let (first, rest) = chunk(body)?;
    if first.kind != JSON_CHUNK {
        return Err(Problem::Invalid("the first chunk is not JSON".into()));
    }
    let mut binary = None;
    if !rest.is_empty() {
        let (second, _) = chunk(rest)?;
        // Chunks of other kinds are for extensions, and to be passed over.
        binary = (second.kind == BINARY_CHUNK).then_some(second.content);
    }
    Ok(Container {
        json: first.content,
        binary,
    })
}

struct Chunk<'a> {
    kind: &'a [u8],
    content: &'a [u8],
}

/// The first chunk, and what comes after it.
fn chunk(bytes: &[u8]) -> Result<(Chunk<'_>, &[u8]), Problem> {
    let problem = || Problem::Invalid("a chunk is cut short".into());
    let length = number(bytes, 0).ok_or_else(problem)? as usize;
    let (header, rest) = bytes
        .split_at_checked(CHUNK_HEADER_BYTES)
        .ok_or_else(problem)?;
    let (content, rest) = rest.split_at_checked(length).ok_or_else(problem)?;
    let kind = &header[4..];
    Ok((Chunk { kind, content }, rest))
}

fn number(bytes: &[u8], offset: usize) -> Option<u32> {
    let four = bytes.get(offset..offset + 4)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

fn cut_short(expected: u64, file: &[u8]) -> Problem {
    Problem::Invalid(format!(
        "cut short: it should have {expected} bytes and has {}",
        file.len()
    ))
}
