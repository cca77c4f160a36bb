//! Makes the models that the scenes show.
//!
//! `cargo run --release --example generate-models` writes those that are kept in `models/`, with
//! `-- large` the ones that are not, into `target/models/`.

#[path = "generate/mod.rs"]
mod generate;

use std::io;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (folder, files) = match arguments.as_slice() {
        [] => ("models", generate::small_files()),
        [large] if large == "large" => ("target/models", generate::large_files()),
        _ => {
            eprintln!("usage: generate-models [large]");
            return ExitCode::from(2);
        }
    };
    match write(folder, &files) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{folder}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write(folder: &str, files: &[generate::File]) -> io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    generate::write(&root.join(folder), files)?;
    for file in files {
        let (bytes, triangles) = (file.bytes.len(), file.triangles);
        println!(
            "{folder}/{}: {bytes} bytes, {triangles} triangles",
            file.name
        );
    }
    if folder == "models" {
        let lamp = generate::cornell_lamp()
            .map(|c| format!("{c:.4}"))
            .join(", ");
        println!("radiance of the lamp in scenes/cornell.toml: [{lamp}]");
    }
    Ok(())
}
