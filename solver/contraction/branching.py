"""Where to split a box: where propagation in both halves leaves the relaxation least wrong."""

import numpy as np

from ...base.numeric.arrays import Array
from ..linear import relaxation_errors
from ..polynomial import CanonicalForm
from .hc4_canonical import Propagator

__all__ = ["column_to_split", "cut_value"]

# Columns that are tried; more of them made no difference.
_CANDIDATES = 10
# Those with less than this share of the largest error are not tried.
_LEAST_SHARE = 0.05
# How wrong the relaxation may yet become in a half counts by this much of how wrong it is at the point.
_ROOM_WEIGHT = 0.1


def cut_value(lower: float, upper: float, wanted: float) -> float:
    """The value nearest to the one that is wanted that leaves no sliver."""
    return float(np.clip(wanted, 0.7 * lower + 0.3 * upper, 0.3 * lower + 0.7 * upper))


def column_to_split(
    form: CanonicalForm, propagator: Propagator, lower: Array, upper: Array, point: Array, scores: Array
) -> int:
    """The column whose halves, each narrowed by propagation, leave the relaxation least wrong in sum.

    Args:
        form: the system.
        propagator: of the system.
        lower: (n,) the box.
        upper: (n,)
        point: (n,) of the relaxation over the box.
        scores: (n,) how wrong the relaxation is at the point by column; zero where it can't be split. One is
            above zero.
    """
    order = np.argsort(-scores, kind="stable")[:_CANDIDATES]
    order = order[scores[order] > _LEAST_SHARE * scores[order[0]]]
    left = [_left(form, propagator, lower, upper, point, int(k)) for k in order]
    return int(order[np.argmin(left)])


def _left(
    form: CanonicalForm, propagator: Propagator, lower: Array, upper: Array, point: Array, column: int
) -> float:
    """How wrong the relaxation still is in both halves of a box that is split in the column."""
    cut = cut_value(lower[column], upper[column], point[column])
    total = 0.0
    for side in (0, 1):
        low, high = lower.copy(), upper.copy()
        (high, low)[side][column] = cut
        if propagator.contract(low, high):
            total += _wrong(form, low, high, point)
    return total


def _wrong(form: CanonicalForm, lower: Array, upper: Array, point: Array) -> float:
    """How wrong the relaxation over a box is at its point nearest to `point`, and may be anywhere."""
    width = upper - lower
    room = float(np.prod(width[form.factors], axis=1).sum())
    return float(relaxation_errors(form, np.clip(point, lower, upper)).sum()) + _ROOM_WEIGHT * room
