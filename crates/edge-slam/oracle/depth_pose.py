"""Relative poses of frames with depth, from their depth images alone: to check recorded poses, and to measure against.

Point-to-plane alignment (Chen & Medioni 1991) with projective association, Cauchy's loss, residuals weighted by a
Kinect's noise, which grows with the square of the depth (Khoshelham & Elberink 2012). No colour image has a part in it.
"""
from functools import lru_cache

import cv2
import numpy as np

STEP, EVERY, ROUNDS = 4, 4, 25



@lru_cache(maxsize=80)
def surface(path, unit, focal, cx, cy):
    """Points and normals of a depth image, NaN where there are none, 4 m and beyond included."""
    depth = cv2.imread(path, cv2.IMREAD_UNCHANGED).astype(np.float32)
    depth[(depth == 0) | (depth == 65535) | (depth > 4 * unit)] = np.nan
    depth /= unit
    u, v = np.meshgrid(np.arange(depth.shape[1]), np.arange(depth.shape[0]))
    points = np.dstack([(u - cx) / focal * depth, (v - cy) / focal * depth, depth])
    across, down = np.full_like(points, np.nan), np.full_like(points, np.nan)
    across[:, STEP:-STEP] = points[:, 2 * STEP :] - points[:, : -2 * STEP]
    down[STEP:-STEP] = points[2 * STEP :] - points[: -2 * STEP]
    normals = np.cross(across, down)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    for side in (across, down):
        normals[np.linalg.norm(side, axis=2) > 0.1 * depth] = np.nan
    return points.astype(np.float32), normals.astype(np.float32)


def associate(points, target, normals, motion, focal, cx, cy):
    moved = points @ motion[:3, :3].T + motion[:3, 3]
    z = moved[:, 2]
    with np.errstate(all="ignore"):
        u, v = np.round(focal * moved[:, 0] / z + cx), np.round(focal * moved[:, 1] / z + cy)
        seen = (z > 0.2) & (u >= 0) & (u < target.shape[1]) & (v >= 0) & (v < target.shape[0])
    u, v, moved = u[seen].astype(int), v[seen].astype(int), moved[seen].astype(float)
    q, n = target[v, u].astype(float), normals[v, u].astype(float)
    good = np.isfinite(q).all(axis=1) & np.isfinite(n).all(axis=1)
    return moved[good], q[good], n[good]


def align(first, second, motion, focal=585.0, cx=320.0, cy=240.0):
    """The motion that takes the first frame's points to the second's, from a near guess.

    Also the median distances to the surface, metres, under the guess and at the end (each of its own associations).
    Frames: (image path, depth path, depth units a metre, pose).
    """
    points, _ = surface(str(first[1]), first[2], focal, cx, cy)
    target, normals = surface(str(second[1]), second[2], focal, cx, cy)
    points = points[::EVERY, ::EVERY].reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)]
    medians = []
    for k in range(ROUNDS):
        moved, q, n = associate(points, target, normals, motion, focal, cx, cy)
        distance = ((moved - q) * n).sum(axis=1)
        depth = q[:, 2]
        near = abs(distance) < (0.06 if k < 8 else 0.03) * np.maximum(1, depth / 2)
        moved, n, distance = moved[near], n[near], distance[near]
        medians.append(np.median(abs(distance)))
        sigma = 0.002 + 0.0015 * depth[near] ** 2
        weight = 1 / sigma**2 / (1 + (distance / (2 * sigma)) ** 2)
        slopes = np.hstack([np.cross(moved, n), n])
        step = -np.linalg.solve((slopes.T * weight) @ slopes, (slopes.T * weight) @ distance)
        turn = np.eye(4)
        turn[:3, :3] = cv2.Rodrigues(step[:3])[0]
        turn[:3, 3] = step[3:]
        motion = turn @ motion
        if abs(step).max() < 1e-6:
            break
    return motion, medians[0], medians[-1]
