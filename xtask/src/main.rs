//! The project's own chores: `cargo run -p xtask` checks the rules that the compiler does not know, and draws the crates.

mod arrows;
mod layout;
mod source;
mod workspace;

use std::process::ExitCode;

use workspace::Workspace;

/// What `cargo run -p xtask -- WORD` can do.
const USAGE: &str = "usage: cargo run -p xtask -- tidy | graph";

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line program"
)]
fn main() -> ExitCode {
    let workspace = Workspace::locate();
    match std::env::args().nth(1).as_deref() {
        None | Some("tidy") => {
            let faults = tidy(&workspace);
            for fault in &faults {
                eprintln!("{fault}");
            }
            if faults.is_empty() {
                ExitCode::SUCCESS
            } else {
                ExitCode::FAILURE
            }
        }
        Some("graph") => {
            print!("{}", arrows::graph(&workspace));
            ExitCode::SUCCESS
        }
        Some(_) => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

/// Every broken rule, one line each: where, what, and what to do.
fn tidy(workspace: &Workspace) -> Vec<String> {
    let mut faults = arrows::faults(workspace);
    faults.extend(layout::faults(workspace));
    faults.extend(source::faults(workspace));
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_is_tidy() {
        let faults = tidy(&Workspace::locate());
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }
}
