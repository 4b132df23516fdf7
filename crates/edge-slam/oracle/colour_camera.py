"""The colour camera of a sensor whose recorded poses and intrinsics are its depth camera's: focal length, lens, and its place
beside the depth camera (hand-eye calibration, A X = X B), from matches between pairs of pictures.

A model is a dictionary: focal, cx, cy [px], k1, k2 (radial), wx, wy, wz (rotation vector), lx, ly, lz (metres) of X, which takes
points of the colour camera to the depth camera. Least squares of Sampson distances in pixels, Cauchy's loss at 0.7 px.
"""
import cv2
import numpy as np

AS_RECORDED = dict(focal=585.0, cx=320.0, cy=240.0, k1=0.0, k2=0.0, wx=0.0, wy=0.0, wz=0.0, lx=0.0, ly=0.0, lz=0.0)
STEPS = dict(focal=0.1, cx=0.1, cy=0.1, k1=1e-4, k2=1e-4, wx=1e-5, wy=1e-5, wz=1e-5, lx=1e-4, ly=1e-4, lz=1e-4)
LENS, TURN, OFFSET = ["cx", "cy", "k1", "k2"], ["wx", "wy", "wz"], ["lx", "ly", "lz"]
LOSS = 0.7


def matrix(model):
    return np.array([[model["focal"], 0, model["cx"]], [0, model["focal"], model["cy"]], [0, 0, 1.0]])


def lens(model):
    return [model["k1"], model["k2"], 0, 0, 0]


def of_colour_camera(motion, model):
    """The depth camera's motion (points of the first view to the second) as the colour camera made it."""
    place = np.eye(4)
    place[:3, :3] = cv2.Rodrigues(np.array([model[k] for k in TURN]))[0]
    place[:3, 3] = [model[k] for k in OFFSET]
    return np.linalg.inv(place) @ motion @ place


def rays(pixels, model):
    seen = (pixels - [model["cx"], model["cy"]]) / model["focal"]
    ideal = seen
    for _ in range(5):
        square = (ideal**2).sum(axis=1, keepdims=True)
        ideal = seen / (1 + model["k1"] * square + model["k2"] * square**2)
    return np.column_stack([ideal, np.ones(len(ideal))])


def sampson(matches, motion, model):
    """Distances in pixels from the colour camera's motion."""
    first, second = rays(matches[:, :2], model), rays(matches[:, 2:], model)
    x, y, z = motion[:3, 3] / np.linalg.norm(motion[:3, 3])
    essential = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ motion[:3, :3]
    line, back = first @ essential.T, second @ essential
    norm = np.sqrt(line[:, 0] ** 2 + line[:, 1] ** 2 + back[:, 0] ** 2 + back[:, 1] ** 2)
    return model["focal"] * (second * line).sum(axis=1) / norm


def fit(pairs, free, start=AS_RECORDED):
    """The model that the `pairs` (matches in pixels as seen, motion of the depth camera) ask for; `free` names what is sought."""
    model = dict(start)
    distances = lambda m: np.concatenate([sampson(matches, of_colour_camera(motion, m), m) for matches, motion in pairs])
    loss = lambda r: np.log1p((r / LOSS) ** 2).sum()
    damping, r = 1e-3, distances(model)
    for _ in range(60):
        slopes = np.array([(distances(model | {k: model[k] + STEPS[k]}) - r) / STEPS[k] for k in free])
        weights = 1 / (1 + (r / LOSS) ** 2)
        normal, gradient = (slopes * weights) @ slopes.T, (slopes * weights) @ r
        change = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), gradient)
        trial = model | {k: model[k] - step for k, step in zip(free, change)}
        moved = distances(trial)
        if loss(moved) > loss(r):
            damping *= 10
            if damping > 1e6:
                break
            continue
        model, r, damping = trial, moved, damping / 5
        if all(abs(step) < 0.1 * STEPS[k] for k, step in zip(free, change)):
            break
    return model


def fit_focal_alone(pairs):
    """The focal length that agrees best with any motions at all: `pairs` of matches and a first guess of the colour camera's motion.

    Gauss-Newton over the focal length and the five degrees of freedom of each motion; the motions are eliminated pair by pair.
    """
    model, motions = dict(AS_RECORDED), [motion for _, motion in pairs]
    for _ in range(30):
        total, pull, solved = 0.0, 0.0, []
        for (matches, _), motion in zip(pairs, motions):
            r = sampson(matches, motion, model)
            focal = (sampson(matches, motion, model | {"focal": model["focal"] + 0.1}) - r) / 0.1
            slopes = np.array([(sampson(matches, nudged(motion, 1e-5 * axis), model) - r) / 1e-5 for axis in np.eye(5)])
            weighted = slopes / (1 + (r / LOSS) ** 2)
            normal = weighted @ slopes.T + 1e-9 * np.eye(5)
            free = focal - slopes.T @ np.linalg.solve(normal, weighted @ focal)
            total += (focal / (1 + (r / LOSS) ** 2)) @ free
            pull += (r / (1 + (r / LOSS) ** 2)) @ free
            solved.append((normal, weighted @ focal, weighted @ r))
        change = np.clip(-pull / total, -10, 10)
        model["focal"] += change
        motions = [nudged(m, -np.linalg.solve(n, g + c * change)) for m, (n, c, g) in zip(motions, solved)]
        if abs(change) < 0.01:
            break
    return model


def nudged(motion, step):
    """Turned by the first three numbers, the direction of travel moved across itself by the other two."""
    t = motion[:3, 3] / np.linalg.norm(motion[:3, 3])
    b1 = np.cross(t, np.eye(3)[np.argmin(abs(t))])
    b1 /= np.linalg.norm(b1)
    result = np.eye(4)
    result[:3, :3] = cv2.Rodrigues(np.asarray(step[:3]))[0] @ motion[:3, :3]
    result[:3, 3] = t + b1 * step[3] + np.cross(t, b1) * step[4]
    result[:3, 3] /= np.linalg.norm(result[:3, 3])
    return result
