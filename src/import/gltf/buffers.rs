//! Buffers: the bytes that a document's accessors and images lie in.
//!
//! Compressed views are decoded when they are first asked for, since most may belong to meshes that
//! nothing shows. Where one is broken and the file has its data in plain too, those are used.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::path::Path;

use serde::Deserialize;

use super::document::{Buffer, BufferView, Document};
use super::extensions::MESHOPT;
use super::meshopt::CompressedView;
use super::uri;
use crate::import::budget::Budget;
use crate::import::{ImportError, Problem};

/// The buffers of a document, in its order.
#[derive(Debug)]
pub struct Buffers<'a> {
    data: Vec<Data<'a>>,
    /// By buffer view: its bytes, where it was compressed.
    decoded: Vec<OnceCell<Result<Vec<u8>, String>>>,
    /// What those may take.
    budget: Budget,
}

#[derive(Debug)]
enum Data<'a> {
    Bytes(Cow<'a, [u8]>),
    /// Room for what compressed views hold; there are no bytes for it.
    Room,
}

/// The extension's object in a buffer.
#[derive(Default, Deserialize)]
#[serde(default)]
struct CompressedBuffer {
    fallback: bool,
}

impl<'a> Buffers<'a> {
    /// Reads the buffers of the document at `path`; `binary` is what its `.glb` holds.
    ///
    /// # Errors
    /// Where one cannot be read, or has fewer bytes than the document claims.
    pub fn read(
        path: &Path,
        document: &Document,
        binary: Option<&'a [u8]>,
    ) -> Result<Self, ImportError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut data = Vec::with_capacity(document.buffers.len());
        for (index, buffer) in document.buffers.iter().enumerate() {
            let binary = if index == 0 { binary } else { None };
            let is_room = is_room(document, index, buffer);
            let read =
                read_buffer(folder, buffer, binary, is_room).map_err(|problem| ImportError {
                    path: path.to_owned(),
                    place: Some(buffer_place(index, buffer)),
                    problem,
                })?;
            data.push(read);
        }
        let mut buffers = Self {
            data,
            decoded: Vec::new(),
            budget: Budget::for_geometry(0),
        };
        buffers.budget = Budget::for_geometry(buffers.len());
        let views = document.buffer_views.len();
        buffers.decoded.resize_with(views, OnceCell::new);
        Ok(buffers)
    }

    /// Bytes of all buffers.
    pub fn len(&self) -> u64 {
        let len = |data: &Data| match data {
            Data::Bytes(bytes) => bytes.len() as u64,
            Data::Room => 0,
        };
        self.data.iter().map(len).sum()
    }

    /// The bytes of buffer view `index`.
    ///
    /// # Errors
    /// Where it does not lie in its buffer, or cannot be decoded.
    pub fn view(&self, document: &Document, index: usize) -> Result<&[u8], Problem> {
        let problem = |what: String| Problem::Invalid(format!("bufferView {index}: {what}"));
        let view = document.buffer_views.get(index).ok_or_else(|| {
            let count = document.buffer_views.len();
            problem(format!("there are only {count} buffer views"))
        })?;
        let plain = self.range(view.buffer, view.byte_offset, view.byte_length);
        let Some(name) = MESHOPT.iter().find(|name| view.extensions.has(name)) else {
            return plain.map_err(problem);
        };
        let decode = || self.decode(name, view);
        let decoded = self.decoded[index].get_or_init(decode);
        match (decoded, plain) {
            (Ok(bytes), _) => Ok(bytes),
            (Err(_), Ok(plain)) => Ok(plain),
            (Err(what), Err(_)) => Err(problem(format!("{name}: {what}"))),
        }
    }

    /// Adds a buffer view of a buffer of its own to the document; its index.
    #[cfg(feature = "draco")]
    pub fn add_view(&mut self, document: &mut Document, bytes: Vec<u8>) -> usize {
        document.buffer_views.push(BufferView {
            buffer: Some(self.data.len()),
            byte_length: bytes.len() as u64,
            ..BufferView::default()
        });
        self.data.push(Data::Bytes(Cow::Owned(bytes)));
        self.decoded.push(OnceCell::new());
        document.buffer_views.len() - 1
    }

    /// What the compressed data of `view` hold.
    fn decode(&self, name: &str, view: &BufferView) -> Result<Vec<u8>, String> {
        let compressed = view.extensions.read::<CompressedView>(name)?;
        let compressed = compressed.ok_or("it is not there")?;
        let stream = self.range(
            Some(compressed.buffer),
            compressed.byte_offset,
            compressed.byte_length,
        )?;
        let length = compressed.decoded_length(view.byte_length);
        let length = length.ok_or("its mode, filter, stride, count and length do not fit")?;
        let taken = self.budget.take(length as u64);
        taken.map_err(|problem| problem.to_string())?;
        Ok(compressed.decode(stream)?)
    }

    /// `length` bytes of a buffer, from `offset`.
    fn range(&self, buffer: Option<usize>, offset: u64, length: u64) -> Result<&[u8], String> {
        let number = buffer.ok_or("names no buffer")?;
        let bytes = match self.data.get(number) {
            Some(Data::Bytes(bytes)) => bytes,
            Some(Data::Room) => return Err(format!("lies in buffer {number}, which has no data")),
            None => {
                let count = self.data.len();
                return Err(format!(
                    "lies in buffer {number}, but there are only {count}"
                ));
            }
        };
        let start = usize::try_from(offset).ok();
        let end = offset.checked_add(length);
        let end = end.and_then(|end| usize::try_from(end).ok());
        let range = start
            .zip(end)
            .and_then(|(start, end)| bytes.get(start..end));
        range.ok_or_else(|| format!("ends after the {} bytes of buffer {number}", bytes.len()))
    }
}

/// Whether a buffer is nothing but room for what compressed views hold.
fn is_room(document: &Document, index: usize, buffer: &Buffer) -> bool {
    let is_fallback = |name: &&str| {
        let read = buffer.extensions.read::<CompressedBuffer>(name);
        read.is_ok_and(|read| read.unwrap_or_default().fallback)
    };
    let is_compressed = |view: &BufferView| {
        view.buffer == Some(index) && MESHOPT.iter().any(|name| view.extensions.has(name))
    };
    MESHOPT.iter().any(is_fallback)
        || (buffer.uri.is_none() && document.buffer_views.iter().any(is_compressed))
}

fn read_buffer<'a>(
    folder: &Path,
    buffer: &Buffer,
    binary: Option<&'a [u8]>,
    is_room: bool,
) -> Result<Data<'a>, Problem> {
    let mut bytes = match (&buffer.uri, binary) {
        (None, Some(binary)) => Cow::Borrowed(binary),
        _ if is_room => return Ok(Data::Room),
        (Some(uri), _) => Cow::Owned(uri::read(folder, uri)?),
        (None, None) => return Err(Problem::Invalid("has no data".into())),
    };
    let length = usize::try_from(buffer.byte_length).unwrap_or(usize::MAX);
    if bytes.len() < length {
        return Err(Problem::Invalid(format!(
            "cut short: it should have {length} bytes and has {}",
            bytes.len()
        )));
    }
    // The binary part of a .glb is padded; a view must not reach into that.
    match &mut bytes {
        Cow::Borrowed(bytes) => *bytes = &bytes[..length],
        Cow::Owned(bytes) => bytes.truncate(length),
    }
    Ok(Data::Bytes(bytes))
}

fn buffer_place(index: usize, buffer: &Buffer) -> String {
    match &buffer.uri {
        Some(uri) => format!("buffer {index} ({})", uri::label(uri)),
        None => format!("buffer {index}"),
    }
}
