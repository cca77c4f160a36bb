//! Files that are there whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use super::{OutputError, OutputProblem};

/// The temporary files that are there now.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files of every [`write_whole`] that is under way, for a program that
/// ends before they do. From then on any other call of this module waits for that end.
pub fn discard_unfinished() {
    let unfinished = unfinished();
    for path in unfinished.iter() {
        // The program ends in any case.
        let _ = fs::remove_file(path);
    }
    mem::forget(unfinished);
}

/// Writes `path` through a temporary file in the same folder, which then takes its name.
///
/// On failure nothing is left behind and a file that was there is as it was. A symbolic link is
/// followed. The new file has the permissions of any newly created one.
///
/// # Errors
/// Where the folder is not there, or `write` or the system fails.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let error = |problem: io::Error| OutputError::new(path, problem);
    let target = target(path);
    let temporary = temporary(path, &target)?;
    let mut buffered = BufWriter::new(temporary.file.as_file());
    write(&mut buffered).map_err(error)?;
    buffered.flush().map_err(error)?;
    drop(buffered);
    temporary.persist(&target).map_err(error)
}

/// Whether [`write_whole`] can be expected to succeed, so that a job need not run in vain.
///
/// # Errors
/// Where `path` is a folder or write-protected, or no file can be made in its folder.
pub fn check_writable(path: &Path) -> Result<(), OutputError> {
    let target = target(path);
    if let Ok(existing) = fs::metadata(&target) {
        if existing.is_dir() {
            return Err(OutputError::new(path, OutputProblem::IsFolder));
        }
        if existing.permissions().readonly() {
            return Err(OutputError::new(path, OutputProblem::WriteProtected));
        }
    }
    temporary(path, &target).map(drop)
}

/// Where `path` leads to: renaming onto a symbolic link would replace the link.
fn target(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

fn temporary(path: &Path, target: &Path) -> Result<Temporary, OutputError> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let problem = OutputProblem::MissingFolder(folder.to_owned());
        return Err(OutputError::new(path, problem));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".halfshade-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any new file asks for; the user's mask is taken off by the system.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    Temporary::new(&builder, folder).map_err(|problem| OutputError::new(path, problem))
}

/// A temporary file; it is removed when this is dropped.
struct Temporary {
    file: NamedTempFile,
    // Below the file, so that it is dropped after it: a file that is there is known.
    known: Known,
}

impl Temporary {
    fn new(builder: &tempfile::Builder, folder: &Path) -> io::Result<Self> {
        let mut unfinished = unfinished();
        let file = builder.tempfile_in(folder)?;
        unfinished.push(file.path().to_owned());
        let known = Known(file.path().to_owned());
        Ok(Self { file, known })
    }

    fn persist(self, target: &Path) -> io::Result<()> {
        let Self { file, known } = self;
        let result = file.persist(target).map_err(|failed| failed.error);
        drop(known);
        result.map(drop)
    }
}

/// Takes the path out of [`UNFINISHED`] when it is dropped.
struct Known(PathBuf);

impl Drop for Known {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        fs::write(&path, "old").unwrap();
        let error = write_whole(&path, |file| {
            file.write_all(&[0; 100_000])?;
            Err(io::Error::other("the disk is full"))
        })
        .unwrap_err();
        assert!(error.to_string().ends_with("the disk is full"), "{error}");
        assert_eq!(names(folder.path()), ["a.png"]);
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }

    #[test]
    fn a_written_file_replaces_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        fs::write(&path, "old").unwrap();
        write_whole(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["a.png"]);
    }

    #[test]
    fn a_check_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        check_writable(&folder.path().join("a.exr")).unwrap();
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn what_cannot_be_written_is_found_out_beforehand() {
        let folder = tempfile::tempdir().unwrap();
        let missing = check_writable(&folder.path().join("no/a.png")).unwrap_err();
        assert!(matches!(missing.problem, OutputProblem::MissingFolder(_)));
        let is_folder = check_writable(folder.path()).unwrap_err();
        assert!(matches!(is_folder.problem, OutputProblem::IsFolder));
        let protected = folder.path().join("p.png");
        fs::write(&protected, "").unwrap();
        let mut permissions = fs::metadata(&protected).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&protected, permissions).unwrap();
        let error = check_writable(&protected).unwrap_err();
        assert!(matches!(error.problem, OutputProblem::WriteProtected));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_are_those_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [plain, real, link] = ["plain", "real", "link"].map(|name| folder.path().join(name));
        fs::write(&plain, "").unwrap();
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_whole(&link, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&real), mode(&plain));
    }
}
