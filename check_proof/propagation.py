"""Interval propagation: a system's constraints narrow a box, and lose none of its solutions."""

import numpy as np

from .box import Box
from .intervals import divide, down, mul, square, up
from .system import LoggedSystem

__all__ = ["propagate", "sticks_out"]

# Sweeps over all constraints in search of what the log says, or of emptiness, and the share of some width
# by which a sweep must shrink the box for another to follow.
_SWEEPS = 400
_LEAST_GAIN = 1e-5


def propagate(system: LoggedSystem, box: Box, target: Box | None = None) -> None:
    """Narrows the box by all constraints until it lies in the target, is empty, or stands still."""
    for _ in range(_SWEEPS):
        if box.is_empty or (target is not None and sticks_out(system, box, target) <= 0.0):
            return
        before = box.upper - box.lower
        _sweep_rows(system, box)
        _sweep_squares(system, box)
        _sweep_products(system, box)
        for functions in system.groups:
            lo, hi = functions.nets_over(box)
            box.narrow(functions.k, lo.min(axis=(1, 2)), hi.max(axis=(1, 2)))
        for function in system.trig:
            function.narrow(box)
        if not (before - (box.upper - box.lower) > _LEAST_GAIN * before).any():
            return


def sticks_out(system: LoggedSystem, box: Box, target: Box) -> float:
    """By how much the box exceeds the target in any factor of a product or function."""
    f = system.factors
    out = np.maximum(target.lower[f] - box.lower[f], box.upper[f] - target.upper[f])
    return float(out.max(initial=-np.inf))


def _sweep_rows(system: LoggedSystem, box: Box) -> None:
    """Solves each row for each of its columns: what the others leave, over the coefficient."""
    a, columns = system.values, system.columns
    tl, tu = mul(a, a, box.lower[columns], box.upper[columns])
    tl, tu = np.where(a == 0.0, 0.0, tl), np.where(a == 0.0, 0.0, tu)
    # The sum of the others is what stands before plus what stands behind.
    n_rows, length = a.shape
    sums = np.zeros((4, n_rows, length + 1))
    for t in range(length):
        s = length - t
        sums[0, :, t + 1], sums[1, :, t + 1] = (
            down(sums[0, :, t] + tl[:, t]),
            up(sums[1, :, t] + tu[:, t]),
        )
        sums[2, :, s - 1] = down(sums[2, :, s] + tl[:, s - 1])
        sums[3, :, s - 1] = up(sums[3, :, s] + tu[:, s - 1])
    if (sums[0, :, length] > system.row_upper).any() or (sums[1, :, length] < system.row_lower).any():
        box.lower[:], box.upper[:] = np.inf, -np.inf  # a row can't hold, be it without any column
        return
    least, most = down(sums[0, :, :-1] + sums[2, :, 1:]), up(sums[1, :, :-1] + sums[3, :, 1:])
    lo, hi = down(system.row_lower[:, None] - most), up(system.row_upper[:, None] - least)
    lo, hi = np.where(a > 0.0, lo / a, hi / a), np.where(a > 0.0, hi / a, lo / a)
    used = a != 0.0
    box.narrow(columns[used], down(lo[used]), up(hi[used]))


def _sweep_squares(system: LoggedSystem, box: Box) -> None:
    k, i, _ = system.squares
    box.narrow(k, *square(box.lower[i], box.upper[i]))
    least = np.maximum(down(np.sqrt(np.maximum(box.lower[k], 0.0))), 0.0)
    most = up(np.sqrt(np.maximum(box.upper[k], 0.0)))
    box.narrow(
        i,
        np.where(box.lower[i] > -least, least, -most),
        np.where(box.upper[i] < least, -least, most),
    )


def _sweep_products(system: LoggedSystem, box: Box) -> None:
    k, i, j = system.others
    box.narrow(k, *mul(box.lower[i], box.upper[i], box.lower[j], box.upper[j]))
    for target, other in ((i, j), (j, i)):
        box.narrow(target, *divide(box.lower[k], box.upper[k], box.lower[other], box.upper[other]))
