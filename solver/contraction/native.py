"""One box of a native system contracted to the end: HC4, expansion, Newton, vertices and shaving in turn."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...base.numeric.linalg import square_inverse
from ..enclosure import Expansion, NativeSystem, curvatures, values_and_slopes
from ..linear import VertexProgram, contract_by_vertices
from .hc4_native import hc4
from .newton import newton_step, taylor_step
from .shave import shave

__all__ = ["CERTIFIED", "EMPTY", "OPEN", "contract_native", "pivot_weights", "smear"]

EMPTY, OPEN, CERTIFIED = -1, 0, 1

_CLOSE = 0.02  # by the counts of `./run bench systems`, as is what counts as a halt below


@compiled
def pivot_weights(lower: Array, upper: Array) -> Array:
    """Widths (n,); next to nothing counts as a share of the largest, or it would spoil the pivots."""
    widths = upper - lower
    return np.maximum(widths, max(1e-8 * widths.max(), 1e-300))


@compiled
def _newton(s: NativeSystem, lower: Array, upper: Array, at: Expansion) -> int:
    """A second-order step about the middle and an interval Newton step after it."""
    m, n = at.J_lower.shape
    k = min(m, n)
    x = 0.5 * (lower + upper)
    rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
    Y = np.empty((k, m))
    values_and_slopes(s, x, x, at.f_lower, at.f_upper, at.J0_lower, at.J0_upper)
    J0 = 0.5 * (at.J0_lower + at.J0_upper)
    if not square_inverse(J0, pivot_weights(lower, upper), rows, columns, Y):
        return OPEN
    curvatures(s, lower, upper, at.H_lower, at.H_upper)
    for _ in range(2):
        if taylor_step(s, x, lower, upper, columns, Y, at) < 0:
            return EMPTY
    x = np.minimum(np.maximum(x, lower), upper)
    values_and_slopes(s, x, x, at.f_lower, at.f_upper, at.J0_lower, at.J0_upper)
    values_and_slopes(
        s, lower, upper, at.J0_lower[:, 0].copy(), at.J0_upper[:, 0].copy(), at.J_lower, at.J_upper
    )
    status = newton_step(s, x, lower, upper, columns, Y, at)
    return OPEN if status == CERTIFIED and m > n else status


@compiled
def _shares_gained(before: Array, lower: Array, upper: Array) -> float:
    """Shares of the widths (n,) `before` that a box has lost since, added up."""
    gain = 0.0
    for j in range(len(before)):
        if before[j] > 0.0:
            gain += 1.0 - (upper[j] - lower[j]) / before[j]
    return gain


@compiled
def contract_native(
    s: NativeSystem, program: VertexProgram, lower: Array, upper: Array, workspace: Expansion, slices: int
) -> int:
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


@compiled
def smear(s: NativeSystem, lower: Array, upper: Array, at: Expansion) -> Array:
    """By variable (n,): the share that it has in the width of each equation, added up over the equations."""
    J_lower, J_upper = at.J_lower, at.J_upper
    m, n = J_lower.shape
    values_and_slopes(s, lower, upper, at.f_lower, at.f_upper, J_lower, J_upper)
    out = np.zeros(n)
    for e in range(m):
        effect = np.maximum(np.abs(J_lower[e]), np.abs(J_upper[e])) * (upper - lower)
        total = effect.sum()
        if total > 0.0:
            out += effect / total
    return out
