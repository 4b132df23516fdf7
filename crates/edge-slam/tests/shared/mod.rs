//! Where recordings and networks lie that tests read: `EXPLORER_DATA`, or a folder beside the checkout.

#![allow(clippy::print_stdout, reason = "tests say what they skip")]

use std::path::PathBuf;

/// A file or folder there, or `None` with a line that says so.
pub(crate) fn shared(parts: &[&str]) -> Option<PathBuf> {
    let root = std::env::var_os("EXPLORER_DATA")
        .unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").into());
    let path = PathBuf::from(root).join(parts.iter().collect::<PathBuf>());
    if path.exists() {
        return Some(path);
    }
    println!(
        "skipped: {} is not there (set EXPLORER_DATA)",
        path.display()
    );
    None
}
