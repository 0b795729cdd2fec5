"""One box of a native system contracted to the end: HC4, expansion, Newton, vertices and shaving in turn."""

import numpy as np

from ...linalg import square_inverse
from ..enclosure import curvatures, values_and_slopes
from ..interval import jit
from ..linear import contract_by_vertices
from .hc4_native import hc4
from .newton import newton_step, taylor_step
from .shave import shave

__all__ = ["CERTIFIED", "EMPTY", "OPEN", "contract_native", "pivot_weights", "smear"]

EMPTY, OPEN, CERTIFIED = -1, 0, 1

_CLOSE = 0.02  # by the counts of `benchmarks/systems.py`, as is what counts as a halt below


@jit
def pivot_weights(lower, upper):  # type: ignore[no-untyped-def]
    """Widths (n,); next to nothing counts as a share of the largest, or it would spoil the pivots."""
    widths = upper - lower
    return np.maximum(widths, max(1e-8 * widths.max(), 1e-300))


@jit
def _newton(s, lower, upper, workspace):  # type: ignore[no-untyped-def]
    """A second-order step about the middle and an interval Newton step after it."""
    f_lower, f_upper, J0_lower, J0_upper, J_lower, J_upper, H_lower, H_upper = workspace
    m, n = J_lower.shape
    k = min(m, n)
    x = 0.5 * (lower + upper)
    rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
    Y = np.empty((k, m))
    values_and_slopes(s, x, x, f_lower, f_upper, J0_lower, J0_upper)
    if not square_inverse(0.5 * (J0_lower + J0_upper), pivot_weights(lower, upper), rows, columns, Y):
        return OPEN
    if len(H_lower) == m:  # no room is made for the curvatures of large systems
        curvatures(s, lower, upper, H_lower, H_upper)
        for _ in range(2):
            if (
                taylor_step(
                    x, lower, upper, columns, Y, f_lower, f_upper, J0_lower, J0_upper, H_lower, H_upper
                )
                < 0
            ):
                return EMPTY
    x = np.minimum(np.maximum(x, lower), upper)
    values_and_slopes(s, x, x, f_lower, f_upper, J0_lower, J0_upper)
    values_and_slopes(s, lower, upper, J0_lower[:, 0].copy(), J0_upper[:, 0].copy(), J_lower, J_upper)
    status = newton_step(x, lower, upper, columns, Y, f_lower, f_upper, J_lower, J_upper)
    return OPEN if status == CERTIFIED and m > n else status


@jit
def _shares_gained(before, lower, upper):  # type: ignore[no-untyped-def]
    """Shares of the widths (n,) `before` that a box has lost since, added up."""
    gain = 0.0
    for j in range(len(before)):
        if before[j] > 0.0:
            gain += 1.0 - (upper[j] - lower[j]) / before[j]
    return gain


@jit
def contract_native(s, program, lower, upper, workspace, slices):  # type: ignore[no-untyped-def]
    """Contracts a box in place: EMPTY, OPEN, or CERTIFIED as `newton_step` says.

    Args:
        s: the native system.
        program: its `vertex_program`.
        lower: (n,) box.
        upper: (n,)
        workspace: of `Certifier`.
        slices: number of slices for shaving, or 0.
    """
    n = len(lower)
    every = np.arange(n)
    scratch_l, scratch_u = np.empty(n), np.empty(n)
    for turn in range(12):
        before = upper - lower
        if not hc4(s, lower, upper, 0.1, 30):
            return EMPTY
        status = _newton(s, lower, upper, workspace)
        if status != OPEN:
            return status
        # What follows costs several contractions: only where the others have come to a halt.
        if _shares_gained(before, lower, upper) >= 0.05 * n:
            continue
        before = upper - lower
        if not contract_by_vertices(program, lower, upper, _CLOSE):
            return EMPTY
        if _shares_gained(before, lower, upper) >= 0.05 * n:
            continue
        if slices == 0 or turn == 11:
            return OPEN
        before = upper - lower
        if not shave(s, lower, upper, every, slices, 0.1, scratch_l, scratch_u):
            return EMPTY
        slices = 0  # once is enough
        if _shares_gained(before, lower, upper) < 0.2:
            return OPEN
    return OPEN


@jit
def smear(s, lower, upper, workspace):  # type: ignore[no-untyped-def]
    """By variable (n,): the share that it has in the width of each equation, added up over the equations."""
    f_lower, f_upper, _, _, J_lower, J_upper, _, _ = workspace
    m, n = J_lower.shape
    values_and_slopes(s, lower, upper, f_lower, f_upper, J_lower, J_upper)
    out = np.zeros(n)
    for e in range(m):
        effect = np.maximum(np.abs(J_lower[e]), np.abs(J_upper[e])) * (upper - lower)
        total = effect.sum()
        if total > 0.0:
            out += effect / total
    return out
