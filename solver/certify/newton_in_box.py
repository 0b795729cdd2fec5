"""Newton's method confined to a box: from a point of its relaxation to a solution proved to lie in it.

This is branch and prune's own existence test. It starts from one point, that of the box's linear program,
never leaves the box, and says nothing where it doesn't come to rest: it is no search of its own.
"""

import numpy as np

from ...base.numeric.arrays import Array
from ..enclosure import Enclosure
from .krawczyk import ExistenceTest, ProvedBox

__all__ = ["solve_in_box"]


# Most points come to rest within ten steps or not at all; some creep along a side of the box for longer.
_MOST_STEPS = 60
# Inputs that a step pushes out of the box are held at its side, in so many rounds at most.
_MOST_ROUNDS = 6
_SETTLED = 1e-9
# Steps aim this far inside the box and its inequalities (less in narrow boxes): a proof needs some room.
_ROOM = 1e-6
# A box that propagation has narrowed to a few roundings around the solution may be narrower than the proof.
_ROUNDING = 1e-12


def solve_in_box(test: ExistenceTest, x: Array, lower: Array, upper: Array) -> ProvedBox | None:
    """A solution that is proved to lie in a box, to rounding; None where the point leads to none.

    The steps know the box's sides in the inputs alone; where a defined variable has been cut as well, a
    solution beyond that cut counts for nothing.

    Args:
        test: of the system.
        x: (n,) point to start from; its inputs count.
        lower: (n,) lower ends of the box.
        upper: (n,) upper ends.
    """
    inputs = test.program.inputs
    low, high = lower[inputs], upper[inputs]
    room = np.minimum(_ROOM, 0.25 * (high - low))
    x = x.copy()
    x[inputs] = np.clip(x[inputs], low + room, high - room)
    for _ in range(_MOST_STEPS):
        r, J = _residual(test.program.enclose(x, x))
        if not (np.isfinite(r).all() and np.isfinite(J).all()):
            return None
        if np.abs(r).max(initial=0.0) < _SETTLED:
            return _proved_inside(test, x, lower, upper)
        z = x[inputs]
        x[inputs] = np.clip(z + _step(r, J, z, low + room, high - room), low + room, high - room)
    return None


def _residual(at: Enclosure) -> tuple[Array, Array]:
    """Equations and violated inequalities with their slopes, at a point, to rounding."""
    violated = at.slack_lower < _ROOM
    r = np.concatenate([0.5 * (at.value_lower + at.value_upper), (at.slack_lower - 2.0 * _ROOM)[violated]])
    return r, np.vstack([0.5 * (at.slope_lower + at.slope_upper), at.slack_slope_lower[violated]])


def _step(r: Array, J: Array, z: Array, low: Array, high: Array) -> Array:
    """The least-norm Newton step (n_inputs,) in which no input that stands at a side leaves the box."""
    free = np.ones(len(z), dtype=bool)
    step = np.zeros(len(z))
    for _ in range(_MOST_ROUNDS):
        step[:] = 0.0
        step[free] = np.linalg.lstsq(J[:, free], -r, rcond=1e-10)[0]
        leaving = free & (((z <= low) & (step < 0.0)) | ((z >= high) & (step > 0.0)))
        if not leaving.any():
            break
        free &= ~leaving
    return step


def _proved_inside(test: ExistenceTest, x: Array, lower: Array, upper: Array) -> ProvedBox | None:
    proved = test.prove(x)
    if proved is None:
        return None
    inside = np.all(proved.lower >= lower - _ROUNDING) and np.all(proved.upper <= upper + _ROUNDING)
    return proved if inside else None
