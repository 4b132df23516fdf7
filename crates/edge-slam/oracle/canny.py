"""Pixel agreement and time of our Canny against OpenCV's at equal thresholds (needs opencv-python-headless).

usage: canny.py CANNY_BINARY SCRATCH_FOLDER IMAGE...
Agreement: edge pixels found by both over those found by either (intersection over union).
"""
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np

cv2.setNumThreads(1)
binary, scratch, images = sys.argv[1], Path(sys.argv[2]), sys.argv[3:]
scratch.mkdir(parents=True, exist_ok=True)
# JPEG decoders differ by a grey level here and there: both sides get the same lossless pixels.
for index, path in enumerate(images):
    images[index] = str(scratch / f"{index:04}.png")
    cv2.imwrite(images[index], cv2.imread(path, cv2.IMREAD_GRAYSCALE))
for norm, low, high in (("l1", 50, 150), ("l1", 100, 200), ("l2", 50, 150)):
    out = subprocess.run(
        [binary, norm, str(low), str(high), str(scratch), *images], capture_output=True, text=True, check=True
    ).stdout
    ours = [float(line) for line in out.split()]
    theirs, agreement = [], []
    for index, path in enumerate(images):
        image = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
        best = 1e9
        for _ in range(5):
            start = time.thread_time()
            edges = cv2.Canny(image, low, high, L2gradient=norm == "l2")
            best = min(best, time.thread_time() - start)
        theirs.append(best * 1e6)
        mine = cv2.imread(str(scratch / f"{index:04}.pgm"), cv2.IMREAD_GRAYSCALE)
        agreement.append(((mine > 0) & (edges > 0)).sum() / max(1, ((mine > 0) | (edges > 0)).sum()))
    print(
        f"{norm} {low}/{high}: agreement mean {np.mean(agreement):.4f} min {np.min(agreement):.4f}, "
        f"median ms ours {np.median(ours) / 1e3:.2f} OpenCV {np.median(theirs) / 1e3:.2f}"
    )
