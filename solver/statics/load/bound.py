"""What contacts over parts of their regions carry at most, shown by twists: in outward rounding."""

import numpy as np

from ....base.machine.jit import compiled
from ....base.numeric.arrays import Array, Indices
from ...interval import add, down, mul, scale, sqr, up

__all__ = ["load_bound"]


@compiled
def load_bound(
    low: Array,
    high: Array,
    owner: Indices,
    arms: Array,
    friction: float,
    forces: Array,
    along: Array,
    twist: Array,
) -> float:
    """The largest load in N that is carried whichever way it acts, at most; infinite where nothing is shown.

    Args:
        low: control points as maps (n, 8, 6), enclosed.
        high: likewise.
        owner: contact (n,) of each.
        arms: spin arms (contacts,).
        friction: coefficient.
        forces: largest normal forces (contacts,) in N.
        along: (contacts, 3) whole numbers, about along the normals; lengths of normals are measured along.
        twist: (6,) whole numbers below 2^25.
    """
    n_contacts = len(forces)
    moved = down(np.sqrt(twist[0] ** 2 + twist[1] ** 2 + twist[2] ** 2))  # squares are exact
    if moved <= 0.0:
        return np.inf
    most = np.zeros(n_contacts)
    for k in range(len(owner)):
        i = owner[k]
        length, squares = 0.0, 0.0
        for c in range(3):
            tl, _ = scale(along[i, c], low[k, 0, c], high[k, 0, c])
            length = down(length + tl)
            squares += along[i, c] ** 2  # exact
        if length <= 0.0:
            return np.inf
        power = _power(low[k], high[k], arms[i], friction, twist)
        if power > 0.0:
            most[i] = max(most[i], up(up(power * up(np.sqrt(squares))) / length))
    total = 0.0
    for i in range(n_contacts):
        if most[i] > 0.0:
            total = up(total + up(forces[i] * most[i]))
    return up(total / moved) if total > 0.0 else 0.0


@compiled
def _power(low: Array, high: Array, arm: float, friction: float, twist: Array) -> float:
    """The largest power that a control point takes up against a twist, at most; zero or more."""
    ql, qu = np.zeros(5), np.zeros(5)
    for r in range(5):
        for c in range(6):
            tl, tu = scale(twist[c], low[r, c], high[r, c])
            ql[r], qu[r] = add(ql[r], qu[r], tl, tu)
    tl, tu = mul(arm, arm, ql[4], qu[4])
    _, squares = sqr(tl, tu)
    for r in range(1, 4):
        _, square = sqr(ql[r], qu[r])
        squares = up(squares + square)
    power = up(up(friction * up(np.sqrt(squares))) - ql[0])
    return max(0.0, power)
