//! Files that another file names, as people write such names.

use std::fs;
use std::path::{Path, PathBuf};

/// Finds the file that `name` means to a file in the first of `folders`; `None` where there is none.
///
/// Backslashes separate folders as slashes do, and the case of letters counts only where two
/// names differ in nothing else. Absolute names and those that lead out of the folder with `..` are
/// opened where they point, since other programs write such names. What is not at its place is
/// looked for in the other folders, and then by its last part alone: absolute names are often of
/// the author's own machine.
pub fn find(name: &str, folders: &[&Path]) -> Option<PathBuf> {
    let name = name.trim().trim_matches('"').replace('\\', "/");
    let last = name.rsplit('/').next().unwrap_or_default();
    let candidates = [name.as_str(), last];
    candidates
        .into_iter()
        .filter(|candidate| !candidate.is_empty())
        .flat_map(|candidate| folders.iter().map(move |folder| (folder, candidate)))
        .find_map(|(folder, candidate)| find_in(folder, candidate))
}

fn find_in(folder: &Path, name: &str) -> Option<PathBuf> {
    let exact = folder.join(name);
    if exact.is_file() {
        return Some(exact);
    }
    if Path::new(name).is_absolute() {
        return None;
    }
    let mut path = folder.to_owned();
    for part in name
        .split('/')
        .filter(|part| !part.is_empty() && *part != ".")
    {
        path = if part == ".." {
            path.join(part)
        } else {
            in_any_case(&path, part)?
        };
    }
    path.is_file().then_some(path)
}

/// The entry of `folder` called `name`, in this case or, failing that, the first in any other.
fn in_any_case(folder: &Path, name: &str) -> Option<PathBuf> {
    let exact = folder.join(name);
    if exact.exists() {
        return Some(exact);
    }
    let wanted = name.to_lowercase();
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let entries = fs::read_dir(here).ok()?;
    entries
        .filter_map(|entry| Some(entry.ok()?.file_name()))
        .filter(|entry| entry.to_string_lossy().to_lowercase() == wanted)
        .min()
        .map(|entry| folder.join(entry))
}
