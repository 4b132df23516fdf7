#!/usr/bin/env bash
# Any bytes on any port of the drone's protocols, and in any file that edge-slam reads: each fuzz target for 60 seconds (or the number
# given), where nightly Rust is present; cargo-fuzz is installed when it is missing. The properties of the same parsers run in the ordinary
# tests in any case. Left out: edge-slam's target `network`, which takes minutes to build; by hand, in crates/edge-slam:
#     cargo +nightly fuzz run --dev --sanitizer none --features depth-onnx network
# Two minutes that way. Optimised and with the address sanitizer (without the two options) one of its dependencies alone takes several.
set -euo pipefail
crates="$(cd "$(dirname "$0")/../crates" && pwd)"
seconds="${1:-60}"
if ! cargo +nightly --version >/dev/null 2>&1; then
    echo "fuzz: nightly Rust is not installed: seven targets skipped"
    exit 0
fi
if ! cargo fuzz --version >/dev/null 2>&1 && ! cargo install --quiet --locked cargo-fuzz; then
    echo "fuzz: cargo-fuzz is not installed and cannot be fetched: seven targets skipped"
    exit 0
fi
fuzz() {
    cd "$crates/$1"
    shift
    cargo +nightly fuzz build
    for target in "$@"; do
        mkdir -p "fuzz/corpus/$target"
        # Valid inputs to start from, where no chance would find any.
        folders=("fuzz/corpus/$target")
        if [ -d "fuzz/seeds/$target" ]; then
            folders+=("fuzz/seeds/$target")
        fi
        cargo +nightly fuzz run "$target" "${folders[@]}" -- \
            -max_total_time="$seconds" -max_len=4096 -rss_limit_mb=512 -print_final_stats=1 2>&1 |
            grep -aE "^Done|panicked|ERROR|peak_rss|SUMMARY" | sed "s/^/$target: /"
    done
}
fuzz tello-sdk reply state video binary
fuzz edge-slam folder picture trajectory
