# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
"""Where sensors sit relative to each other, from their motions alone, with proof.

    import egocal
    calibration = egocal.solve("lidar.tum", "camera.tum")
    calibration.verdict, calibration.T_a_b, calibration.stddev

An answer that is not good gives an EgocalWarning with the verdict and its reason, and so do data that were
repaired or lost while reading, and what is wrong for certain although the verdict is good. To stop there instead: warnings.simplefilter("error", egocal.EgocalWarning).
"""
import json as _json
import math as _math

from . import _egocal
from ._egocal import Calibration, EgocalWarning, Error, Statistics, __version__  # noqa: F401

__all__ = ["Calibration", "EgocalWarning", "Error", "Statistics", "calibrate_hand_eye", "solve", "solve_dual", "verify"]


# Functions of Python: pickle takes them (multiprocessing), and a name that is misspelt is a line of Python instead of several of pybind11.


def solve(a, b, *, method="global", plane_a=None, plane_b=None, stride=None, weights="auto", time_offset=0.0, max_gap=0.5,
          nominal=None):
    return _egocal.solve(a, b, method=method, plane_a=plane_a, plane_b=plane_b, stride=stride, weights=weights, time_offset=time_offset,
                         max_gap=max_gap, nominal=nominal)


def calibrate_hand_eye(R_gripper2base, t_gripper2base, R_target2cam, t_target2cam, *, details=False):
    return _egocal.calibrate_hand_eye(R_gripper2base, t_gripper2base, R_target2cam, t_target2cam, details=details)


def solve_dual(Q):
    return _egocal.solve_dual(Q)


def verify(Q, T_a_b):
    return _egocal.verify(Q, T_a_b)


for _function in (solve, calibrate_hand_eye, solve_dual, verify):
    _function.__doc__ = getattr(_egocal, _function.__name__).__doc__.partition("\n\n")[2]  # without pybind11's signature


def _to_dict(self):
    """The fields as plain Python values, with the names of `egocal solve --json`."""
    return {
        "verdict": self.verdict,
        "reason": self.reason,
        "findings": self.findings,
        "translation": self.translation.tolist(),
        "rotation_wxyz": self.rotation_wxyz.tolist(),
        "pairs": self.pairs,
        "cost": self.cost,
        "lower_bound": self.lower_bound,
        "gap": self.gap,
        "certified": self.certified,
        "status": self.status,
        "observable": list(self.observable),
        "stddev": self.stddev.tolist(),
        "hint": self.hint,
        "stride": self.stride,
        "weights": dict(zip(("rotation", "translation"), self.weights)),
        "time_offset_s": self.time_offset,
        "outliers": self.outliers,
        "rejected": self.rejected,
        "notes": self.notes,
    }


def _to_json(self, indent=2):
    """One JSON object; numbers that are not finite are null, as in `egocal solve --json`."""

    def finite(value):
        if isinstance(value, float) and not _math.isfinite(value):
            return None
        if isinstance(value, dict):
            return {key: finite(entry) for key, entry in value.items()}
        if isinstance(value, list):
            return [finite(entry) for entry in value]
        return value

    return _json.dumps(finite(self.to_dict()), indent=indent)


Calibration.to_dict = _to_dict
Calibration.to_json = _to_json
