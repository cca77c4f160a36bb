//! OBJ and MTL: every real file against the truth of other loaders, every rule on a file of its own, and bad input
//! of all kinds.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "import_obj/bad_input.rs"]
mod bad_input;
#[path = "import_obj/common.rs"]
mod common;
#[path = "import_obj/geometry.rs"]
mod geometry;
#[path = "import_obj/materials.rs"]
mod materials;
#[path = "import_obj/oracle.rs"]
mod oracle;
#[path = "import_obj/polygons.rs"]
mod polygons;
#[path = "import_obj/shared_models.rs"]
mod shared_models;
