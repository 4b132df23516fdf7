//! The explorer command: reads maps, plans on them, and flies simulated missions.

mod args;
mod command;
mod failure;
mod flight;
mod input;
mod logging;
mod output;
mod planning;
mod plot;
mod progress;
mod report;
mod stopwatch;
mod tracking;

use std::process::ExitCode;

use clap::Parser as _;

fn main() -> ExitCode {
    // Wrong usage ends here with exit code 2.
    let cli = args::Cli::parse_from(args::join_model_file(std::env::args_os()));
    logging::begin();
    match command::run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::complain(&failure);
            ExitCode::FAILURE
        }
    }
}
