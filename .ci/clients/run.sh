#!/usr/bin/env bash
# Clients that were not written here fly the emulated drone. Installs them into a temporary folder.
# Needs Rust, a C++ compiler, python3 with venv, and npm. A client whose installer is missing, or whose package registry cannot be
# reached, is skipped with a line that says so; any other failure fails the run.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
cd "$here/../.."
work="$(mktemp -d)"
address=127.0.0.2
port=18889
emulator=""
cleanup() { [ -z "$emulator" ] || kill "$emulator" 2>/dev/null || true; rm -rf "$work"; }
trap cleanup EXIT

cargo build --quiet -p explorer
target="${CARGO_TARGET_DIR:-target}/debug"

# fly NAME SDK COMMAND...: a fresh drone with a real one's timing, the client with a time limit.
passed=0 failed=0 skipped=0
fly() {
    local name="$1" sdk="$2"
    shift 2
    "$target/explorer" emulate --address "$address" --command-port "$port" --sdk "$sdk" 2>"$work/emulator.log" &
    emulator=$!
    # The drone says so when its sockets are bound.
    until grep -qs Ctrl-C "$work/emulator.log"; do kill -0 "$emulator"; done
    if timeout 90 "$@" >"$work/client.log" 2>&1; then
        passed=$((passed + 1))
        grep -aE "flown|age median" "$work/client.log" | tail -n 1
    else
        failed=$((failed + 1))
        echo "$name: FAILED"
        tail -n 40 "$work/client.log"
    fi
    kill "$emulator" && wait "$emulator" 2>/dev/null || true
    emulator=""
}

# What the installers say when the registry cannot be reached, rather than that a package is wrong.
unreachable='NewConnectionError|ConnectTimeout|ReadTimeout|Read timed out|ConnectionReset|Connection refused|Connection broken'
unreachable+='|Max retries exceeded|ProxyError|SSLError|name resolution|No route to host|Network is unreachable|Cannot connect to proxy'
unreachable+='|ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ERR_SOCKET_TIMEOUT|ENETUNREACH|EHOSTUNREACH'

# install NAME COUNT COMMAND...: 0 when installed; 1, and COUNT checks skipped, when its registry cannot be reached.
install() {
    local name="$1" count="$2"
    shift 2
    if timeout 600 "$@" >"$work/install.log" 2>&1; then
        return 0
    elif grep -aqiE "$unreachable" "$work/install.log"; then
        skipped=$((skipped + count))
        echo "$name: the package registry cannot be reached: $count checks skipped"
    else
        failed=$((failed + count))
        echo "$name: FAILED to install"
        tail -n 40 "$work/install.log"
    fi
    return 1
}

# How old is the newest decoded picture: ours here, djitellopy's on the same stream below.
cargo build --quiet -p tello-sdk --features video --example 09_video_age
fly tello-sdk-age 2.0 "$target/examples/09_video_age" "$address:$port"

if ! python3 -m venv "$work/venv" >/dev/null 2>&1; then
    skipped=$((skipped + 7))
    echo "python3 venv is not available: seven checks skipped"
elif install "the Python clients" 7 "$work/venv/bin/pip" install --disable-pip-version-check \
    djitellopy==2.5.0 easytello==0.0.7 tello-asyncio==2.1.3 tellopy==0.7.0; then
    for client in djitellopy djitellopy_video easytello tello_asyncio; do
        fly "$client" 2.0 "$work/venv/bin/python" "$here/fly_$client.py" "$address" "$port"
    done
    fly djitellopy-age 2.0 "$work/venv/bin/python" "$here/age_djitellopy.py" "$address" "$port"
    fly tellopy binary "$work/venv/bin/python" "$here/fly_tellopy.py" "$address" "$port"
    # The other way round: our client flies tellopy's own drone (the emulator just runs beside it).
    cargo build --quiet -p tello-sdk --example 04_binary_flight
    fly tellopy-fake-drone binary "$work/venv/bin/python" "$here/serve_tellopy_fake.py" \
        "$target/examples/04_binary_flight"
fi
if ! command -v npm >/dev/null; then
    skipped=$((skipped + 1))
    echo "npm is not available: one client skipped"
elif install tello-drone 1 npm install --no-fund --no-audit --prefix "$work" tello-drone@3.0.4; then
    fly tello-drone 2.0 node "$here/fly_tello_drone.js" "$address" "$port" "$work/node_modules"
fi
echo "clients: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
