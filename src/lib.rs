//! Halfshade renders imported triangle meshes with soft shadows, and says how wrong it is.
//!
//! This page is the architecture. How to use the program stands in the README; how a scene
//! file is written, in [`import::scene_file`].
//!
//! # The way of the data
//!
//! ```text
//! files --import--> Scene --prepare--> PreparedScene --render--> Film --output--> PNG, EXR
//!  glTF, OBJ,        what the           triangles, trees,
//!  scene files       author said        lights
//!
//! render:      pixel -> Sampler -> Camera -> Ray -> Integrator -> Rgb -> Film
//! Integrator:  closest_hit -> Surface -> Bsdf;  Light::sample -> is it blocked? -> sum
//! ```
//!
//! Left of [`prepare::PreparedScene`] things may fail and return a `Result`; right of it nothing fails
//! until a file is written. No arrow points back: the modules below stand in this order, and each
//! uses only those above it (`tests/architecture.rs` holds it to that).
//!
//! | module | what comes in | what goes out |
//! |---|---|---|
//! | [`math`], [`color`] | | vectors, rays, boxes; linear colour |
//! | [`sampling`] | seed, pixel, index, dimension | numbers in `[0, 1)` |
//! | [`texture`] | texture coordinates | colours |
//! | [`camera`] | a point of the film | a ray |
//! | [`interaction`] | a point of a surface | rays that leave it |
//! | [`light`] | a shading point | a direction, a weight, and what must be unblocked |
//! | [`material`] | a place on a surface | a [`material::Bsdf`] |
//! | [`scene`] | | the typed description of everything that the author said |
//! | [`import`] | files | a [`scene::Scene`] with settings and warnings |
//! | [`bvh`] | triangles | hits |
//! | [`prepare`] | a scene | what rays meet |
//! | [`film`] | samples | means, variances |
//! | [`integrate`] | a ray | the radiance that comes back along it |
//! | [`render`] | a prepared scene, a camera, settings | a film |
//! | [`output`] | pixels | files |
//! | [`mod@bench`] | triangles, rays, scenes | how long they take |
//! | [`report`] | pictures, measurements | how far they are apart, error maps, fits, plots, pages |
//! | [`converge`] | a scene, methods | error against run time |
//! | [`stress`] | extreme scenes | how far they are from their known answers |
//!
//! The program (`main.rs` and `cli/`) is thin: it parses arguments, runs one command, prints, and turns errors
//! into exit statuses. The library never prints.
//!
//! # Decisions, and why
//!
//! * **Import once, then never look back.** A messy format becomes a small typed tree in which every
//!   reference, unit and default is resolved. Formats change most; behind this door they change nothing else.
//! * **Lights and materials return records; the integrator shoots the rays.** A light that tests its own
//!   shadow needs the scene, and then every module needs every other.
//! * **Closed enums in place of trait objects** for lights, materials, patterns and targets: a `match`
//!   shows all kinds at a glance, and the compiler lists what a new kind has to answer. The one
//!   trait is [`integrate::Integrator`].
//! * **A sample is a pure function** of (seed, pixel, index, dimension). No state passes from one to the next, so
//!   threads, tiles and restarts cannot change the picture, and one sample of one pixel can be traced again by its name.
//! * **Double precision where things are placed, single where rays run.** A scene holds transforms in
//!   `f64`; [`prepare`] moves a scene that is far from the origin to its own middle, so that it keeps its
//!   digits, and scales it by a power of two, so that a scene of any size uses the same numbers.
//! * **No absolute epsilon.** A ray that leaves a surface starts where the bound on the rounding
//!   error of the hit ends ([`interaction`]); a fixed distance would be wrong at one scale or the other.
//! * **Instances are kept where that pays.** Meshes are flattened into one tree while that adds no more than
//!   some two million triangles, so most scenes have no transform in the traversal; beyond that a shared mesh is kept
//!   once, with a tree of its own.
//! * **Nothing after `prepare` returns a `Result`.** A sample that is not finite is dropped by the
//!   [`film`], counted, and its pixel and index are kept: one bad number ends no render of an hour.
//! * **Means are kept in `f64`,** in the order of the samples: a million samples still add up.
//! * **Every pixel has two halves** that know nothing of each other, so that every picture can say how
//!   wrong it is ([`film::ErrorEstimate`]). Two half sets are less even than a whole one: at
//!   edges that costs about a quarter more time for an error. Adaptive sampling, which rests on the halves, brings back more.
//! * **Few newtypes:** unit vectors, linear colour, indices. They stand where mixing two things up costs
//!   pixels; points and directions are both plain vectors, since transforms happen in one place.

#![warn(missing_docs)]

pub mod math;

pub mod color;

pub mod sampling;

pub mod texture;

pub mod camera;

pub mod interaction;

pub mod light;

pub mod material;

pub mod scene;

pub mod import;

pub mod bvh;

pub mod prepare;

pub mod film;

pub mod integrate;

pub mod render;

pub mod output;

pub mod bench;

#[cfg(feature = "report")]
pub mod report;

#[cfg(feature = "report")]
pub mod converge;

#[cfg(feature = "report")]
pub mod stress;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
