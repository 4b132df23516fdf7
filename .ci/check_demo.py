"""Checks what the demo left: all files are there, and the mission covered the world without a collision."""

import json
import pathlib
import sys

folder = pathlib.Path(sys.argv[1])
for name in ("report.html", "summary.json", "map.ply"):
    size = (folder / name).stat().st_size
    assert size > 0, f"{name} is empty"
assert list(folder.glob("trajectory*")), "there is no trajectory"

summary = json.loads((folder / "summary.json").read_text())
runs = summary.get("runs") or [summary]
for run in runs:
    coverage, collisions = run["coverage"], run["collisions"]
    print(f"demo: outcome {run['outcome']}, coverage {coverage:.3f}, collisions {collisions}")
    assert coverage >= 0.90, "coverage is below 90 %"
    assert collisions == 0, "the drone touched something"
