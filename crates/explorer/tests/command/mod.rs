//! The explorer command as a user runs it, and where tests write and read.

#![allow(
    dead_code,
    clippy::print_stdout,
    reason = "every test file uses its own part, and says what it skips"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

pub(crate) fn explorer(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_explorer"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

/// The command's JSON object.
pub(crate) fn json(arguments: &[&str]) -> Value {
    let flag: &[&str] = match arguments.contains(&"--json") {
        true => &[],
        false => &["--json"],
    };
    let output = explorer(&[arguments, flag].concat());
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).expect("one JSON object on stdout")
}

/// Runs a command that must fail with one line on stderr and nothing on stdout; gives the line.
pub(crate) fn complaint(arguments: &[&str]) -> String {
    let output = explorer(arguments);
    let line = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {line}");
    assert!(output.stdout.is_empty(), "{arguments:?} printed a result");
    assert_eq!(
        line.trim_end().lines().count(),
        1,
        "more than one line: {line}"
    );
    assert!(
        line.starts_with("explorer: ") && line.contains("; "),
        "no advice: {line}"
    );
    line
}

/// A folder of this test's own, empty.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder for the test");
    folder
}

/// Writes a file; its path as an argument.
pub(crate) fn file(folder: &Path, name: &str, content: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, content).expect("a file for the test");
    text(&path)
}

/// A path as an argument.
pub(crate) fn text(path: &Path) -> String {
    path.display().to_string()
}

/// A part of the published data, or `None` with a line that says so.
pub(crate) fn data(name: &str) -> Option<PathBuf> {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").into();
    let root = std::env::var_os("EXPLORER_DATA").map_or(default, PathBuf::from);
    let path = root.join("data").join(name);
    if path.is_dir() {
        return Some(path);
    }
    println!(
        "skipped: {} is not there (set EXPLORER_DATA)",
        path.display()
    );
    None
}
