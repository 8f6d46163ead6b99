# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
"""Many drives of many rigs, on Dask: a map over the drives and a sum over each rig (docs/fleet.md).

    python3 -m egocal.fleet drives.csv --out answers.csv --pooled rigs.csv [--scheduler tcp://head:8786]
"""
import argparse
import csv
import math
import os
import sys

import numpy as np

import egocal
from egocal._egocal import solve_quietly

#: Least number of drives of a rig whose spread is a standard deviation: the spread of four is off by a factor of two in one case of ten.
LEAST_DRIVES = 5
DIRECTIONS = ("x", "y", "z", "roll", "pitch", "yaw")
POSE = ("x", "y", "z", "qw", "qx", "qy", "qz")


def solve_drive(drive, options):
    """One row: the columns of the drive, its answer, and its statistics; or an error."""
    row = dict(drive, error="")
    try:
        calibration = solve_quietly(drive["a"], drive["b"], **options)
    except (egocal.Error, ValueError, KeyError) as error:
        row["error"] = f"{type(error).__name__}: {error}"
        return row
    row.update(verdict=calibration.verdict, reason=calibration.reason, notes="; ".join(calibration.notes))
    row.update(certified=calibration.certified, pairs=calibration.pairs, stride=calibration.stride,
               weight_rotation=calibration.weights[0], weight_translation=calibration.weights[1])
    row.update(zip(POSE, (*calibration.translation.tolist(), *calibration.rotation_wxyz.tolist())))
    row.update(zip((f"stddev_{name}" for name in DIRECTIONS), calibration.stddev.tolist()))
    row["statistics"] = calibration.statistics
    return row


def _client(scheduler, workers):
    try:
        import distributed
    except ImportError as error:
        raise ImportError("egocal.fleet needs Dask: the Debian packages python3-dask and python3-distributed") from error
    if scheduler:
        return distributed.Client(scheduler)
    if workers is not None and workers < 1:
        raise ValueError(f"workers: expected 1 or more, got {workers}")  # Dask would wait for ever
    return distributed.Client(n_workers=workers, threads_per_worker=1, dashboard_address=None)


def solve(drives, scheduler=None, workers=None, progress=None, **options):
    """One row of answers for each drive, in the order of the drives.

    drives: dicts with `a` and `b` (files as egocal.solve takes them), `rig`, and any more columns.
    scheduler: address of a Dask cluster; None: `workers` processes on this machine (None: as many as cores).
    progress: called with the numbers of drives done and of all.
    options: those of egocal.solve.

    A worker that dies costs nothing: its drives are solved by another one.
    """
    import distributed
    drives = list(drives)
    rows = [None] * len(drives)
    with _client(scheduler, workers) as client:
        futures = client.map(solve_drive, drives, [options] * len(drives), pure=False)
        places = {future.key: place for place, future in enumerate(futures)}
        for done, (future, row) in enumerate(distributed.as_completed(futures, with_results=True), 1):
            rows[places[future.key]] = row
            if progress:
                progress(done, len(drives))
    return rows


def _rotation_vector(R):
    """(3,) [rad] of a rotation matrix below half a turn."""
    vector = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = np.linalg.norm(vector)
    if sine < 1e-12:
        return vector
    return vector / sine * math.atan2(sine, 0.5 * (np.trace(R) - 1))


def _quaternion(R):
    """(4,) w x y z of a rotation matrix, w >= 0."""
    K = np.array([[R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
                  [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
                  [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], 0],
                  [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], np.trace(R)]])
    x, y, z, w = np.linalg.eigh(K)[1][:, -1]
    return (-1 if w < 0 else 1) * np.array([w, x, y, z])


def _information(row):
    """(8, 8): the cost matrix of a drive over the variance of its residuals. Drives choose their own strides and weights, so their statistics are of
    different scale; over the variance they are comparable, and add up.
    """
    Q = row["statistics"].cost_matrix(row["weight_rotation"], row["weight_translation"])
    residual = egocal.verify(Q, egocal.solve_dual(Q))["cost"]
    least = 1e-12 * np.trace(Q)  # drives without noise
    return row["pairs"] / max(residual, least) * Q


def _answer(parts):
    """The extrinsic of the summed cost, and whether it is proven optimal."""
    Q = sum(parts) / len(parts)
    Q = Q * (8 / np.trace(Q))  # of the size of one drive's
    T = egocal.solve_dual(Q)
    return T, egocal.verify(Q, T)["certified"]


def _spread(T, others):
    """(6,) jack-knife standard deviation in the frame of a [m, rad]: each of `others` lacks one drive."""
    off = np.array([np.concatenate([X[:3, 3] - T[:3, 3], _rotation_vector(X[:3, :3] @ T[:3, :3].T)]) for X in others])
    n = len(others)
    return np.sqrt((n - 1) / n * ((off - off.mean(axis=0))**2).sum(axis=0))


def pool(answers):
    """One row a rig from the rows of solve(): the extrinsic of all its drives together, with proof.

    Drives with an error, or whose motions contradict each other, are not used, and counted. Each drive counts by its motions over the variance of their
    residuals. Standard deviations are the jack-knife over drives; they are empty for fewer than five.
    """
    rigs = {}
    for row in answers:
        rigs.setdefault(row.get("rig", ""), []).append(row)
    pooled = []
    for rig, rows in rigs.items():
        used = [row for row in rows if not row["error"] and row["verdict"] != "contradictory"]
        result = {"rig": rig, "drives": len(rows), "used": len(used)}
        pooled.append(result)
        if not used:
            continue
        parts = [_information(row) for row in used]
        T, certified = _answer(parts)
        result.update(certified=certified, pairs=sum(row["pairs"] for row in used))
        result.update(zip(POSE, (*T[:3, 3].tolist(), *_quaternion(T[:3, :3]).tolist())))
        if len(used) >= LEAST_DRIVES:
            without = [_answer(parts[:i] + parts[i + 1:])[0] for i in range(len(parts))]
            result.update(zip((f"stddev_{name}" for name in DIRECTIONS), _spread(T, without).tolist()))
    return pooled


def read_table(file):
    with open(file, newline="", encoding="utf-8-sig") as stream:
        try:
            rows = list(csv.DictReader(stream))
        except (csv.Error, UnicodeDecodeError) as error:
            raise ValueError(f"{file}: is no table of drives: {error}") from error
    for number, row in enumerate(rows, 2):
        for column in ("a", "b"):
            if not row.get(column):
                raise ValueError(f"{file}:{number}: no {column}")
    if not rows:
        raise ValueError(f"{file}: no drive in it")
    return rows


def write_table(file, rows):
    """csv, or Parquet where the name ends in .parquet (needs pandas and pyarrow)."""
    columns = list(dict.fromkeys(name for row in rows for name in row if name != "statistics"))
    plain = [{name: row.get(name, "") for name in columns} for row in rows]
    if str(file).endswith(".parquet"):
        import pandas
        pandas.DataFrame([{name: row.get(name) for name in columns} for row in rows]).to_parquet(file)
        return
    in_place = os.path.exists(file) and not os.path.isfile(file)  # a pipe or a device
    target = file if in_place else f"{os.path.realpath(file)}.{os.getpid()}.part"
    try:
        with open(target, "w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, columns)
            writer.writeheader()
            writer.writerows(plain)
        if not in_place:
            os.replace(target, os.path.realpath(file))
    except OSError as error:
        if not in_place and os.path.exists(target):
            os.remove(target)
        raise OSError(f"{file}: cannot be written: {error.strerror}") from error


def require_writable(*files):
    """Says before the work, not after it, that a table cannot be written."""
    for file in filter(None, files):
        folder = os.path.dirname(os.path.realpath(file))
        if os.path.isdir(file) or not os.path.isdir(folder) or not os.access(folder, os.W_OK):
            why = "it is a folder" if os.path.isdir(file) else f"{folder} is no folder that can be written to"
            raise OSError(f"{file}: cannot be written: {why}")


def require_parquet(*files):
    """Says before the work, not after it, that a .parquet file cannot be written here."""
    if not any(str(file).endswith(".parquet") for file in files if file):
        return
    try:
        import pandas  # noqa: F401
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise ImportError(f".parquet needs pandas and pyarrow ({error}); Debian 12 has no pyarrow: use .csv") from error


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="egocal.fleet", description="many drives of many rigs, on Dask")
    parser.add_argument("drives", help="csv with the columns rig, a, b and any more")
    parser.add_argument("--out", required=True, help="one row a drive: .csv or .parquet")
    parser.add_argument("--pooled", help="one row a rig: .csv or .parquet")
    parser.add_argument("--scheduler", help="address of a Dask cluster; without it this machine")
    parser.add_argument("--workers", type=int, help="on this machine")
    asked = parser.parse_args(arguments)

    def progress(done, total):
        if sys.stderr.isatty():
            print(f"\r{done} of {total} drives", end="\n" if done == total else "", file=sys.stderr, flush=True)

    try:
        require_parquet(asked.out, asked.pooled)
        require_writable(asked.out, asked.pooled)
        answers = solve(read_table(asked.drives), asked.scheduler, asked.workers, progress)
        write_table(asked.out, answers)
        if asked.pooled:
            write_table(asked.pooled, pool(answers))
    except (OSError, ValueError, ImportError) as error:
        print(f"egocal.fleet: {error}", file=sys.stderr)
        return 1
    failed = sum(bool(row["error"]) for row in answers)
    if failed:
        print(f"egocal.fleet: {failed} of {len(answers)} drives have no answer: see the column error", file=sys.stderr)
    return 1 if failed == len(answers) else 0


if __name__ == "__main__":
    # workers get functions by the name of their module, and would look for these in a __main__ of their own
    from egocal import fleet

    sys.exit(fleet.main())
