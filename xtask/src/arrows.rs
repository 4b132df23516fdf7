//! Which crate may depend on which: the rules of ARCHITECTURE.md, and the graph as text.

use std::fmt::Write;

use crate::workspace::{Package, Workspace};

/// Workspace crates that each crate may name, in dependencies and dev-dependencies alike. Crates that are missing here
/// may depend on everything.
const ALLOWED: &[(&str, &[&str])] = &[
    ("submodular-minimax", &[]),
    ("exit-finder", &[]),
    ("sparse-to-obstacles", &[]),
    ("rrt-refine", &[]),
    ("tello-sdk", &[]),
    ("slam-bridge", &[]),
    ("edge-slam", &["slam-bridge"]),
    // Simulator and solver must not share bugs: no algorithm crate here.
    ("indoor-sim", &["tello-sdk", "slam-bridge"]),
    ("ground-station", &[]),
];

/// Crates that may depend on the composition.
const USERS_OF_EXPLORER: &[&str] = &["examples", "benches"];

pub(crate) fn faults(workspace: &Workspace) -> Vec<String> {
    let mut faults = Vec::new();
    for package in &workspace.packages {
        for (target, table) in internal_dependencies(workspace, package) {
            let allowed = match ALLOWED.iter().find(|(name, _)| *name == package.name) {
                Some((_, allowed)) => allowed.contains(&target.as_str()),
                None => target != "explorer" || USERS_OF_EXPLORER.contains(&package.name.as_str()),
            };
            if !allowed {
                faults.push(format!(
                    "{}/Cargo.toml: {table} names {target}, against the dependency rules of ARCHITECTURE.md; \
                     couple them by a closure in explorer instead",
                    package.name
                ));
            }
        }
    }
    faults
}

/// The crates and their arrows, one line a crate.
pub(crate) fn graph(workspace: &Workspace) -> String {
    let mut text = String::new();
    for package in &workspace.packages {
        let mut targets: Vec<String> = internal_dependencies(workspace, package)
            .into_iter()
            .map(|(target, _)| target)
            .collect();
        targets.sort();
        targets.dedup();
        let arrow = if targets.is_empty() {
            "-".to_owned()
        } else {
            targets.join(", ")
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:<22} -> {arrow}", package.name);
    }
    text
}

/// Pairs of a workspace crate that `package` names and the table that names it.
fn internal_dependencies(workspace: &Workspace, package: &Package) -> Vec<(String, &'static str)> {
    let mut found = Vec::new();
    for table in ["dependencies", "dev-dependencies", "build-dependencies"] {
        let Some(entries) = package.manifest.get(table).and_then(toml::Value::as_table) else {
            continue;
        };
        for name in entries.keys() {
            if workspace.packages.iter().any(|other| &other.name == name) {
                found.push((name.clone(), table));
            }
        }
    }
    found
}
