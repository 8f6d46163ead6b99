# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
from os import PathLike
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

from numpy import float64
from numpy.typing import ArrayLike, NDArray

__version__: str

Trajectory = Union[str, PathLike, ArrayLike, Tuple[ArrayLike, ArrayLike]]

class Error(RuntimeError): ...
class EgocalWarning(UserWarning): ...

class Calibration:
    T_a_b: NDArray[float64]
    T_b_a: NDArray[float64]
    translation: NDArray[float64]
    rotation_wxyz: NDArray[float64]
    verdict: str
    reason: str
    findings: List[Dict[str, Any]]
    statistics: "Statistics"
    certified: bool
    status: str
    cost: float
    lower_bound: float
    gap: float
    observable: List[bool]
    stddev: NDArray[float64]
    hint: str
    pairs: int
    outliers: int
    rejected: Dict[str, int]
    stride: int
    weights: Tuple[float, float]
    time_offset: float
    notes: List[str]
    def to_dict(self) -> Dict[str, Any]: ...
    def to_json(self, indent: Optional[int] = 2) -> str: ...

def solve(
    a: Trajectory,
    b: Trajectory,
    *,
    method: str = "global",
    plane_a: Optional[Sequence[float]] = None,
    plane_b: Optional[Sequence[float]] = None,
    stride: Optional[int] = None,
    weights: Union[str, Tuple[float, float]] = "auto",
    time_offset: Union[str, float] = 0.0,
    max_gap: float = 0.5,
    nominal: Optional[ArrayLike] = None,
) -> Calibration: ...

class Statistics:
    def __init__(self) -> None: ...
    def add(self, motion_a: ArrayLike, motion_b: ArrayLike, weight: float = 1.0) -> None: ...
    def __iadd__(self, other: "Statistics") -> "Statistics": ...
    def __add__(self, other: "Statistics") -> "Statistics": ...
    def __len__(self) -> int: ...
    def cost_matrix(self, rotation: float = 1.0, translation: float = 1.0) -> NDArray[float64]: ...

def solve_dual(Q: ArrayLike) -> NDArray[float64]: ...
def verify(Q: ArrayLike, T_a_b: ArrayLike) -> Dict[str, Any]: ...
def calibrate_hand_eye(
    R_gripper2base: Sequence[ArrayLike],
    t_gripper2base: Sequence[ArrayLike],
    R_target2cam: Sequence[ArrayLike],
    t_target2cam: Sequence[ArrayLike],
    *,
    details: bool = False,
) -> Any: ...
