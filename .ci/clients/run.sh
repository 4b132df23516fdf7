#!/usr/bin/env bash
# Clients that were not written here fly the emulated drone. Installs them into a temporary folder.
# Needs Rust, python3 with venv, and npm; a client whose installer is missing is skipped with a line that says so.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
cd "$here/../.."
work="$(mktemp -d)"
address=127.0.0.2
port=18889
emulator=""
cleanup() { [ -z "$emulator" ] || kill "$emulator" 2>/dev/null || true; rm -rf "$work"; }
trap cleanup EXIT

cargo build --quiet -p tello-sdk --example emulator
binary="${CARGO_TARGET_DIR:-target}/debug/examples/emulator"

# fly NAME COMMAND...: a fresh drone, the client with a time limit.
passed=0 failed=0 skipped=0
fly() {
    local name="$1"
    shift
    "$binary" "$address" "$port" 1 2.0 ideal fast >"$work/emulator.log" 2>&1 &
    emulator=$!
    if timeout 90 "$@" >"$work/client.log" 2>&1; then
        passed=$((passed + 1))
        tail -n 1 "$work/client.log"
    else
        failed=$((failed + 1))
        echo "$name: FAILED"
        tail -n 40 "$work/client.log"
    fi
    kill "$emulator" && wait "$emulator" 2>/dev/null || true
    emulator=""
}

if python3 -m venv "$work/venv" 2>/dev/null; then
    "$work/venv/bin/pip" install --quiet djitellopy==2.5.0 easytello==0.0.7 tello-asyncio==2.1.3
    for client in djitellopy easytello tello_asyncio; do
        fly "$client" "$work/venv/bin/python" "$here/fly_$client.py" "$address" "$port"
    done
else
    skipped=$((skipped + 3))
    echo "python3 venv is not available: three clients skipped"
fi
if command -v npm >/dev/null; then
    npm install --silent --no-fund --no-audit --prefix "$work" tello-drone@3.0.4
    fly tello-drone node "$here/fly_tello_drone.js" "$address" "$port" "$work/node_modules"
else
    skipped=$((skipped + 1))
    echo "npm is not available: one client skipped"
fi
echo "clients: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
