#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
"""Two cars, ten simulated drives each: every drive alone, and all drives of a car together.

    python3 solve_fleet.py [SCHEDULER]     SCHEDULER: tcp://head:8786; without it on this machine
"""
import pathlib
import subprocess
import sys
import tempfile

import egocal.fleet


def main():
    with tempfile.TemporaryDirectory() as folder:
        drives = []
        for seed in range(20):
            drive = pathlib.Path(folder) / str(seed)
            subprocess.run(["egocal", "simulate", "--out", drive, "--poses", "600", "--noise", "0.01", "--roughness", "0.3",
                            "--seed", str(seed + 1)], check=True)
            drives.append({"rig": f"car {seed % 2 + 1}", "a": f"{drive}/lidar.tum", "b": f"{drive}/camera.tum"})
        answers = egocal.fleet.solve(drives, scheduler=sys.argv[1] if len(sys.argv) > 1 else None)
        for row in answers:
            print(f"{row['rig']}  {row['verdict']:<12} x {100 * row['x']:7.2f} +- {100 * row['stddev_x']:.2f} cm")
        for row in egocal.fleet.pool(answers):
            print(f"{row['rig']}, {row['used']} drives together: x {100 * row['x']:7.2f} +- {100 * row['stddev_x']:.2f} cm")


if __name__ == "__main__":
    main()
