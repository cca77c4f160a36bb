//! Denoising with Intel's Open Image Denoise (Áfra 2019), where its library is there at run time.
//!
//! Nothing of it is needed for the build. The picture is filtered as linear radiance of any size, with albedo and
//! normal of what is seen as guides: what they tell apart stays sharp.

mod ffi;

use std::env;
use std::ffi::{CStr, OsString};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::color::Rgb;
use crate::math::UVec2;
use ffi::{Library, Plane};

/// The variable of the environment that names the library's file, or the folder that it is in.
pub const LIBRARY_VARIABLE: &str = "HALFSHADE_OIDN";

/// The names that the library has on this system, the best first.
const NAMES: &[&str] = if cfg!(windows) {
    &["OpenImageDenoise.dll"]
} else if cfg!(target_os = "macos") {
    &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"]
} else {
    &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"]
};

/// Why a picture could not be denoised.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DenoiseError {
    /// The library is not there.
    #[error(
        "Open Image Denoise was not found; {LIBRARY_VARIABLE} may name its library or the folder that it is in. \
         Looked for:{}", list(.0)
    )]
    NotFound(Vec<(PathBuf, String)>),
    /// It does not do what it is asked for.
    #[error("Open Image Denoise: {0}")]
    Failed(String),
}

fn list(tried: &[(PathBuf, String)]) -> String {
    let line = |(path, why): &(PathBuf, String)| format!("\n  {}: {why}", path.display());
    tried.iter().map(line).collect()
}

/// Open Image Denoise, ready to work.
pub struct Denoiser {
    library: Library,
}

/// What guides the denoiser: mean over each pixel of what is seen, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Guides<'a> {
    /// Reflectance, `[0, 1]`; black where there is nothing.
    pub albedo: &'a [[f32; 3]],
    /// Shading normal in world axes; zero where there is nothing.
    pub normal: &'a [[f32; 3]],
}

/// A denoised picture.
#[derive(Clone, Debug)]
pub struct Denoised {
    /// Linear radiance, row by row.
    pub pixels: Vec<Rgb>,
    /// The version of the library that made it, like `2.3.1`.
    pub version: String,
}

impl Denoiser {
    /// Looks for the library: where `place`, a file or a folder, says, or else beside the program, in the folder
    /// `lib` beside the program's, and where the system keeps its libraries.
    ///
    /// # Errors
    /// Where it is not found, with all the places that were looked at.
    pub fn find(place: Option<&Path>) -> Result<Self, DenoiseError> {
        let program = env::current_exe().ok();
        let folder = program.as_deref().and_then(Path::parent);
        let mut tried = Vec::new();
        for path in candidates(place, folder) {
            match Library::open(path.as_os_str()) {
                Ok(library) => return Ok(Self { library }),
                Err(why) => tried.push((path, why)),
            }
        }
        Err(DenoiseError::NotFound(tried))
    }

    /// Denoises `pixels`, a picture of `size`, on as many threads as the current pool has.
    ///
    /// # Errors
    /// Where the library fails.
    pub fn denoise(
        &self,
        size: UVec2,
        pixels: &[Rgb],
        guides: Guides,
    ) -> Result<Denoised, DenoiseError> {
        let color: Vec<[f32; 3]> = pixels.iter().map(|pixel| pixel.channels()).collect();
        let plane = |name: &'static CStr, pixels| Plane { name, pixels };
        let planes = [
            plane(c"color", &color),
            plane(c"albedo", guides.albedo),
            plane(c"normal", guides.normal),
        ];
        let threads = rayon::current_num_threads();
        let filtered = self.library.filter(size, &planes, threads);
        let (pixels, version) = filtered.map_err(DenoiseError::Failed)?;
        Ok(Denoised {
            pixels: pixels.into_iter().map(Rgb::from).collect(),
            version: version_text(version),
        })
    }
}

/// The files that may be the library, in the order in which they are tried.
fn candidates(place: Option<&Path>, program_folder: Option<&Path>) -> Vec<PathBuf> {
    let in_folder = |folder: &Path| NAMES.iter().map(|name| folder.join(name)).collect();
    match place {
        Some(folder) if folder.is_dir() => in_folder(folder),
        Some(file) => vec![file.to_owned()],
        None => {
            let mut paths: Vec<PathBuf> = Vec::new();
            if let Some(folder) = program_folder {
                paths.extend::<Vec<_>>(in_folder(folder));
                paths.extend::<Vec<_>>(in_folder(&folder.join("../lib")));
            }
            // Names without a folder: the system looks for them where it does for any library.
            paths.extend(NAMES.iter().map(|name| PathBuf::from(OsString::from(name))));
            paths
        }
    }
}

/// 20501 is 2.5.1.
fn version_text(version: i32) -> String {
    let [major, minor, patch] = [version / 10_000, version / 100 % 100, version % 100];
    format!("{major}.{minor}.{patch}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_named_is_the_only_place() {
        let file = Path::new("/nowhere/oidn.so");
        assert_eq!(candidates(Some(file), Some(Path::new("/bin"))), [file]);
        let folder = env::temp_dir();
        let found = candidates(Some(&folder), None);
        assert!(found.len() == NAMES.len() && found.iter().all(|path| path.starts_with(&folder)));
    }

    #[test]
    fn the_system_is_asked_last() {
        let found = candidates(None, Some(Path::new("/opt/halfshade/bin")));
        assert_eq!(found[0], Path::new("/opt/halfshade/bin").join(NAMES[0]));
        assert_eq!(
            found.last().map(PathBuf::as_path),
            NAMES.last().map(Path::new)
        );
        assert_eq!(found.len(), 3 * NAMES.len());
    }

    #[test]
    fn an_error_names_every_place_and_what_was_wrong_there() {
        let place = Path::new("/nowhere/libOpenImageDenoise.so");
        let error = Denoiser::find(Some(place))
            .err()
            .map(|error| error.to_string());
        let text = error.unwrap_or_default();
        assert!(text.contains("/nowhere/libOpenImageDenoise.so: "), "{text}");
        assert!(text.contains(LIBRARY_VARIABLE), "{text}");
    }

    #[test]
    fn versions_have_three_parts() {
        assert_eq!(version_text(20_501), "2.5.1");
        assert_eq!(version_text(21_200), "2.12.0");
    }

    /// With the library there, noise on two plain halves becomes less, and the edge between them stays.
    #[test]
    fn noise_goes_and_edges_stay() {
        let place = env::var_os(LIBRARY_VARIABLE).map(PathBuf::from);
        let denoiser = match Denoiser::find(place.as_deref()) {
            Ok(denoiser) => denoiser,
            Err(error) => {
                assert!(place.is_none(), "{error}");
                return;
            }
        };
        let size = UVec2::new(64, 48);
        let mut state = 1_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        let truth = |i: u32| if i % size.x < 32 { 20.0 } else { 0.5 };
        let count = size.x * size.y;
        let pixels: Vec<Rgb> = (0..count)
            .map(|i| Rgb::splat(truth(i) * 2.0 * noise()))
            .collect();
        let albedo: Vec<[f32; 3]> = (0..count)
            .map(|i| [if i % size.x < 32 { 0.8 } else { 0.1 }; 3])
            .collect();
        let normal = vec![[0.0, 0.0, 1.0]; count as usize];
        let guides = Guides {
            albedo: &albedo,
            normal: &normal,
        };
        let error = |pixels: &[Rgb]| -> f32 {
            let errors = (0..)
                .zip(pixels)
                .map(|(i, p)| (p.g / truth(i) - 1.0).powi(2));
            errors.sum::<f32>() / count as f32
        };
        let denoised = denoiser.denoise(size, &pixels, guides);
        let denoised = denoised.map_or_else(|error| panic!("{error}"), |d| d.pixels);
        let (before, after) = (error(&pixels), error(&denoised));
        assert!(after < 0.05 * before, "{before} before, {after} after");
    }
}
