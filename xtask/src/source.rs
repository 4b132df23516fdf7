//! Rules for each source file: a module doc on the first line, limits on files and functions.

use std::fs;
use std::path::Path;

use crate::workspace::{Workspace, rust_sources};

/// Lines of a file before its tests; about 150 is the norm.
const FILE_LIMIT: usize = 500;
/// Lines of a function; under 30 is the norm.
const FUNCTION_LIMIT: usize = 70;

/// Functions over the limit, each with its reason. The list may only shrink.
const LONG_FUNCTIONS: &[(&str, &str)] = &[];

pub(crate) fn faults(workspace: &Workspace) -> Vec<String> {
    let mut faults = Vec::new();
    for package in &workspace.packages {
        for path in rust_sources(&package.folder) {
            let Ok(text) = fs::read_to_string(&path) else {
                continue;
            };
            let shown = path
                .strip_prefix(&workspace.root)
                .unwrap_or(&path)
                .display()
                .to_string();
            faults.extend(file_faults(&shown, &text, is_test_or_bench(&path)));
        }
    }
    faults
}

fn is_test_or_bench(path: &Path) -> bool {
    path.components().any(|part| {
        ["tests", "benches"]
            .iter()
            .any(|name| part.as_os_str() == *name)
    })
}

fn file_faults(shown: &str, text: &str, is_test: bool) -> Vec<String> {
    let mut faults = Vec::new();
    let first = text.lines().next().unwrap_or_default();
    if !first.starts_with("//!") && !first.starts_with("#![doc = include_str!") {
        faults.push(format!(
            "{shown}:1: the first line must be a `//!` line that says what the file computes"
        ));
    }
    if is_test {
        return faults;
    }
    let code: Vec<&str> = text
        .lines()
        .take_while(|line| !line.starts_with("#[cfg(test)]"))
        .collect();
    if code.len() > FILE_LIMIT {
        faults.push(format!(
            "{shown}: {} lines before its tests, {FILE_LIMIT} at most; split it by concept",
            code.len()
        ));
    }
    for (line, name, length) in functions(&code) {
        if length > FUNCTION_LIMIT && !LONG_FUNCTIONS.iter().any(|(function, _)| *function == name)
        {
            faults.push(format!(
                "{shown}:{line}: fn {name} has {length} lines, {FUNCTION_LIMIT} at most; split it by its steps"
            ));
        }
    }
    faults
}

/// Line, name and length of each function, by indentation: rustfmt closes a function at the column it opens in.
fn functions(code: &[&str]) -> Vec<(usize, String, usize)> {
    let mut found = Vec::new();
    for (start, line) in code.iter().enumerate() {
        let trimmed = line.trim_start();
        let indent = line.len() - trimmed.len();
        let Some(name) = function_name(trimmed) else {
            continue;
        };
        let rest = code.get(start..).unwrap_or_default();
        // A declaration without a body ends before any brace opens.
        let head = rest.iter().find(|line| line.ends_with(['{', ';', '}']));
        if head.is_none_or(|line| !line.ends_with('{')) {
            continue;
        }
        let close = format!("{}}}", " ".repeat(indent));
        let length = rest.iter().position(|line| *line == close);
        if let Some(length) = length {
            found.push((start + 1, name, length + 1));
        }
    }
    found
}

fn function_name(line: &str) -> Option<String> {
    let head = line.split('(').next()?;
    let words: Vec<&str> = head.split_whitespace().collect();
    let at = words.iter().position(|word| *word == "fn")?;
    let modifiers = [
        "pub",
        "const",
        "async",
        "unsafe",
        "extern",
        "pub(crate)",
        "pub(super)",
    ];
    if !words.iter().take(at).all(|word| modifiers.contains(word)) {
        return None;
    }
    words
        .get(at + 1)
        .map(|name| name.split('<').next().unwrap_or_default().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_function_and_a_missing_doc_are_found() {
        let body = "    let x = 1;\n".repeat(80);
        let text = format!("use a;\nfn long() {{\n{body}}}\n");
        let faults = file_faults("x.rs", &text, false);
        assert_eq!(faults.len(), 2, "{faults:?}");
        assert!(faults[1].contains("fn long has 82 lines"), "{faults:?}");
    }

    #[test]
    fn a_short_documented_file_has_no_fault() {
        assert!(file_faults("x.rs", "//! Doc.\nfn f() {\n}\n", false).is_empty());
    }
}
