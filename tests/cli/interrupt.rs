//! Ctrl-C.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;

use super::{channels, folder, json, names, program};

/// Starts a render of `scene.obj`, and comes back once it has begun.
fn begin(folder: &Path, arguments: &[&str]) -> (Child, BufReader<ChildStderr>) {
    let mut child = program(folder)
        .args(["render", "scene.obj", "-v"])
        .args(arguments)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut messages = BufReader::new(child.stderr.take().unwrap());
    read_until(&mut messages, "rendering");
    (child, messages)
}

fn read_until(messages: &mut impl BufRead, start: &str) {
    let mut line = String::new();
    while !line.starts_with(start) {
        line.clear();
        let length = messages.read_line(&mut line).unwrap();
        assert!(length > 0, "it ended before \"{start}\"");
    }
}

fn interrupt(child: &Child) {
    let process = child.id().to_string();
    let sent = Command::new("kill").args(["-INT", &process]).status();
    assert!(sent.unwrap().success());
}

#[test]
fn an_interrupted_render_saves_what_there_is() {
    let folder = folder();
    let samples = ["--size", "40x30", "--samples", "100000000"];
    let outputs = ["--stats", "s.json", "-o", "a.exr"];
    let (mut child, mut messages) = begin(folder.path(), &[samples, outputs].concat());
    interrupt(&child);
    let mut rest = String::new();
    messages.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{rest}");
    assert!(rest.contains("interrupted"), "{rest}");
    assert_eq!(names(folder.path()), ["a.exr", "s.json", "scene.obj"]);
    let stats = json(&folder.path().join("s.json"));
    assert_eq!(stats["stopped_by"], "interrupt");
    assert_eq!(stats["size"], serde_json::json!([40, 30]));
    channels(&folder.path().join("a.exr"));
}

/// Starts a render whose files take long to write, and comes back while they are written.
fn begin_writing(folder: &Path) -> (Child, BufReader<ChildStderr>) {
    let outputs: Vec<String> = (0..20).map(|i| format!("{i}.exr")).collect();
    let mut arguments = vec!["--size", "700x500", "--samples", "1", "--threads", "1"];
    for output in &outputs {
        arguments.extend(["-o", output]);
    }
    let (child, messages) = begin(folder, &arguments);
    while names(folder).len() < 2 {
        std::thread::sleep(Duration::from_millis(1));
    }
    (child, messages)
}

#[test]
fn a_complete_picture_that_is_being_saved_is_not_called_interrupted() {
    let folder = folder();
    let (mut child, mut messages) = begin_writing(folder.path());
    interrupt(&child);
    let mut rest = String::new();
    messages.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0), "{rest}");
    assert!(rest.contains("complete"), "{rest}");
    assert!(!rest.contains("interrupted"), "{rest}");
    assert_eq!(names(folder.path()).len(), 1 + 20);
}

#[test]
fn a_second_interrupt_leaves_no_temporary_file() {
    let folder = folder();
    let (mut child, mut messages) = begin_writing(folder.path());
    interrupt(&child);
    read_until(&mut messages, "the picture is complete");
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let names = names(folder.path());
    assert!(names.len() < 1 + 20, "it ended too late: {names:?}");
    assert!(!names.iter().any(|n| n.ends_with(".tmp")), "{names:?}");
}
