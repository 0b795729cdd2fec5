"""States no two of which are near each other."""

import numpy as np

from ...arrays import Array
from ...jit import compiled
from .spread import SHIFT_M
from .state import State

__all__ = ["DistinctStates"]

_LEAST_ROOM = 64


class DistinctStates:
    """Collects states, each at least so far from all others by `spread.distance`.

    Args:
        least: the distance.
    """

    def __init__(self, least: float):
        self._least = least
        self._count = 0
        self._rows = np.zeros((0, 0))

    def add(self, state: State) -> bool:
        """Keeps a state unless one is near; whether it was kept."""
        row = np.concatenate([state.q, state.p_palm_object / SHIFT_M, state.R_palm_object.ravel()])
        if self._count and _is_near_any(self._rows[: self._count], row, self._least):
            return False
        if self._count == len(self._rows):
            rows = np.zeros((max(2 * self._count, _LEAST_ROOM), len(row)))
            rows[: self._count] = self._rows.reshape(-1, len(row))
            self._rows = rows
        self._rows[self._count] = row
        self._count += 1
        return True


@compiled
def _is_near_any(rows: Array, row: Array, least: float) -> bool:
    """Whether a row (joints, position, rotation) is nearer than `least` to one of many, in each of the three.

    Most differ enough in a joint or two, so that few numbers are looked at.
    """
    position, rotation = len(row) - 12, len(row) - 9
    # A turn by an angle moves the entries of a rotation by sqrt(8) times the sine of half of it.
    longest_chord = np.sqrt(8.0) * np.sin(0.5 * min(least, np.pi))
    for k in range(len(rows)):
        near = True
        for j in range(position):
            if abs(rows[k, j] - row[j]) >= least:
                near = False
                break
        if not near:
            continue
        shift, chord = 0.0, 0.0
        for j in range(position, rotation):
            shift += (rows[k, j] - row[j]) ** 2
        for j in range(rotation, len(row)):
            chord += (rows[k, j] - row[j]) ** 2
        if np.sqrt(shift) < least and np.sqrt(chord) < longest_chord:
            return True
    return False
