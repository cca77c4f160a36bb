//! Whether a picture that was kept is still that of its scene.

use std::fmt::{self, Debug, Write};

use sha2::{Digest, Sha256};

use crate::scene::{Scene, Settings};

/// Writes text into a hash.
struct Hasher(Sha256);

impl Write for Hasher {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

/// A digest of all that a picture depends on: the scene as it was imported, the settings, and the
/// version of this program. Numbers are told apart to the last bit.
pub fn digest(scene: &Scene, settings: &Settings) -> String {
    of_debug(&(env!("CARGO_PKG_VERSION"), scene, settings))
}

/// A digest of what `Debug` says of `value`: every field is in it, now and later, and shortest
/// decimals are as exact as bits.
pub(super) fn of_debug(value: &impl Debug) -> String {
    let mut hasher = Hasher(Sha256::new());
    // Neither our writer nor a derived `Debug` fails.
    let _ = write!(hasher, "{value:?}");
    let bytes = hasher.0.finalize();
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;

    #[test]
    fn the_last_bit_counts() {
        let (mut scene, settings) = (Scene::default(), Settings::default());
        let before = digest(&scene, &settings);
        assert_eq!(before, digest(&scene, &settings));
        scene.background.radiance = Rgb::new(f32::from_bits(1), 0.0, 0.0);
        assert_ne!(before, digest(&scene, &settings));
    }
}
