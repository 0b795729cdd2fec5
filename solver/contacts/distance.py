"""How far states are apart, one from another and one from many."""

from collections.abc import Sequence

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...geometry import rotation_angle
from .configuration import Configuration
from .state import State

__all__ = ["SHIFT_M", "DistinctStates", "distance", "nearest_neighbours", "nearest_rows", "spread_out"]

# A shift of the object by so much weighs as much as a turn by one radian.
SHIFT_M = 0.1

_LEAST_ROOM = 64


def distance(a: State, b: State) -> float:
    """How far two states are apart: the largest of joint difference (rad), turn (rad) and shift / 0.1 m."""
    joints = float(np.abs(a.q - b.q).max(initial=0.0))
    turn = rotation_angle(a.R_palm_object.T @ b.R_palm_object)
    shift = float(np.linalg.norm(a.p_palm_object - b.p_palm_object)) / SHIFT_M
    return max(joints, turn, shift)


class _Distances:
    """Distances, by `distance`, from one of many states to all of them."""

    def __init__(self, states: Sequence[State]):
        self._q = np.array([s.q for s in states])
        self._R = np.array([s.R_palm_object.ravel() for s in states])
        self._p = np.array([s.p_palm_object for s in states]) / SHIFT_M

    def of(self, k: int) -> Array:
        """From number k, (n,)."""
        chord = np.linalg.norm(self._R - self._R[k], axis=1)
        turn = 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0))
        shift = np.linalg.norm(self._p - self._p[k], axis=1)
        joints = np.abs(self._q - self._q[k]).max(axis=1, initial=0.0)
        return np.maximum(np.maximum(turn, shift), joints)


def nearest_neighbours(states: Sequence[State]) -> Array:
    """Distance (n,) from each of two or more states to the one nearest to it, by `distance`."""
    return _nearest_states(
        np.array([s.q for s in states], dtype=float),
        np.array([s.p_palm_object for s in states]) / SHIFT_M,
        np.array([s.R_palm_object.ravel() for s in states]),
    )


def nearest_rows(rows: Array) -> Array:
    """Distance (n,) from each of two or more rows (n, k) to the nearest other, by the largest difference."""
    none = np.zeros((len(rows), 0))
    return _nearest_states(rows.astype(float), none, none)


@compiled
def _nearest_states(q: Array, p: Array, R: Array) -> Array:
    """Least distances (n,) of states by joints (n, k), scaled positions (n, 3) and rotations (n, 9).

    A pair is left as soon as one of the three is no nearer than what has been found.
    """
    nearest = np.full(len(q), np.inf)
    for i in range(len(q)):
        for j in range(len(q)):
            if i == j:
                continue
            apart = 0.0
            for k in range(q.shape[1]):
                apart = max(apart, abs(q[i, k] - q[j, k]))
                if apart >= nearest[i]:
                    break
            if apart >= nearest[i]:
                continue
            apart = max(apart, np.sqrt(np.sum((p[i] - p[j]) ** 2)))
            chord = np.sqrt(np.sum((R[i] - R[j]) ** 2))
            apart = max(apart, 2.0 * np.arcsin(min(chord / np.sqrt(8.0), 1.0)))
            nearest[i] = min(nearest[i], apart)
    return nearest


def spread_out(configurations: Sequence[Configuration], count: int) -> list[Configuration]:
    """So many of the configurations, far apart: the first, then always the one farthest from those chosen."""
    if len(configurations) <= count:
        return list(configurations)
    distances = _Distances([c.state for c in configurations])
    chosen = [0]
    nearest = distances.of(0)
    while len(chosen) < count:
        chosen.append(int(np.argmax(nearest)))
        nearest = np.minimum(nearest, distances.of(chosen[-1]))
    return [configurations[k] for k in chosen]


class DistinctStates:
    """Collects states, each at least so far from all others by `distance`.

    Args:
        least: the distance.
    """

    def __init__(self, least: float):
        self._least = least
        self._count = 0
        self._rows = np.zeros((0, 0))

    def add(self, state: State) -> bool:
        """Keeps a state unless one is near; whether it was kept."""
        row = _row(state)
        if self._count and _is_near_any(self._rows[: self._count], row, self._least):
            return False
        self._keep(row)
        return True

    def keep(self, state: State) -> None:
        """Keeps a state, be others near or not."""
        self._keep(_row(state))

    def _keep(self, row: Array) -> None:
        if self._count == len(self._rows):
            rows = np.zeros((max(2 * self._count, _LEAST_ROOM), len(row)))
            rows[: self._count] = self._rows.reshape(-1, len(row))
            self._rows = rows
        self._rows[self._count] = row
        self._count += 1


def _row(state: State) -> Array:
    """The numbers of a state that distances are made of."""
    return np.concatenate([state.q, state.p_palm_object / SHIFT_M, state.R_palm_object.ravel()])


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
