//! The picture is the same bit for bit, whatever is left out.

use std::path::{Path, PathBuf};

use halfshade::integrate::ViewKind;
use halfshade::scene::{Keep, Omission};

use super::{Ask, picture};

/// Everything that can be rendered, alone and beside another.
const ASKS: &[Ask] = &[
    Ask {
        integrator: "whitted",
        layers: &[],
    },
    Ask {
        integrator: "path",
        layers: &[],
    },
    Ask {
        integrator: "normal",
        layers: &[],
    },
    Ask {
        integrator: "depth",
        layers: &[],
    },
    Ask {
        integrator: "albedo",
        layers: &[],
    },
    Ask {
        integrator: "depth",
        layers: &[ViewKind::Normal],
    },
    Ask {
        integrator: "normal",
        layers: &[ViewKind::Albedo, ViewKind::Depth, ViewKind::Uv],
    },
];

/// Scenes of this project; its two largest take minutes.
const SCENES: &[&str] = &["cornell", "glass", "house", "house-seed", "penumbra"];

/// Models that nobody on this project wrote: with textures in every slot, opacity, vertex colours,
/// several sets of texture coordinates, skins, tangents, and none of all this.
const MODELS: &[&str] = &[
    "gltf/AlphaBlendModeTest/glTF-Binary/AlphaBlendModeTest.glb",
    "gltf/Avocado/glTF/Avocado.gltf",
    "gltf/BoxVertexColors/glTF/BoxVertexColors.gltf",
    "gltf/EmissiveStrengthTest/glTF-Binary/EmissiveStrengthTest.glb",
    "gltf/FlightHelmet-512/glTF/FlightHelmet.gltf",
    "gltf/GlassVaseFlowers/glTF-Binary/GlassVaseFlowers.glb",
    "gltf/LightsPunctualLamp/glTF/LightsPunctualLamp.gltf",
    "gltf/MixedLightingExample-bevy/glTF/MixedLightingExample.gltf",
    "gltf/MultiUVTest/glTF-Binary/MultiUVTest.glb",
    "gltf/NormalTangentTest/glTF-Binary/NormalTangentTest.glb",
    "gltf/SimpleSkin/glTF/SimpleSkin.gltf",
    "gltf/SpecularTest/glTF-Binary/SpecularTest.glb",
    "gltf/TextureSettingsTest/glTF-Binary/TextureSettingsTest.glb",
    "gltf/UnlitTest/glTF-Binary/UnlitTest.glb",
    "gltf/VertexColorTest/glTF-Binary/VertexColorTest.glb",
    "obj/gopher/gopher.obj",
    "obj/obj2gltf/box-complex-material/box-complex-material.obj",
    "obj/obj2gltf/box-transparent/box-transparent.obj",
    "obj/spot/spot_triangulated.obj",
];

#[test]
fn the_scenes_of_the_project_stay_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for name in SCENES {
        assert_same(&folder.join(format!("{name}.toml")));
    }
}

#[test]
fn models_of_others_stay_the_same() {
    let models = std::env::var("HALFSHADE_MODELS").map_or_else(
        |_| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/models"),
        PathBuf::from,
    );
    if !models.is_dir() {
        println!("skipped: there is no {}", models.display());
        return;
    }
    for name in MODELS {
        assert_same(&models.join(name));
    }
}

/// Whatever is asked for is the same with everything kept, with nothing kept, and with one kind
/// of thing kept that depends on the others.
pub fn assert_same(path: &Path) {
    for ask in ASKS {
        let (all, left_out) = picture(path, ask, Keep::EVERYTHING);
        let what = format!("{}, {}", path.display(), ask.integrator);
        assert_eq!(left_out, [], "{what}");
        assert!(picture(path, ask, Keep::NOTHING).0 == all, "{what}");
        let images = Keep::only(Omission::Images);
        assert!(picture(path, ask, images).0 == all, "{what}, images kept");
    }
}
