//! What every crate must carry beside its code, and file names that say nothing.

use crate::workspace::{Workspace, rust_sources};

/// File stems that hide what is inside.
const EMPTY_WORDS: &[&str] = &[
    "utils", "util", "helpers", "helper", "common", "misc", "types",
];

pub(crate) fn faults(workspace: &Workspace) -> Vec<String> {
    let mut faults = Vec::new();
    for package in workspace
        .packages
        .iter()
        .filter(|package| package.is_library())
    {
        for required in ["README.md", "CHANGELOG.md"] {
            if !package.folder.join(required).is_file() {
                faults.push(format!(
                    "crates/{}: {required} is missing; write it",
                    package.name
                ));
            }
        }
        let inherits_lints = package
            .manifest
            .get("lints")
            .and_then(|lints| lints.get("workspace"))
            .and_then(toml::Value::as_bool);
        if inherits_lints != Some(true) {
            faults.push(format!(
                "crates/{}/Cargo.toml: add `[lints] workspace = true`",
                package.name
            ));
        }
    }
    for package in &workspace.packages {
        for path in rust_sources(&package.folder) {
            let stem = path
                .file_stem()
                .map(|stem| stem.to_string_lossy().into_owned())
                .unwrap_or_default();
            if EMPTY_WORDS.contains(&stem.as_str()) {
                faults.push(format!(
                    "{}: `{stem}` says nothing about its content; name the file by its concept",
                    path.display()
                ));
            }
        }
    }
    faults
}
