//! Flags of `explorer emulate`.

use std::net::Ipv4Addr;

use clap::Args;
use tello_sdk::emulator::PRESETS;

#[derive(Debug, Args)]
pub(crate) struct Emulate {
    /// Address of the first drone; replies, state and video come from it. 127.0.0.1 is the clients'.
    #[arg(long, value_name = "IP", default_value = "127.0.0.2")]
    pub(crate) address: Ipv4Addr,
    /// Port that listens for commands. A drone's own is 8889, but most clients bind that one themselves,
    /// on all addresses of the machine.
    #[arg(long, value_name = "P", default_value_t = 18_889)]
    pub(crate) command_port: u16,
    /// Port of the client that state lines go to; not used by the binary protocol.
    #[arg(long, value_name = "P", default_value_t = 8890)]
    pub(crate) state_port: u16,
    /// Port of the client that video goes to; in the binary protocol the client names it.
    #[arg(long, value_name = "P", default_value_t = 11_111)]
    pub(crate) video_port: u16,
    /// How many drones, on consecutive addresses.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=250))]
    pub(crate) count: u8,
    /// What they speak: the text protocol of a version, or the binary protocol of the maker's app.
    #[arg(long, value_name = "SDK", value_parser = ["1.3", "2.0", "3.0", "rmtt", "binary"], default_value = "2.0")]
    pub(crate) sdk: String,
    #[arg(long, value_name = "PRESET", default_value = "none", value_parser = preset, help = fault_help())]
    pub(crate) faults: String,
}

fn fault_help() -> String {
    let lines: Vec<String> = PRESETS
        .iter()
        .map(|(name, meaning)| format!("  {name}: {meaning}"))
        .collect();
    format!(
        "What goes wrong, drawn from --seed:\n{}\n",
        lines.join("\n")
    )
}

fn preset(name: &str) -> Result<String, String> {
    let names: Vec<&str> = PRESETS.iter().map(|(name, _)| *name).collect();
    match names.contains(&name) {
        true => Ok(name.to_owned()),
        false => Err(format!("the presets are {}", names.join(", "))),
    }
}
