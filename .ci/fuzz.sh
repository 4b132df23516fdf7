#!/usr/bin/env bash
# Any bytes on any port of the drone's protocols: each fuzz target for 60 seconds (or the number given), where nightly Rust is
# present; cargo-fuzz is installed when it is missing. The properties of the same parsers run in the ordinary tests in any case.
set -euo pipefail
cd "$(dirname "$0")/../crates/tello-sdk"
seconds="${1:-60}"
if ! cargo +nightly --version >/dev/null 2>&1; then
    echo "fuzz: nightly Rust is not installed: four targets skipped"
    exit 0
fi
if ! cargo fuzz --version >/dev/null 2>&1 && ! cargo install --quiet --locked cargo-fuzz; then
    echo "fuzz: cargo-fuzz is not installed and cannot be fetched: four targets skipped"
    exit 0
fi
cargo +nightly fuzz build
for target in reply state video binary; do
    cargo +nightly fuzz run "$target" -- -max_total_time="$seconds" -max_len=4096 -rss_limit_mb=512 -print_final_stats=1 2>&1 |
        grep -aE "^Done|panicked|ERROR|peak_rss|SUMMARY" | sed "s/^/$target: /"
done
