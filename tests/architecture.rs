//! Holds the sources to their architecture: a module uses only those that `src/lib.rs` declares
//! above it, the library does not print, `unsafe` has two homes, and files stay short.

use std::fs;
use std::path::{Path, PathBuf};

/// Files longer than this are to be split by noun.
const LONGEST_FILE: usize = 500;

/// A file under `src/`.
struct Source {
    /// Relative to the package, with forward slashes.
    path: String,
    /// Its top-level module; `lib` and `main` for the two roots.
    module: String,
    text: String,
}

#[test]
fn a_module_uses_only_those_above_it() {
    let order = module_order(&read("src/lib.rs"));
    assert!(order.len() > 5, "src/lib.rs declares {order:?}");
    let faults: Vec<String> = library_sources()
        .iter()
        .flat_map(|source| faults_of_order(source, &order))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn an_arrow_that_points_back_is_found() {
    let order = ["math", "color", "scene", "bvh"].map(String::from);
    let text = "//! Colours.\nuse crate::{math::Vec3, bvh::{self, Bvh}};\nuse crate::scene::Scene;\n\
                // crate::bvh in a comment is no use of it\nfn f(c: crate::color::Rgb) {}\n";
    let source = Source {
        path: "src/color.rs".into(),
        module: "color".into(),
        text: text.into(),
    };
    assert_eq!(
        faults_of_order(&source, &order),
        [
            "src/color.rs:2: color -> bvh, which stands below it in src/lib.rs",
            "src/color.rs:3: color -> scene, which stands below it in src/lib.rs",
        ]
    );
}

#[test]
fn an_arrow_through_super_is_found() {
    let order = ["math", "scene", "import", "bvh"].map(String::from);
    let text = "//! A part.\nuse super::super::super::bvh::Bvh;\nuse super::super::bvh_like;\n\
                use super::super::super::{math, bvh::Builder};\n\
                mod tests {\n    use super::super::super::bvh_like;\n    \
                use super::super::super::super::bvh;\n}\nuse super::super::super::math::Vec3;\n";
    let source = |path: &str| Source {
        path: path.into(),
        module: "import".into(),
        text: text.into(),
    };
    let fault = |line| {
        format!(
            "src/import/gltf/part.rs:{line}: import -> bvh, which stands below it in src/lib.rs"
        )
    };
    assert_eq!(
        faults_of_order(&source("src/import/gltf/part.rs"), &order),
        [2, 4, 7].map(fault)
    );
    // One folder further down none of them leads out of the module.
    assert!(
        faults_of_order(&source("src/import/gltf/a/part.rs"), &order)
            .iter()
            .all(|fault| fault.contains("part.rs:7"))
    );
    assert_eq!(depth("src/lib.rs"), 0);
    assert_eq!(depth("src/import/mod.rs"), 1);
    assert_eq!(depth("src/import/gltf/part.rs"), 3);
}

#[test]
fn only_the_program_prints() {
    let printers = [
        "println!",
        "eprintln!",
        "print!",
        "eprint!",
        "dbg!",
        "stdout()",
        "stderr()",
    ];
    assert_nowhere("the library prints", |source, code| {
        !is_program(source) && printers.iter().any(|printer| has_word(code, printer))
    });
}

/// Functions of a library that is loaded at run time cannot be called without `unsafe`.
const FOREIGN_FUNCTIONS: &str = "src/output/denoise/ffi.rs";

#[test]
fn unsafe_lives_in_the_bvh_and_where_foreign_functions_are_called() {
    assert_nowhere("unsafe outside of its homes", |source, code| {
        let is_home = source.module == "bvh" || source.path == FOREIGN_FUNCTIONS;
        !is_home && has_word(code, "unsafe") && !code.contains("unsafe_code")
    });
}

#[test]
fn files_are_short() {
    let long: Vec<String> = sources()
        .iter()
        .map(|source| (source, source.text.lines().count()))
        .filter(|(_, lines)| *lines > LONGEST_FILE)
        .map(|(source, lines)| format!("{}: {lines} lines", source.path))
        .collect();
    assert!(
        long.is_empty(),
        "over {LONGEST_FILE} lines:\n{}",
        long.join("\n")
    );
}

#[test]
fn files_say_what_they_are() {
    let silent: Vec<String> = sources()
        .into_iter()
        .filter(|source| !source.text.starts_with("//! "))
        .map(|source| source.path)
        .collect();
    assert!(silent.is_empty(), "no `//!` at the top of {silent:?}");
}

/// Fails with the place of every line of code for which `is_fault` holds.
fn assert_nowhere(what: &str, is_fault: impl Fn(&Source, &str) -> bool) {
    let mut faults = Vec::new();
    for source in &sources() {
        for (number, line) in code_lines(&source.text) {
            if is_fault(source, line) {
                faults.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    assert!(faults.is_empty(), "{what}:\n{}", faults.join("\n"));
}

fn is_program(source: &Source) -> bool {
    source.module == "main" || source.module == "cli"
}

/// The modules of the library in the order of their declarations.
fn module_order(lib: &str) -> Vec<String> {
    code_lines(lib)
        .filter_map(|(_, line)| {
            let line = line.trim();
            let rest = line
                .strip_prefix("pub mod ")
                .or(line.strip_prefix("mod "))?;
            Some(rest.trim_end_matches(';').to_owned())
        })
        .collect()
}

fn faults_of_order(source: &Source, order: &[String]) -> Vec<String> {
    let place = |module: &str| order.iter().position(|m| m == module);
    let Some(own) = place(&source.module) else {
        return Vec::new();
    };
    let mut faults = Vec::new();
    for (line, used) in used_modules(source) {
        let (path, module) = (&source.path, &source.module);
        match place(&used) {
            Some(used_place) if used_place <= own => {}
            Some(_) => faults.push(format!(
                "{path}:{line}: {module} -> {used}, which stands below it in src/lib.rs"
            )),
            None => faults.push(format!(
                "{path}:{line}: {module} -> {used}, which src/lib.rs does not declare"
            )),
        }
    }
    faults
}

/// The line and the first name of every path that starts at the root of the library, with `crate::`
/// or as many `super::` as lead there; lists in braces are taken apart.
fn used_modules(source: &Source) -> Vec<(usize, String)> {
    let code = without_comments(&source.text);
    let mut used = Vec::new();
    let starts = code
        .match_indices("crate::")
        .chain(code.match_indices("super::"));
    for (at, found) in starts {
        let before = &code[..at];
        if before.ends_with(|c: char| c.is_alphanumeric() || "_$:".contains(c)) {
            continue;
        }
        let mut rest = &code[at + found.len()..];
        if found == "super::" {
            let mut levels = 1;
            while let Some(further) = rest.strip_prefix("super::") {
                (rest, levels) = (further, levels + 1);
            }
            if levels != depth(&source.path) + inline_modules(before) {
                continue;
            }
        }
        let line = 1 + before.matches('\n').count();
        used.extend(first_names(rest).into_iter().map(|name| (line, name)));
    }
    used.sort();
    used
}

/// How many modules a file is below the root: `src/a/b.rs` and `src/a/b/mod.rs` are 2.
fn depth(path: &str) -> usize {
    let parts = path.trim_end_matches("/mod.rs").split('/').count() - 1;
    if path == "src/lib.rs" { 0 } else { parts }
}

/// How many `mod name {` are open at the end of `code`, which is laid out by rustfmt: a module ends
/// where a brace stands alone below its beginning.
fn inline_modules(code: &str) -> usize {
    let mut open: Vec<String> = Vec::new();
    for line in code.lines() {
        let statement = line.trim_start();
        let indent = &line[..line.len() - statement.len()];
        let is_module = statement.starts_with("mod ") || statement.contains(" mod ");
        if is_module && statement.ends_with('{') {
            open.push(format!("{indent}}}"));
        } else if open.last().is_some_and(|end| end == line) {
            open.pop();
        }
    }
    open.len()
}

/// `a::b` names `a`; `{a::b, c::{d, e}}` names `a` and `c`.
fn first_names(path: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let end = text.find(|c: char| !c.is_alphanumeric() && c != '_');
        text[..end.unwrap_or(text.len())].to_owned()
    };
    let Some(list) = path.strip_prefix('{') else {
        return vec![name(path)];
    };
    let mut names = Vec::new();
    let (mut depth, mut is_start) = (0, true);
    for (i, c) in list.char_indices() {
        match c {
            '}' if depth == 0 => break,
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => is_start = true,
            c if is_start && !c.is_whitespace() => {
                names.push(name(&list[i..]));
                is_start = false;
            }
            _ => {}
        }
    }
    names
}

/// The text with every line comment blanked, so that lines keep their numbers.
fn without_comments(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(code_of).collect();
    lines.join("\n")
}

/// Lines with their numbers from 1, without line comments.
fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(i, line)| (i + 1, code_of(line)))
}

/// What stands before a line comment. `//` after a colon is an address in a string.
fn code_of(line: &str) -> &str {
    let comment = line
        .match_indices("//")
        .find(|(at, _)| !line[..*at].ends_with(':'));
    comment.map_or(line, |(at, _)| &line[..at])
}

fn has_word(code: &str, word: &str) -> bool {
    code.match_indices(word).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let after = code[at + word.len()..].chars().next();
        let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        !is_part(before) && !is_part(after)
    })
}

fn library_sources() -> Vec<Source> {
    let mut sources = sources();
    sources.retain(|source| !is_program(source) && source.module != "lib");
    sources
}

fn sources() -> Vec<Source> {
    let mut paths = Vec::new();
    collect(&root().join("src"), &mut paths);
    paths.sort();
    assert!(paths.len() > 10, "found only {paths:?}");
    paths.iter().map(|path| source(path)).collect()
}

fn source(path: &Path) -> Source {
    let names: Vec<String> = path
        .strip_prefix(root())
        .unwrap_or(path)
        .components()
        .map(|c| c.as_os_str().to_string_lossy().into_owned())
        .collect();
    let path = names.join("/");
    Source {
        module: names[1].trim_end_matches(".rs").to_owned(),
        text: read(&path),
        path,
    }
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, paths);
        } else if path.extension().is_some_and(|e| e == "rs") {
            paths.push(path);
        }
    }
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
