//! What a glTF document names: bytes in the URI itself, or files by a path relative to its own.
//!
//! Such a path may lead out of the model's folder with `..`, as those of real models do; absolute
//! paths and URIs of other schemes are refused.

use std::path::{Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

use crate::import::{Problem, files};

/// Base64 with or without its padding, as both are found in files.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// The bytes that `uri` stands for in a document that lies in `folder`.
///
/// # Errors
/// Where the file cannot be read, the data are not base64, or the URI is an absolute path or of a
/// scheme other than `data`.
pub fn read(folder: &Path, uri: &str) -> Result<Vec<u8>, Problem> {
    if let Some(data) = strip_scheme(uri, "data:") {
        return decode_data(data);
    }
    Ok(files::read(&locate(folder, uri)?)?)
}

/// The file that `uri` names in a document that lies in `folder`.
///
/// # Errors
/// Where it is an absolute path, or of a scheme.
pub fn locate(folder: &Path, uri: &str) -> Result<PathBuf, Problem> {
    let decoded = percent_decode_str(uri)
        .decode_utf8()
        .map_err(|_| Problem::Invalid(format!("the file name {uri:?} is not UTF-8")))?;
    let path = local_path(folder, &decoded)?;
    // Some exporters do not encode their file names, and some write those of Windows.
    let unencoded = local_path(folder, uri)?;
    let with_slashes = local_path(folder, &decoded.replace('\\', "/"))?;
    let found = [&unencoded, &with_slashes]
        .into_iter()
        .find(|other| !path.exists() && other.exists());
    Ok(found.unwrap_or(&path).clone())
}

/// Whether `uri` holds the data itself.
pub fn holds_data(uri: &str) -> bool {
    strip_scheme(uri, "data:").is_some()
}

/// How messages call `uri`: its file name, or its kind where it holds the data itself.
pub fn label(uri: &str) -> String {
    if holds_data(uri) {
        "data URI".into()
    } else {
        percent_decode_str(uri).decode_utf8_lossy().into_owned()
    }
}

fn strip_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let (head, rest) = uri.split_at_checked(scheme.len())?;
    head.eq_ignore_ascii_case(scheme).then_some(rest)
}

/// From `[media type][;base64],text`.
fn decode_data(data: &str) -> Result<Vec<u8>, Problem> {
    let (header, text) = data
        .split_once(',')
        .ok_or_else(|| Problem::Invalid("a data URI without a comma".into()))?;
    if header.to_ascii_lowercase().ends_with(";base64") {
        return BASE64
            .decode(text)
            .map_err(|error| Problem::Invalid(format!("a data URI is not base64: {error}")));
    }
    Ok(percent_decode_str(text).collect())
}

fn local_path(folder: &Path, name: &str) -> Result<PathBuf, Problem> {
    let refuse = |what| Err(Problem::Invalid(format!("{name:?} {what}")));
    if name.is_empty() || name.contains('\0') {
        return refuse("is not a file name");
    }
    if name.starts_with(['/', '\\']) || Path::new(name).is_absolute() {
        return refuse("is an absolute path; only paths relative to the model are read");
    }
    if has_scheme(name) {
        return refuse("is not a path; only paths relative to the model are read");
    }
    Ok(folder.join(name))
}

/// Whether `name` begins as `https:` does, or with a drive letter.
fn has_scheme(name: &str) -> bool {
    name.split_once(':').is_some_and(|(scheme, _)| {
        scheme.starts_with(|c: char| c.is_ascii_alphabetic())
            && scheme
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn data(uri: &str) -> Option<Vec<u8>> {
        read(Path::new("."), uri).ok()
    }

    #[test]
    fn data_uris_come_with_and_without_padding() {
        let hello = Some(b"hello".to_vec());
        assert_eq!(data("data:application/octet-stream;base64,aGVsbG8="), hello);
        assert_eq!(data("DATA:;Base64,aGVsbG8"), hello);
        assert_eq!(data("data:,h%65llo"), hello);
        assert_eq!(data("data:;base64,a?"), None);
        assert_eq!(data("data:;base64"), None);
    }

    #[test]
    fn absolute_paths_and_schemes_are_refused() {
        for uri in [
            "/etc/x",
            "%2Fetc/x",
            "\\x",
            "https://a/b",
            "C:\\x",
            "C:x",
            "file:x",
            "",
        ] {
            let error = read(Path::new("."), uri).unwrap_err();
            assert!(matches!(error, Problem::Invalid(_)), "{uri}: {error}");
        }
        let missing = read(Path::new("."), "no such:file").unwrap_err();
        assert!(matches!(missing, Problem::Io(_)), "{missing}");
    }
}
