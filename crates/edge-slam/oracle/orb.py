"""Repeatability and match inlier ratio of ORB features on real sequences with depth and poses (needs numpy and opencv-python-headless).

Each pair of frames (i, i + gap): keypoints of the first with known depth are moved into the second by the true pose;
a keypoint repeats when the second image has one within 3 px, a match is an inlier when it lands within 4 px.
"""
import subprocess
import time

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


def ours(command, selection, paths):
    """By a program that prints as `orb.rs` does."""
    out = subprocess.run([*command, selection, str(COUNT), *map(str, paths)], capture_output=True, text=True, check=True).stdout
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


def opencv(path):
    """Keypoints and descriptors, and microseconds of this thread: the mean of ten after a first one."""
    detector, image = cv2.ORB_create(COUNT), cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    keypoints, descriptors = detector.detectAndCompute(image, None)
    start = time.thread_time()
    for _ in range(10):
        keypoints, descriptors = detector.detectAndCompute(image, None)
    return (np.array([k.pt for k in keypoints]), descriptors), (time.thread_time() - start) * 1e5


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
