//! The layers of an EXR file, from a film.

use halfshade::color::Rgb;
use halfshade::film::Film;
use halfshade::integrate::{Aov, LightGroups, LightPart, ViewKind};
use halfshade::material::Material;
use halfshade::math::Vec3;
use halfshade::output::Cryptomatte;
use halfshade::output::denoise::{Denoiser, Guides};
use halfshade::output::exr::{Layer, Values};
use halfshade::scene::{Instance, IntegratorKind, Scene, Settings};

use super::Failure;
use super::options::OutputOptions;

/// What the denoiser reads beside the picture.
pub const GUIDES: [ViewKind; 2] = [ViewKind::Albedo, ViewKind::Normal];

/// Most groups of lights that have layers of their own.
const MOST_GROUPS: usize = 64;

/// What stands beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerKind {
    /// Diffuse reflectance or base colour of what is seen.
    Albedo,
    /// Its shading normal, in world axes.
    Normal,
    /// Its distance from the camera, metres.
    Depth,
    /// Its place in the world, metres.
    Position,
    /// Its first texture coordinates.
    Uv,
    /// Which objects are seen, by name (Cryptomatte).
    Object,
    /// Which materials are seen, by name (Cryptomatte).
    Material,
    /// Light that comes straight from where it was given off.
    Emission,
    /// Light that was scattered once.
    Direct,
    /// Light that was scattered more than once.
    Indirect,
    /// The light of each group of lights, of the background and of surfaces that emit: a layer each.
    Lights,
    /// Variance of each pixel's mean.
    Variance,
    /// Number of each pixel's samples.
    Samples,
    /// Each pixel's part of the estimated error.
    Error,
    /// The picture from one half of each pixel's samples.
    HalfA,
    /// The picture from the other half.
    HalfB,
}

impl LayerKind {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::Position,
        Self::Uv,
        Self::Object,
        Self::Material,
        Self::Emission,
        Self::Direct,
        Self::Indirect,
        Self::Lights,
        Self::Variance,
        Self::Samples,
        Self::Error,
        Self::HalfA,
        Self::HalfB,
    ];

    /// As on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Position => "position",
            Self::Uv => "uv",
            Self::Object => "object",
            Self::Material => "material",
            Self::Emission => "emission",
            Self::Direct => "direct",
            Self::Indirect => "indirect",
            Self::Lights => "lights",
            Self::Variance => "variance",
            Self::Samples => "samples",
            Self::Error => "error",
            Self::HalfA => "half_a",
            Self::HalfB => "half_b",
        }
    }

    /// What the renderer has to keep for it; `None` where the film has it anyway, and for [`Self::Lights`], which
    /// takes as much as there are groups.
    pub fn aov(self) -> Option<Aov> {
        Some(match self {
            Self::Albedo => Aov::View(ViewKind::Albedo),
            Self::Normal => Aov::View(ViewKind::Normal),
            Self::Depth => Aov::View(ViewKind::Depth),
            Self::Position => Aov::View(ViewKind::Position),
            Self::Uv => Aov::View(ViewKind::Uv),
            Self::Object | Self::Material => Aov::Objects,
            Self::Emission => Aov::Light(LightPart::Emission),
            Self::Direct => Aov::Light(LightPart::Direct),
            Self::Indirect => Aov::Light(LightPart::Indirect),
            Self::Variance | Self::Samples | Self::Error | Self::HalfA | Self::HalfB => {
                return None;
            }
            Self::Lights => return None,
        })
    }

    /// About how many layers of three channels it makes in a file.
    pub fn width(self) -> usize {
        match self {
            Self::Object | Self::Material | Self::Lights => 4,
            _ => 1,
        }
    }
}

/// What the renderer keeps for the files.
pub struct Kept {
    /// Each of it once.
    pub aovs: Vec<Aov>,
    groups: LightGroups,
}

impl Kept {
    /// All that layers, an opacity and the denoiser take.
    pub fn of(output: &OutputOptions, settings: &Settings, scene: &Scene) -> Result<Self, Failure> {
        let kinds = &output.layers;
        let mut wanted: Vec<Aov> = kinds.iter().filter_map(|kind| kind.aov()).collect();
        let mut groups = LightGroups::default();
        if kinds.contains(&LayerKind::Lights) {
            groups = LightGroups::of(scene);
            let count = groups.names().len();
            if count > MOST_GROUPS {
                return Err(Failure::job(format_args!(
                    "--layers lights would make {count} layers, more than {MOST_GROUPS}: lights of one \
                     name share a layer"
                )));
            }
            let all = (0..count as u32).map(|group| Aov::Light(LightPart::Group(group)));
            wanted.extend(all);
        }
        let is_light = |aov: &Aov| matches!(aov, Aov::Light(_));
        let integrator = settings.integrator;
        let follows_light = matches!(integrator, IntegratorKind::Whitted | IntegratorKind::Path);
        if wanted.iter().any(is_light) && !follows_light {
            return Err(Failure::job(format_args!(
                "--layers emission, direct, indirect and lights are parts of light, which \
                 the integrator \"{}\" does not follow",
                settings.integrator.name()
            )));
        }
        if settings.transparent {
            wanted.push(Aov::Coverage);
        }
        if output.denoise {
            wanted.extend(GUIDES.map(Aov::View));
        }
        let mut aovs = Vec::new();
        for aov in wanted {
            if !aovs.contains(&aov) {
                aovs.push(aov);
            }
        }
        Ok(Self { aovs, groups })
    }

    /// What `film` holds of `aov`; nothing where it was not asked for.
    fn layer<'a>(&self, film: &'a Film, aov: Aov) -> Option<&'a [[f32; 3]]> {
        let at = self.aovs.iter().position(|&other| other == aov)?;
        Some(film.layers[at].as_slice())
    }
}

/// The values of all layers of a film; layers of a file borrow them.
pub struct LayerValues {
    picture: Vec<Rgb>,
    alpha: Option<Vec<f32>>,
    others: Vec<(String, Owned)>,
    mattes: Vec<Cryptomatte>,
}

enum Owned {
    Colors(Vec<Rgb>),
    Vectors(Vec<Vec3>),
    Numbers(&'static str, Vec<f32>),
}

impl LayerValues {
    /// Bytes of one pixel of the picture and of each of `kinds`, about at most: here, and once more as
    /// channels of a file that is written.
    pub fn pixel_bytes(kinds: &[LayerKind]) -> u64 {
        let layers: usize = kinds.iter().map(|kind| kind.width()).sum();
        2 * (1 + layers as u64) * size_of::<Rgb>() as u64
    }

    /// The picture of `film` and `kinds`; `film` holds what was `kept` of `scene`.
    pub fn of_film(film: &Film, kept: &Kept, kinds: &[LayerKind], scene: &Scene) -> Self {
        let of = |aov: Aov| kept.layer(film, aov);
        let colors = |layer: &[[f32; 3]]| Owned::Colors(layer.iter().map(|&c| c.into()).collect());
        let vectors = |layer: &[[f32; 3]]| {
            let vectors = layer.iter().map(|&v| Vec3::from(v));
            Owned::Vectors(vectors.collect())
        };
        let numbers = |layer: &[[f32; 3]], i: usize| layer.iter().map(|v| v[i]).collect();
        let mut others: Vec<(String, Owned)> = Vec::new();
        let mut mattes = Vec::new();
        for &kind in kinds {
            let layer = kind.aov().and_then(of).unwrap_or_default();
            let mut add = |values| others.push((kind.name().to_owned(), values));
            match kind {
                LayerKind::Albedo
                | LayerKind::Emission
                | LayerKind::Direct
                | LayerKind::Indirect => add(colors(layer)),
                LayerKind::Normal | LayerKind::Position => add(vectors(layer)),
                LayerKind::Depth => add(Owned::Numbers("Z", numbers(layer, 0))),
                LayerKind::Uv => {
                    add(Owned::Numbers("U", numbers(layer, 0)));
                    add(Owned::Numbers("V", numbers(layer, 1)));
                }
                LayerKind::Object => mattes.push(objects(film, scene)),
                LayerKind::Material => mattes.push(materials(film, scene)),
                LayerKind::Lights => {
                    for (group, name) in (0..).zip(kept.groups.names()) {
                        let layer = of(Aov::Light(LightPart::Group(group))).unwrap_or_default();
                        others.push((format!("light_{name}"), colors(layer)));
                    }
                }
                LayerKind::Variance => add(Owned::Colors(film.variances())),
                LayerKind::Samples => {
                    let counts = film.pixels.iter().map(|p| p.count() as f32);
                    add(Owned::Numbers("Y", counts.collect()));
                }
                LayerKind::Error => add(Owned::Numbers("Y", film.errors())),
                LayerKind::HalfA => add(Owned::Colors(film.half(0))),
                LayerKind::HalfB => add(Owned::Colors(film.half(1))),
            }
        }
        Self {
            picture: film.means(),
            alpha: of(Aov::Coverage).map(|layer| numbers(layer, 0)),
            others,
            mattes,
        }
    }

    /// Takes the noise out of the picture of `film`; the version of the library that did.
    pub fn denoise(
        &mut self,
        denoiser: &Denoiser,
        film: &Film,
        kept: &Kept,
    ) -> Result<String, Failure> {
        let [albedo, normal] = GUIDES.map(|view| kept.layer(film, Aov::View(view)));
        let guides = Guides {
            albedo: albedo.unwrap_or_default(),
            normal: normal.unwrap_or_default(),
        };
        let denoised = denoiser.denoise(film.size(), &self.picture, guides);
        let denoised = denoised.map_err(Failure::job)?;
        self.picture = denoised.pixels;
        Ok(denoised.version)
    }

    /// The picture itself.
    pub fn picture(&self) -> &[Rgb] {
        &self.picture
    }

    /// The share of each pixel that is covered, where the background is transparent.
    pub fn alpha(&self) -> Option<&[f32]> {
        self.alpha.as_deref()
    }

    /// The layers of a file: the picture, without a name, and the others.
    pub fn layers(&self) -> Vec<Layer<'_>> {
        let picture = Layer {
            name: "",
            values: Values::Colors(&self.picture),
        };
        let alpha = self.alpha().map(|values| Layer {
            name: "",
            values: Values::Numbers {
                channel: "A",
                values,
            },
        });
        let others = self.others.iter().map(|(name, values)| Layer {
            name,
            values: match values {
                Owned::Colors(values) => Values::Colors(values),
                Owned::Vectors(values) => Values::Vectors(values),
                Owned::Numbers(channel, values) => Values::Numbers { channel, values },
            },
        });
        let mattes = self.mattes.iter().flat_map(Cryptomatte::layers);
        let picture = std::iter::once(picture).chain(alpha);
        picture.chain(others).chain(mattes).collect()
    }

    /// What a file's header says about the layers.
    pub fn attributes(&self) -> Vec<(String, String)> {
        let all = self.mattes.iter().flat_map(Cryptomatte::attributes);
        all.collect()
    }
}

/// Objects are called as their nodes are, or else their meshes.
fn objects(film: &Film, scene: &Scene) -> Cryptomatte {
    let name = |(number, instance): (usize, &Instance)| {
        let mesh = &scene.mesh(instance.mesh).name;
        let named = [&instance.name, mesh].into_iter().find(|n| !n.is_empty());
        named.map_or_else(|| format!("object {number}"), String::clone)
    };
    let names: Vec<String> = scene.instances.iter().enumerate().map(name).collect();
    let pixels = film.objects.iter();
    let pixels = pixels.map(|pixel| pixel.iter().map(|&(id, share)| (id as usize, share)));
    Cryptomatte::new("CryptoObject", &names, pixels)
}

fn materials(film: &Film, scene: &Scene) -> Cryptomatte {
    let name = |(number, material): (usize, &Material)| match material.name.as_str() {
        "" => format!("material {number}"),
        name => name.to_owned(),
    };
    let names: Vec<String> = scene.materials.iter().enumerate().map(name).collect();
    let material = |id: u32| scene.instances[id as usize].material.0 as usize;
    let pixels = film.objects.iter();
    let pixels = pixels.map(|pixel| pixel.iter().map(|&(id, share)| (material(id), share)));
    Cryptomatte::new("CryptoMaterial", &names, pixels)
}
