//! Buffers: the bytes that a document's accessors and images lie in.

use std::borrow::Cow;
use std::path::Path;

use super::document::{Buffer, Document};
use super::extensions::MESHOPT;
use super::uri;
use crate::import::{ImportError, Problem};

/// The buffers of a document, in its order.
#[derive(Debug)]
pub struct Buffers<'a> {
    data: Vec<Data<'a>>,
}

#[derive(Debug)]
enum Data<'a> {
    Bytes(Cow<'a, [u8]>),
    /// Room for what a meshopt decoder would write; the file has no bytes for it.
    MeshoptOutput,
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
            let read = read_buffer(folder, buffer, binary).map_err(|problem| ImportError {
                path: path.to_owned(),
                place: Some(buffer_place(index, buffer)),
                problem,
            })?;
            data.push(read);
        }
        Ok(Self { data })
    }

    /// Bytes of all buffers.
    pub fn len(&self) -> u64 {
        let len = |data: &Data| match data {
            Data::Bytes(bytes) => bytes.len() as u64,
            Data::MeshoptOutput => 0,
        };
        self.data.iter().map(len).sum()
    }

    /// The bytes of buffer view `index`.
    ///
    /// # Errors
    /// Where it does not lie in its buffer, or its bytes are compressed in a way that we lack.
    pub fn view(&self, document: &Document, index: usize) -> Result<&[u8], Problem> {
        let problem = |what: String| Problem::Invalid(format!("bufferView {index}: {what}"));
        let view = document.buffer_views.get(index).ok_or_else(|| {
            let count = document.buffer_views.len();
            problem(format!("there are only {count} buffer views"))
        })?;
        let number = view
            .buffer
            .ok_or_else(|| problem("names no buffer".into()))?;
        let buffer = match self.data.get(number) {
            Some(Data::Bytes(bytes)) => bytes,
            Some(Data::MeshoptOutput) => return Err(unsupported_meshopt(document, index)),
            None => {
                let count = self.data.len();
                let what = format!("lies in buffer {number}, but there are only {count}");
                return Err(problem(what));
            }
        };
        let start = usize::try_from(view.byte_offset).ok();
        let end = view.byte_offset.checked_add(view.byte_length);
        let end = end.and_then(|end| usize::try_from(end).ok());
        let range = start
            .zip(end)
            .and_then(|(start, end)| buffer.get(start..end));
        range.ok_or_else(|| {
            problem(format!(
                "ends after the {} bytes of buffer {number}",
                buffer.len()
            ))
        })
    }
}

fn unsupported_meshopt(document: &Document, view: usize) -> Problem {
    let extensions = &document.buffer_views[view].extensions;
    let name = MESHOPT.iter().find(|name| extensions.has(name));
    Problem::Unsupported((*name.unwrap_or(&MESHOPT[0])).into())
}

fn read_buffer<'a>(
    folder: &Path,
    buffer: &Buffer,
    binary: Option<&'a [u8]>,
) -> Result<Data<'a>, Problem> {
    let mut bytes = match (&buffer.uri, binary) {
        (Some(uri), _) => Cow::Owned(uri::read(folder, uri)?),
        (None, Some(binary)) => Cow::Borrowed(binary),
        (None, None) if MESHOPT.iter().any(|name| buffer.extensions.has(name)) => {
            return Ok(Data::MeshoptOutput);
        }
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
