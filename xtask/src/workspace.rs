//! Where the workspace lies, which crates it has, and which files belong to a crate.

use std::fs;
use std::path::{Path, PathBuf};

/// One crate of the workspace.
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) folder: PathBuf,
    pub(crate) manifest: toml::Table,
}

/// The checkout that this program was compiled in.
pub(crate) struct Workspace {
    pub(crate) root: PathBuf,
    pub(crate) packages: Vec<Package>,
}

impl Workspace {
    /// Reads the manifests beside this package. A manifest that cannot be read counts as empty: cargo itself complains.
    pub(crate) fn locate() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut folders: Vec<PathBuf> = entries(&root.join("crates"));
        folders.extend(["examples", "benches", "xtask"].map(|name| root.join(name)));
        let packages = folders
            .into_iter()
            .filter(|folder| folder.join("Cargo.toml").is_file())
            .map(|folder| Package {
                name: folder
                    .file_name()
                    .map(|n| n.to_string_lossy().into_owned())
                    .unwrap_or_default(),
                manifest: fs::read_to_string(folder.join("Cargo.toml"))
                    .unwrap_or_default()
                    .parse()
                    .unwrap_or_default(),
                folder,
            })
            .collect();
        Self { root, packages }
    }
}

impl Package {
    /// Whether this crate lies in `crates/`, so that people can use it alone.
    pub(crate) fn is_library(&self) -> bool {
        self.folder
            .parent()
            .and_then(Path::file_name)
            .is_some_and(|name| name == "crates")
    }
}

/// Files and folders directly in `folder`, sorted by name; empty where it cannot be read.
pub(crate) fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .collect();
    paths.sort();
    paths
}

/// All Rust sources below `folder`, sorted, build output left out.
pub(crate) fn rust_sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in entries(folder) {
        if path.is_dir() {
            if path.file_name().is_none_or(|name| name != "target") {
                found.extend(rust_sources(&path));
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found
}
