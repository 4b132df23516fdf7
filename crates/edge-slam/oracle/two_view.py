"""Relative pose errors of ours against OpenCV's findEssentialMat + recoverPose on the same matches.

usage: two_view.py TWO_VIEW_BINARY SEVEN_SCENES_FOLDER TUM_FOLDER [FOCAL]   (needs numpy and opencv-python-headless)
The gates were chosen on pairs of fr1_rpy that are 3, 6 and 10 frames apart; other distances, from other frames, are held out.
"""
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

from orb import seven_scenes, tum

cv2.setNumThreads(1)


def angle(rotation):
    return np.degrees(np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1)))


def direction(a, b):
    return np.degrees(np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))


def truth(frames, i, j):
    return np.linalg.inv(frames[j][3]) @ frames[i][3]


def run(binary, frames, intrinsics, lens, pairs):
    numbers = [intrinsics[0, 0], intrinsics[1, 1], intrinsics[0, 2], intrinsics[1, 2], *lens]
    paths = [str(frames[k][0]) for pair in pairs for k in pair]
    out = subprocess.run([binary, *map(str, numbers), *paths], capture_output=True, text=True, check=True).stdout
    lines = iter(out.splitlines())
    for i, j in pairs:
        words = next(lines).split()
        motion = np.array(next(lines).split(), dtype=float).reshape(3, 4)
        matches = np.array([next(lines).split() for _ in range(int(words[1]))], dtype=float).reshape(-1, 4)
        yield i, j, float(words[3]), words[5], float(words[7]), float(words[9]), float(words[11]), motion, matches


def main():
    binary = sys.argv[1]
    frames, intrinsics, lens = seven_scenes(Path(sys.argv[2]))
    focal = float(sys.argv[4]) if len(sys.argv) > 4 else 585.0
    intrinsics[0, 0] = intrinsics[1, 1] = focal
    centres = np.array([frame[3][:3, 3] for frame in frames])
    random, pairs = np.random.default_rng(1), []
    while len(pairs) < 200:
        i = int(random.integers(0, len(frames)))
        far = np.flatnonzero(np.linalg.norm(centres[i + 1 :] - centres[i], axis=1) >= 0.15)
        if len(far):
            pairs.append((i, i + 1 + int(far[0])))
    errors, kinds, times = {"ours": [], "OpenCV": []}, Counter(), {"ours": [], "OpenCV": []}
    confident = []
    for i, j, micros, kind, _, _, _, motion, matches in run(binary, frames, intrinsics, lens, pairs):
        true = truth(frames, i, j)
        kinds[kind] += 1
        times["ours"].append(micros)
        ours = (angle(motion[:, :3].T @ true[:3, :3]), direction(motion[:, 3], true[:3, 3])) if kind not in ("None", "PureRotation") else (180, 180)
        start = time.thread_time()
        essential, mask = cv2.findEssentialMat(matches[:, :2], matches[:, 2:], intrinsics, cv2.RANSAC, 0.999, 1.0)
        good, rotation, t, _ = cv2.recoverPose(essential[:3], matches[:, :2], matches[:, 2:], intrinsics, mask=mask)
        times["OpenCV"].append((time.thread_time() - start) * 1e6)
        errors["ours"].append(ours)
        errors["OpenCV"].append((angle(rotation.T @ true[:3, :3]), direction(t[:, 0], true[:3, 3])))
        if kind == "General":
            confident.append(ours)
    for who, values in errors.items():
        values = np.array(values)
        print(f"{who}: median rotation {np.median(values[:, 0]):.3f} deg, direction {np.median(values[:, 1]):.2f} deg, "
              f"90 % {np.percentile(values[:, 0], 90):.2f} / {np.percentile(values[:, 1], 90):.1f} deg, "
              f"median ms {np.median(times[who]) / 1e3:.2f}, mean ms {np.mean(times[who]) / 1e3:.2f}")
    confident = np.array(confident)
    print("ours, kinds:", dict(kinds), "; General only: median", np.median(confident, axis=0), "95 %", np.percentile(confident, 95, axis=0))

    frames, intrinsics, lens = tum(Path(sys.argv[3]))
    chosen = [(i, i + gap) for gap in (3, 6, 10) for i in range(0, len(frames) - gap, 4)]
    held_out = [(i, i + gap) for gap in (1, 2, 4, 5, 7, 8, 9, 12, 15, 20) for i in range(2, len(frames) - gap, 6)]
    for name, pairs in (("fr1_rpy", chosen), ("fr1_rpy held out", held_out)):
        report(name, frames, run(binary, frames, intrinsics, lens, pairs))


def report(name, frames, results):
    rows = []
    for i, j, _, kind, parallax, homography, share, motion, matches in results:
        true = truth(frames, i, j)
        rows.append((np.linalg.norm(true[:3, 3]), angle(true[:3, :3]), kind, parallax, angle(motion[:, :3].T @ true[:3, :3]),
                     direction(motion[:, 3], true[:3, 3]) if np.linalg.norm(motion[:, 3]) > 0 else np.nan, homography, share))
    for low, high in ((0, 0.01), (0.01, 0.02), (0.02, 0.04), (0.04, 1)):
        group = [r for r in rows if low <= r[0] < high]
        wrong = [r for r in group if r[2] == "General" and r[5] > 30]
        print(f"{name}, true baseline {low}..{high} m: {len(group)} pairs, kinds {dict(Counter(r[2] for r in group))}, "
              f"rotation error median {np.median([r[4] for r in group]):.2f} deg, General with direction off by > 30 deg: {len(wrong)}")
        for r in wrong:
            print("   ", " ".join(f"{v:.3f}" if not isinstance(v, str) else v for v in r))


if __name__ == "__main__":
    main()
