//! The commands, one file each.

mod clean;
mod demo;
mod emulate;
mod evaluate;
mod exits;
mod map;
mod obstacles;
mod plan;
mod simulate;
mod slam;

use crate::args::{Cli, Command, Demo};
use crate::failure::Failure;

/// Runs the command that was given, the demonstration without one.
pub(crate) fn run(cli: Cli) -> Result<(), Failure> {
    let output = &cli.output;
    match cli.command {
        None => demo::run(&Demo::default(), output),
        Some(Command::Demo(arguments)) => demo::run(&arguments, output),
        Some(Command::Map(arguments)) => map::run(&arguments, output),
        Some(Command::Clean(arguments)) => clean::run(&arguments, output),
        Some(Command::Exits(arguments)) => exits::run(&arguments, output),
        Some(Command::Obstacles(arguments)) => obstacles::run(&arguments, output),
        Some(Command::Plan(arguments)) => plan::run(&arguments, output),
        Some(Command::Simulate(arguments)) => simulate::run(&arguments, output),
        Some(Command::Slam(arguments)) => slam::run(&arguments, output),
        Some(Command::Evaluate(arguments)) => evaluate::run(&arguments, output),
        Some(Command::Emulate(arguments)) => emulate::run(&arguments, output),
    }
}
