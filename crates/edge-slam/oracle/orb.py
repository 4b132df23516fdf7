"""Repeatability and match inlier ratio of our ORB against OpenCV's, on real sequences with depth and poses.

usage: orb.py ORB_BINARY SEVEN_SCENES_FOLDER TUM_FOLDER   (needs numpy and opencv-python-headless)
Each pair of frames (i, i + gap): keypoints of the first with known depth are moved into the second by the true pose;
a keypoint repeats when the second image has one within 3 px, a match is an inlier when it lands within 4 px.
"""
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np

cv2.setNumThreads(1)
COUNT = 1000


def quaternion_pose(row):
    t, q = row[:3], row[3:]
    x, y, z, w = q / np.linalg.norm(q)
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = t
    return pose


def seven_scenes(folder):
    intrinsics = np.array([[585.0, 0, 320], [0, 585.0, 240], [0, 0, 1]])
    frames = []
    for path in sorted((folder / "color").glob("*.jpg")):
        depth = folder / "depth" / (path.stem + ".png")
        frames.append((path, depth, 1000.0, np.loadtxt(folder / "pose" / (path.stem + ".txt"))))
    return frames, intrinsics, np.zeros(5)


def tum(folder):
    intrinsics = np.array([[517.306408, 0, 318.643040], [0, 516.469215, 255.313989], [0, 0, 1]])
    lens = np.array([0.262383, -0.953104, -0.005358, 0.002628, 1.163314])
    truth = np.loadtxt(folder / "groundtruth.txt")
    frames = []
    for line in (folder / "associations.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        stamp, image, _, depth = line.split()[:4]
        row = truth[np.argmin(abs(truth[:, 0] - float(stamp)))]
        image = folder / image
        if not image.exists():
            image = folder / "gray" / image.name
        frames.append((image, folder / depth, 5000.0, quaternion_pose(row[1:])))
    return frames, intrinsics, lens


def ours(binary, selection, paths):
    out = subprocess.run([binary, selection, str(COUNT), *map(str, paths)], capture_output=True, text=True, check=True).stdout
    lines = iter(out.splitlines())
    result, micros = [], []
    for line in lines:
        count = int(line.split()[1])
        micros.append(float(line.split()[3]))
        rows = [next(lines).split() for _ in range(count)]
        points = np.array([[float(r[0]), float(r[1])] for r in rows]).reshape(-1, 2)
        words = np.array([[int(w) for w in r[3:]] for r in rows], dtype=np.uint64).reshape(-1, 4)
        result.append((points, words.view(np.uint8).reshape(-1, 32)))
    return result, micros


def opencv(paths):
    orb = cv2.ORB_create(COUNT)
    result, micros = [], []
    for path in paths:
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        best = 1e9
        for _ in range(5):
            start = time.thread_time()
            keypoints, descriptors = orb.detectAndCompute(image, None)
            best = min(best, time.thread_time() - start)
        micros.append(best * 1e6)
        result.append((np.array([k.pt for k in keypoints]), descriptors))
    return result, micros


def project(points, first, second, intrinsics, lens):
    """Where the second frame shows the first one's keypoints; NaN where the depth is unknown."""
    depth = cv2.imread(str(first[1]), cv2.IMREAD_UNCHANGED).astype(float)
    depth[(depth == 0) | (depth == 65535)] = np.nan
    depth /= first[2]
    pixel = np.clip(np.round(points).astype(int), 0, [639, 479])
    z = depth[pixel[:, 1], pixel[:, 0]]
    rays = cv2.undistortPoints(points.reshape(-1, 1, 2).astype(float), intrinsics, lens).reshape(-1, 2)
    space = np.column_stack([rays * z[:, None], z, np.ones(len(z))])
    moved = (np.linalg.inv(second[3]) @ first[3] @ space.T).T[:, :3]
    moved[moved[:, 2] < 0.1] = np.nan
    good = np.isfinite(moved).all(axis=1)
    out = np.full((len(points), 2), np.nan)
    if good.any():
        out[good] = cv2.projectPoints(moved[good], np.zeros(3), np.zeros(3), intrinsics, lens)[0].reshape(-1, 2)
    out[(out < 20).any(axis=1) | (out[:, 0] > 620) | (out[:, 1] > 460)] = np.nan
    return out


def score(features, frames, pairs, intrinsics, lens):
    matcher = cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True)
    repeat, inlier, count = [], [], []
    for i, j in pairs:
        (p, d), (q, e) = features[i], features[j]
        truth = project(p, frames[i], frames[j], intrinsics, lens)
        known = np.isfinite(truth).all(axis=1)
        if known.sum() < 50:
            continue
        nearest = np.linalg.norm(truth[known][:, None] - q[None], axis=2).min(axis=1)
        repeat.append((nearest < 3).mean())
        matches = [m for m in matcher.match(d, e) if known[m.queryIdx] and m.distance <= 64]
        errors = np.array([np.linalg.norm(truth[m.queryIdx] - q[m.trainIdx]) for m in matches])
        inlier.append((errors < 4).mean())
        count.append((errors < 4).sum())
    return np.mean(repeat), np.mean(inlier), np.mean(count)


def main():
    binary = sys.argv[1]
    for name, (frames, intrinsics, lens) in {
        "7-Scenes red kitchen": seven_scenes(Path(sys.argv[2])),
        "TUM fr1_rpy": tum(Path(sys.argv[3])),
    }.items():
        frames = frames[::5]
        paths = [frame[0] for frame in frames]
        runs = [(f"ours ({s})", *ours(binary, s, paths)) for s in ("balanced", "spread", "strongest")]
        runs.append(("OpenCV", *opencv(paths)))
        for gap in (1, 3):
            pairs = [(i, i + gap) for i in range(len(frames) - gap)]
            for who, features, micros in runs:
                r, m, n = score(features, frames, pairs, intrinsics, lens)
                print(
                    f"{name}, {5 * gap} frames apart, {who}: repeatability {r:.3f}, inlier ratio {m:.3f}, "
                    f"inliers {n:.0f}, median ms {np.median(micros) / 1e3:.2f}, keypoints "
                    f"{np.mean([len(f[0]) for f in features]):.0f}"
                )


if __name__ == "__main__":
    main()
