"""Writes flight.tello for a recorded sequence: what a Tello would have said, SIMULATED from the true trajectory.

    python3 oracle/simulated_telemetry.py GROUNDTRUTH.txt flight.tello [SEED]

State lines at 10 Hz, rounded as the Tello does (decimetres a second, whole degrees), with velocity noise of 0.05 m/s, a constant
velocity bias of up to 0.03 m/s an axis and attitude noise of 1 degree. Up is the first camera's up. Frame times are the
recording's, so that `explorer slam SEQUENCE -o DIR --telemetry flight.tello --telemetry-start FIRST_TIME` takes them; FIRST_TIME is
printed. Needs numpy.
"""

import struct
import sys
import zlib

import numpy as np

BODY_FROM_CAMERA = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]], float)
STATE = 2


def rotation(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def record(nanoseconds, text):
    data = text.encode()
    header = struct.pack("<BBIQ", 0xA5, STATE, len(data), nanoseconds)
    return header + data + struct.pack("<I", zlib.crc32(header + data))


def main(truth, out, seed=1):
    rng = np.random.default_rng(int(seed))
    rows = np.loadtxt(truth)
    times, places = rows[:, 0], rows[:, 1:4]
    begin, end = times[0], times[-1]
    world = BODY_FROM_CAMERA @ rotation(rows[0, 4:]).T
    bias = rng.uniform(-0.03, 0.03, 3)
    with open(out, "wb") as file:
        for k in range(int((end - begin) * 10) + 1):
            now = begin + 0.1 * k
            at = lambda t: np.array([np.interp(t, times, places[:, i]) for i in range(3)])
            # The mean over the last 0.1 s, as it is integrated.
            velocity = world @ (at(now) - at(now - 0.1)) / 0.1
            turn = world @ rotation(rows[np.argmin(abs(times - now)), 4:]) @ BODY_FROM_CAMERA.T
            yaw = np.arctan2(turn[1, 0], turn[0, 0])
            pitch = -np.arcsin(np.clip(turn[2, 0], -1, 1))
            roll = np.arctan2(turn[2, 1], turn[2, 2])
            c, s = np.cos(yaw), np.sin(yaw)
            level = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ velocity
            dm = np.rint(10 * (level + bias + rng.normal(0, 0.05, 3))).astype(int)
            noisy = np.degrees([roll, pitch, yaw]) + rng.normal(0, 1, 3)
            r, p, y = np.rint(noisy).astype(int)
            y = (y + 180) % 360 - 180
            text = f"pitch:{-p};roll:{r};yaw:{-y};vgx:{dm[0]};vgy:{dm[1]};vgz:{dm[2]};bat:90;"
            file.write(record(int(round(1e8 * k)), text))
    print(begin)


main(*sys.argv[1:])
