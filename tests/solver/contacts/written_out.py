"""The distance of states by its definition, with nothing of the module under test."""

from collections.abc import Sequence

import numpy as np
from holdfast.solver import State
from scipy.spatial.transform import Rotation

# A shift of the object by so much weighs as much as a turn by one radian.
SHIFT_M = 0.1


def distances_written_out(a: State, others: Sequence[State]) -> np.ndarray:
    """From one to each (n,): the largest of joint difference (rad), turn (rad) and shift / 0.1 m."""
    if not others:
        return np.zeros(0)
    joints = np.abs(np.array([b.q for b in others]) - a.q).max(axis=1, initial=0.0)
    turns = Rotation.from_matrix(a.R_palm_object).inv() * Rotation.from_matrix(
        [b.R_palm_object for b in others]
    )
    shifts = np.linalg.norm(np.array([b.p_palm_object for b in others]) - a.p_palm_object, axis=1) / SHIFT_M
    return np.max([joints, turns.magnitude(), shifts], axis=0)


def distance_written_out(a: State, b: State) -> float:
    """From one to one."""
    return float(distances_written_out(a, [b])[0])
