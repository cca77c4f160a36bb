//! Input of every bad kind: one clear message with its line, never a panic or a hang.

use proptest::prelude::*;

use super::common::{Folder, import, message_of};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn a_face_names_the_vertex_that_is_not_there() {
    for (face, expected) in [
        (
            "f 1 2 9",
            "line 5: face uses vertex 9, but there are only 4",
        ),
        (
            "f 1 2 0",
            "line 5: face uses vertex 0, but they are counted from 1",
        ),
        (
            "f 1 2 -5",
            "line 5: face uses vertex -5, but there are only 4 before it",
        ),
        (
            "f 1 2 4294967297",
            "line 5: face uses vertex 4294967297, but there are only 4",
        ),
        (
            "f 1 2 99999999999999999999999",
            "line 5: face uses vertex 99999999999999999999999, but there are only 4",
        ),
        (
            "f 1 2 3\n\nf 1 2 \\\n 17",
            "line 7: face uses vertex 17, but there are only 4",
        ),
        (
            "f 1 6 5\nf 1 2 7\nv 0 0 0",
            "line 5: face uses vertex 6, but there are only 5",
        ),
    ] {
        assert_eq!(message_of(format!("{SQUARE}{face}\n").as_bytes()), expected);
    }
}

#[test]
fn numbers_that_are_none_are_named_with_their_line() {
    for (text, expected) in [
        (
            "v 1 abc 3",
            "line 1: a vertex has \"abc\", which is not a number",
        ),
        ("v 1 2", "line 1: a vertex needs 3 numbers, and has 2"),
        (
            "v 1,5 2 3",
            "line 1: a vertex has \"1,5\", which is not a number",
        ),
        (
            "\nvt x",
            "line 2: a texture coordinate has \"x\", which is not a number",
        ),
        (
            "vt",
            "line 1: a texture coordinate needs 1 numbers, and has 0",
        ),
        ("vn 0 1", "line 1: a normal needs 3 numbers, and has 2"),
        (
            "f a b c",
            "line 1: face uses vertex \"a\", which is not a whole number",
        ),
        (
            "f 1.5 2 3",
            "line 1: face uses vertex \"1.5\", which is not a whole number",
        ),
        (
            "f /1 /2 /3",
            "line 1: face uses vertex \"\", which is not a whole number",
        ),
        (
            "v 0 0 0\nf 1/a 1 1",
            "line 2: face uses texture coordinate \"a\", which is not a whole number",
        ),
        (
            "v 0 0 0\nf 1/1/1/1 1 1",
            "line 2: face uses normal \"1/1\", which is not a whole number",
        ),
        ("s x", "line 1: \"x\" is not a smoothing group"),
        (
            "v 0 0 0\n\0\x01\x02",
            "line 2: \"\\0\\u{1}\\u{2}\" is not a statement of an OBJ file",
        ),
    ] {
        assert_eq!(message_of(text.as_bytes()), expected, "{text:?}");
    }
}

#[test]
fn files_without_a_model_are_told_apart() {
    assert_eq!(message_of(b""), "it is empty");
    assert_eq!(message_of(b"# only words\n\n"), "it is empty");
    assert_eq!(message_of(b"o name\n"), "it has no vertices");
    assert_eq!(message_of(b"hello world\n"), "it has no vertices");
    let folder = Folder::with(&[("folder.obj/inside", b"")]);
    let message = folder.import("folder.obj").map(|_| ()).unwrap_err();
    assert!(message.contains("is a directory"), "{message}");
    let message = folder.import("missing.obj").map(|_| ()).unwrap_err();
    assert!(message.contains("missing.obj: "), "{message}");
}

#[test]
fn a_message_is_short_whatever_the_file_holds() {
    let long = "x".repeat(1_000_000);
    for text in [
        format!("v {long} 0 0\n"),
        format!("{long}\u{7f}\n"),
        format!("v 0 0 0\nf {long}\n"),
    ] {
        let message = message_of(text.as_bytes());
        assert!(message.len() < 200, "{}", message.len());
    }
    let digits = "9".repeat(1_000_000);
    assert!(message_of(format!("v 0 0 0\nf {digits} 1 1\n").as_bytes()).len() < 200);
}

/// A file with every kind of statement.
const EVERYTHING: &[u8] = b"\xef\xbb\xbf# a comment\r\nmtllib a.mtl b c.mtl\no first\ng group\ns 1\n\
    v 0 0 0 1 0.5 0.25\nv 1.5e0 0 0\nv 1 1 0 1\nv -0.25 1 .5\nv 0.5 2 0\nvt 0 0\nvt 1 1 0\nvn 0 0 1\n\
    usemtl red \xff\xfe\nf 1/1/1 2/2/1 3//1\nf 1/1 2/2 \\\n 3 4\nf -5 -4 -3 -1 -2\ns off\nl 1 2\np 1\n\
    o second\nvp 1 2\nf 1 2 3\n";

#[test]
fn truncation_at_every_byte_gives_a_scene_or_one_message() {
    let library =
        b"newmtl red\nKd 1 0 0\nmap_Kd -s 1 1 1 -o 0 0 a b.png\nillum 7\nd 0.5\nnewmtl b\nPr 0.5";
    let folder = Folder::with(&[]);
    let mut scenes = 0;
    for end in 0..=EVERYTHING.len() {
        folder.add("cut.obj", &EVERYTHING[..end]);
        folder.add("a.mtl", &library[..end.min(library.len())]);
        scenes += usize::from(folder.import("cut.obj").is_ok());
    }
    // Most cuts leave whole statements and a last one that is short: both must happen.
    assert!(scenes > 100 && scenes < EVERYTHING.len(), "{scenes} scenes");
    assert!(folder.import("cut.obj").is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn random_bytes_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let folder = Folder::with(&[("a.obj", &bytes), ("a.mtl", &bytes)]);
        let _ = folder.import("a.obj");
        folder.add("b.obj", b"mtllib a.mtl\nv 0 0 0\nusemtl x\nf 1 1 1\n");
        prop_assert!(folder.import("b.obj").is_ok());
    }

    #[test]
    fn changed_bytes_do_no_harm(changes in prop::collection::vec((0..EVERYTHING.len(), any::<u8>()), 1..8)) {
        let mut bytes = EVERYTHING.to_vec();
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        let _ = Folder::with(&[("a.obj", &bytes)]).import("a.obj");
    }

    #[test]
    fn random_statements_do_no_harm(
        words in prop::collection::vec("(\n(v|vt|vn|f|s|o|usemtl|mtllib|l|p)|-?[0-9]{1,2}|[0-9]\\.[0-9]|[1-4]//[1-4]|[1-9]/[1-9]/[1-9]|nan|#|\\\\)", 0..120),
    ) {
        let text = words.join(" ");
        let _ = Folder::with(&[("a.obj", text.as_bytes())]).import("a.obj");
    }
}

#[test]
#[cfg(unix)]
fn a_library_or_texture_without_end_is_not_read() {
    let folder = Folder::with(&[(
        "a.obj",
        b"mtllib /dev/zero b.mtl\nv 0 0 0\nusemtl b\nf 1 1 1\n".as_slice(),
    )]);
    folder.add("b.mtl", b"newmtl b\nmap_Kd /dev/zero\n");
    let imported = import(&folder.path("a.obj")).unwrap();
    assert_eq!(imported.warnings.iter().count(), 2);
    assert!(imported.scene.textures.is_empty());
}
