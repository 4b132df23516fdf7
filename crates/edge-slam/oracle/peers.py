"""ORB and Canny of ours, OpenCV and kornia on the same pixels, in one run.

usage: peers.py PROGRAMS KORNIA SEVEN_SCENES_FOLDER TUM_FOLDER   (needs numpy and opencv-python-headless)
PROGRAMS: the folder with oracle_orb and oracle_canny; KORNIA: the program of oracle/kornia.
Image by image every extractor has its turn, so that whatever else the machine does meets all of them. Times are those of one thread on
the processor: the mean of ten runs of ORB and fifty of Canny after a first one, then the median over the images.
"""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

import orb

cv2.setNumThreads(1)


def lossless(frames, folder):
    """The grey pictures as PNG: JPEG decoders differ by a grey level here and there."""
    for index, frame in enumerate(frames):
        path = Path(folder) / f"{index:04}.png"
        cv2.imwrite(str(path), cv2.imread(str(frame[0]), cv2.IMREAD_GRAYSCALE))
        yield path


def extractors(programs, kornia):
    def by(command, selection):
        def extract(path):
            (features,), (micros,) = orb.ours(command, selection, [path])
            return features, micros

        return extract

    own = [f"{programs}/oracle_orb"]
    selections = {f"ours ({name})": by(own, name) for name in ("strongest", "balanced", "spread")}
    return selections | {"OpenCV": orb.opencv, "kornia": by([kornia, "orb"], "kornia")}


def compare_orb(name, frames, paths, camera, programs, kornia):
    runs = {who: ([], []) for who in extractors(programs, kornia)}
    for path in paths:
        for who, extract in extractors(programs, kornia).items():
            for kept, new in zip(runs[who], extract(path)):
                kept.append(new)
    for gap in (1, 3):
        pairs = [(i, i + gap) for i in range(len(frames) - gap)]
        for who, (features, micros) in runs.items():
            repeat, inlier, count = orb.score(features, frames, pairs, *camera)
            print(
                f"ORB, {name}, {5 * gap} frames apart, {who}: repeatability {repeat:.3f}, inlier ratio {inlier:.3f}, inliers {count:.0f}, "
                f"median ms {np.median(micros) / 1e3:.2f}, keypoints {np.mean([len(f[0]) for f in features]):.0f}",
                flush=True,
            )


def by_program(command, settings, path, scratch):
    words = [*command, *map(str, settings), str(scratch), str(path)]
    micros = float(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    return cv2.imread(f"{scratch}/0000.pgm", cv2.IMREAD_GRAYSCALE), micros


def by_opencv(settings, path):
    norm, low, high = settings
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    edges = cv2.Canny(image, low, high, L2gradient=norm == "l2")
    start = time.thread_time()
    for _ in range(50):
        edges = cv2.Canny(image, low, high, L2gradient=norm == "l2")
    return edges, (time.thread_time() - start) * 2e4


def agreement(a, b):
    """Edge pixels found by both over those found by either."""
    return ((a > 0) & (b > 0)).sum() / max(1, ((a > 0) | (b > 0)).sum())


def compare_canny(paths, programs, kornia, scratch):
    for settings in (("l1", 50, 150), ("l1", 100, 200), ("l2", 50, 150)):
        micros, alike = [], []
        for path in paths:
            ours, t0 = by_program([f"{programs}/oracle_canny"], settings, path, scratch)
            theirs, t1 = by_opencv(settings, path)
            other, t2 = by_program([kornia, "canny"], settings, path, scratch)
            micros.append((t0, t1, t2))
            alike.append((agreement(ours, theirs), agreement(other, theirs)))
        ms, least = np.median(micros, axis=0) / 1e3, np.min(alike, axis=0)
        print(
            f"Canny, {settings}, {len(paths)} images: median ms ours {ms[0]:.2f}, OpenCV {ms[1]:.2f}, kornia {ms[2]:.2f}; "
            f"least agreement with OpenCV: ours {least[0]:.4f}, kornia {least[1]:.4f}",
            flush=True,
        )


def main():
    programs, kornia, scenes, rpy = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        some = []
        for name, (frames, *camera) in {
            "7-Scenes red kitchen": orb.seven_scenes(Path(scenes)),
            "TUM fr1_rpy": orb.tum(Path(rpy)),
        }.items():
            frames = frames[::5]
            folder = Path(scratch) / name
            folder.mkdir()
            paths = list(lossless(frames, folder))
            some += paths[::4]
            compare_orb(name, frames, paths, camera, programs, kornia)
        compare_canny(some, programs, kornia, scratch)


if __name__ == "__main__":
    main()
