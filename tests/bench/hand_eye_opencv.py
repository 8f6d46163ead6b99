#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
"""egocal.calibrate_hand_eye() beside the five methods of cv2.calibrateHandEye, on the same simulated sets.

    PYTHONPATH=build/python /usr/bin/python3 tests/bench/hand_eye_opencv.py [--trials 500] [--samples 3 5 10 ...]

The arm is that of tests/support/arm_samples.hpp: a camera on the hand, 0.4 to 0.8 m from a target, in a cone of 45 or 20
degrees; the noise of the robot is a fifth of the camera's. Needs python3-opencv, which nothing else does."""
import argparse
import sys
import time
import warnings

import numpy as np

import egocal

try:
    import cv2
except ImportError:
    sys.exit("hand_eye_opencv: cv2 is missing (Debian: python3-opencv); there is nothing to compare with")

METHODS = {name: getattr(cv2, "CALIB_HAND_EYE_" + name) for name in ("TSAI", "PARK", "HORAUD", "ANDREFF", "DANIILIDIS")}
NOISES = [(0.05, 5), (0.1, 1), (0.3, 2), (1, 5)]  # [deg], [mm]


def rotation(vector):
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K)


def pose(R, t):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T


def inverse(T):
    return pose(T[:3, :3].T, -T[:3, :3].T @ T[:3, 3])


def direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def noisy(T, degrees, millimetres, rng):
    return pose(rotation(np.radians(degrees) * rng.normal(size=3)) @ T[:3, :3],
                T[:3, 3] + 1e-3 * millimetres * rng.normal(size=3))


def looking_along(z):
    """A rotation whose third column is z."""
    x = np.cross([0, 1, 0] if abs(z[1]) < 0.9 else [1, 0, 0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def simulate(n, cone, degrees, millimetres, rng, robot=0.2):
    X = pose(rotation(rng.uniform(0, np.pi) * direction(rng)), rng.uniform(-0.1, 0.1, 3))
    Y = pose(rotation(rng.uniform(0, np.pi) * direction(rng)), rng.uniform(-0.8, 0.8, 3))
    hands, targets = [], []
    for _ in range(n):
        cosine = rng.uniform(np.cos(np.radians(cone)), 1)
        sine, around = np.sqrt(1 - cosine * cosine), rng.uniform(0, 2 * np.pi)
        to_camera = np.array([sine * np.cos(around), sine * np.sin(around), cosine])
        R = looking_along(-to_camera) @ rotation([0, 0, np.radians(rng.uniform(-60, 60))])
        eye = pose(R @ rotation(np.radians(3) * rng.normal(size=3)), rng.uniform(0.4, 0.8) * to_camera)
        hands.append(noisy(Y @ eye @ inverse(X), robot * degrees, robot * millimetres, rng))
        targets.append(noisy(inverse(eye), degrees, millimetres, rng))
    hands, targets = np.array(hands), np.array(targets)
    return X, (hands[:, :3, :3], hands[:, :3, 3], targets[:, :3, :3], targets[:, :3, 3])


def errors(X, R, t):
    """[deg], [mm]; a method that fails has an endless error."""
    if not (np.isfinite(R).all() and np.isfinite(t).all()):
        return np.inf, np.inf
    cosine = (np.trace(X[:3, :3].T @ R) - 1) / 2
    sine = np.linalg.norm(X[:3, :3].T @ R - R.T @ X[:3, :3]) / np.sqrt(8)
    return np.degrees(np.arctan2(sine, cosine)), 1e3 * np.linalg.norm(np.ravel(t) - X[:3, 3])


def solve_all(X, data):
    """Errors of egocal and of each method, and the seconds that each took."""
    found, seconds = [], []
    lists = [list(part) for part in data]
    for name in ["egocal", *METHODS]:
        begin = time.process_time()
        try:
            if name == "egocal":
                R, t = egocal.calibrate_hand_eye(*data)
            else:
                R, t = cv2.calibrateHandEye(*lists, method=METHODS[name])
            found.append(errors(X, R, t))
        except cv2.error:
            found.append((np.inf, np.inf))
        seconds.append(time.process_time() - begin)
    return found, seconds


def main():
    warnings.simplefilter("ignore", egocal.EgocalWarning)  # few samples are incomplete in most trials
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=int, default=500, help="per cell")
    parser.add_argument("--samples", type=int, nargs="+", default=[3, 4, 5, 6, 8, 10, 15, 20, 30, 60])
    parser.add_argument("--time", type=int, metavar="N", help="only the time of each method on N samples, median of --trials")
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    rng = np.random.default_rng(1)
    if arguments.time:
        times = [solve_all(*simulate(arguments.time, 45, 0.1, 1, rng))[1] for _ in range(arguments.trials)]
        for name, seconds in zip(["egocal", *METHODS], np.median(times, axis=0)):
            print(f"{name:<11} {1e3 * seconds:9.3f} ms")
        return
    print(f"egocal {egocal.__version__}, OpenCV {cv2.__version__}, {arguments.trials} trials a cell; ratio: egocal to the best of five")
    worst, above, cells = [0.0, 0.0], [0, 0], 0
    for n in arguments.samples:
        for cone in (45, 20):
            for degrees, millimetres in NOISES:
                found = np.array([solve_all(*simulate(n, cone, degrees, millimetres, rng))[0] for _ in range(arguments.trials)])
                for which, unit in enumerate(("deg", "mm")):
                    ratios = []
                    for part in (0.5, 0.95):
                        quantile = np.quantile(found[:, :, which], part, axis=0, method="lower")
                        ratios.append(quantile[0] / quantile[1:].min())
                    medians = np.median(found[:, :, which], axis=0)
                    print(f"{n:3} {cone:3} {degrees:5g} deg {millimetres} mm  " + " ".join(f"{value:9.3f}" for value in medians) +
                          f" {unit:3}  {ratios[0]:5.2f} {ratios[1]:5.2f}", flush=True)
                    cells += 1
                    for i, limit in enumerate((1.03, 1.0)):
                        worst[i] = max(worst[i], ratios[i])
                        above[i] += ratios[i] > limit
    print(f"{cells} cells: medians above 1.03 of the best in {above[0]}, largest {worst[0]:.2f}; "
          f"95 % errors above the best in {above[1]}, largest {worst[1]:.2f}")


if __name__ == "__main__":
    main()
