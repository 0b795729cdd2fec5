"""Interval propagation over the canonical form: narrows a box without losing a solution, or finds it empty.

Each constraint is solved for each of its variables in outward-rounded arithmetic (as in HC4);
constraints whose variables changed are taken up again until nothing shrinks by a useful share.
"""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices, offsets
from ..enclosure import bernstein_range, trig_inputs, trig_value, workspace
from ..interval import add, div, down, mul, scale, sqr, sqrt_interval, sub, up
from ..polynomial import CanonicalForm, Functions, Rows, TrigFunctions

__all__ = ["Propagator"]


class _Tables(NamedTuple):
    """A canonical form as compiled loops take it.

    Attributes:
        rows: linear rows.
        products: (m, 3)
        functions: Bernstein functions.
        trig: cosines and sines.
        user_start: (n + 1,) where the constraints of each variable begin in `user`.
        user: constraints, variable by variable; numbered rows first, then products, Bernstein functions, and
            cosines and sines.
        sums: (4, longest row + 1) scratch memory.
        points: scratch memory for control points.
    """

    rows: Rows
    products: Indices
    functions: Functions
    trig: TrigFunctions
    user_start: Indices
    user: Indices
    sums: Array
    points: Array


class Propagator:
    """Propagation over one canonical form."""

    def __init__(self, form: CanonicalForm):
        longest = int(np.diff(form.rows.start).max(initial=1))
        self._tables = _Tables(
            form.rows,
            form.products,
            form.functions,
            form.trig,
            *_incidence(form),
            np.zeros((4, longest + 1)),
            workspace(form.functions.degree),
        )

    def contract(self, lower: Array, upper: Array, *, least_gain: float = 0.05, max_rounds: int = 60) -> bool:
        """Narrows the box in place.

        Args:
            lower: (n,) lower ends.
            upper: (n,) upper ends.
            least_gain: a side must shrink by this share for its constraints to be taken up again.
            max_rounds: bound on the work, in visits per constraint.

        Returns:
            False where the box is proved to hold no solution.
        """
        return bool(_contract(self._tables, lower, upper, least_gain, max_rounds))


def _incidence(form: CanonicalForm) -> tuple[Indices, Indices]:
    """Constraints by variable, numbered as in `_Tables`."""
    users: list[list[int]] = [[] for _ in range(form.size)]
    n_rows = len(form.rows.lower)
    for r in range(n_rows):
        for j in form.rows.column[form.rows.start[r] : form.rows.start[r + 1]]:
            users[j].append(r)
    for c, columns in enumerate([*form.products, *form.functions.kij, *form.trig.ki]):
        for j in set(columns.tolist()):
            users[j].append(n_rows + c)
    start = offsets([len(u) for u in users])
    return start, np.array([c for u in users for c in u], dtype=np.int64)


@compiled
def _narrow(
    lower: Array, upper: Array, k: int, lo: float, hi: float, least_gain: float, changed: Indices, count: int
) -> int:
    """Cuts variable k to [lo, hi] and notes a useful gain in `changed`; the new count, -1 where empty."""
    old = upper[k] - lower[k]
    if lo > lower[k]:
        lower[k] = lo
    if hi < upper[k]:
        upper[k] = hi
    if lower[k] > upper[k]:
        return -1
    if old - (upper[k] - lower[k]) > least_gain * old:
        changed[count] = k
        return count + 1
    return count


@compiled
def _row_step(
    rows: Rows, r: int, lower: Array, upper: Array, gain: float, scratch: Array, changed: Indices
) -> int:
    """Solves a linear row for each variable; returns the number of changed ones, -1 where empty."""
    start, column, value, row_lower, row_upper = rows
    first, last = start[r], start[r + 1]
    m = last - first
    # Sums of what stands before and behind each entry, so that none is taken out of a rounded total.
    scratch[0, 0] = 0.0
    scratch[1, 0] = 0.0
    for t in range(m):
        j = column[first + t]
        lo, hi = scale(value[first + t], lower[j], upper[j])
        scratch[2, t], scratch[3, t] = lo, hi
        scratch[0, t + 1], scratch[1, t + 1] = add(scratch[0, t], scratch[1, t], lo, hi)
    if scratch[0, m] > row_upper[r] or scratch[1, m] < row_lower[r]:
        return -1
    count = 0
    bl, bu = 0.0, 0.0
    for t in range(m - 1, -1, -1):
        j = column[first + t]
        ol, ou = add(scratch[0, t], scratch[1, t], bl, bu)
        rl, ru = sub(row_lower[r], row_upper[r], ol, ou)
        a = value[first + t]
        if a > 0.0:
            lo, hi = down(rl / a), up(ru / a)
        else:
            lo, hi = down(ru / a), up(rl / a)
        count = _narrow(lower, upper, j, lo, hi, gain, changed, count)
        if count < 0:
            return -1
        bl, bu = add(bl, bu, scratch[2, t], scratch[3, t])
    return count


@compiled
def _product_step(lower: Array, upper: Array, k: int, i: int, j: int, gain: float, changed: Indices) -> int:
    """Solves x_k = x_i x_j (or a square) for each variable."""
    count = 0
    if i == j:
        lo, hi = sqr(lower[i], upper[i])
        count = _narrow(lower, upper, k, lo, hi, gain, changed, count)
        if count < 0:
            return -1
        sl, su = sqrt_interval(lower[k], upper[k])
        lo, hi = -su, su
        if lower[i] > -sl:
            lo = sl
        if upper[i] < sl:
            hi = -sl
        return _narrow(lower, upper, i, lo, hi, gain, changed, count)
    lo, hi = mul(lower[i], upper[i], lower[j], upper[j])
    count = _narrow(lower, upper, k, lo, hi, gain, changed, count)
    if count < 0:
        return -1
    for target, other in ((i, j), (j, i)):
        if lower[other] <= 0.0 <= upper[other] and lower[k] <= 0.0 <= upper[k]:
            continue
        if lower[other] == 0.0 and upper[other] == 0.0:
            return -1  # zero times anything is not what x_k may be
        lo, hi = div(lower[k], upper[k], lower[other], upper[other])
        count = _narrow(lower, upper, target, lo, hi, gain, changed, count)
        if count < 0:
            return -1
    return count


@compiled
def _trig_step(trig: TrigFunctions, f: int, lower: Array, upper: Array, gain: float, changed: Indices) -> int:
    """Solves x_k = cos or sin of (ratio x_i + offset) for both variables."""
    k, i = trig.ki[f]
    kind, ratio, offset = trig.kind[f], trig.ratio[f], trig.offset[f]
    lo, hi = trig_value(kind, ratio, offset, lower[i], upper[i])
    count = _narrow(lower, upper, k, lo, hi, gain, changed, 0)
    if count < 0:
        return -1
    lo, hi = trig_inputs(kind, ratio, offset, lower[k], upper[k], lower[i], upper[i])
    return _narrow(lower, upper, i, lo, hi, gain, changed, count)


@compiled
def _contract(t: _Tables, lower: Array, upper: Array, gain: float, max_rounds: int) -> bool:
    """The work list: a ring of constraints that wait, each at most once."""
    kij, degree, f_start, coefficients = t.functions
    n_rows, n_products = len(t.rows.lower), len(t.products)
    total = n_rows + n_products + len(kij) + len(t.trig.ki)
    ring = np.arange(total)
    waiting = np.ones(total, dtype=np.bool_)
    changed = np.empty(t.sums.shape[1] + 3, dtype=np.int64)
    head, count, visits = 0, total, 0
    while count > 0 and visits < max_rounds * total:
        c = ring[head]
        head = (head + 1) % total
        count -= 1
        waiting[c] = False
        visits += 1
        if c < n_rows:
            n = _row_step(t.rows, c, lower, upper, gain, t.sums, changed)
        elif c < n_rows + n_products:
            k, i, j = t.products[c - n_rows]
            n = _product_step(lower, upper, k, i, j, gain, changed)
        elif c < n_rows + n_products + len(kij):
            f = c - n_rows - n_products
            k, i, j = kij[f]
            di, dj = degree[f]
            b = coefficients[f_start[f] : f_start[f] + (di + 1) * (dj + 1)]
            lo, hi = bernstein_range(b, di, dj, lower[i], upper[i], lower[j], upper[j], t.points)
            n = _narrow(lower, upper, k, lo, hi, gain, changed, 0)
        else:
            n = _trig_step(t.trig, c - n_rows - n_products - len(kij), lower, upper, gain, changed)
        if n < 0:
            return False
        for v in range(n):
            for s in range(t.user_start[changed[v]], t.user_start[changed[v] + 1]):
                u = t.user[s]
                # A product is worth another look even by the change it made itself; a row is not.
                if not waiting[u] and (u != c or c >= n_rows):
                    ring[(head + count) % total] = u
                    waiting[u] = True
                    count += 1
    return True
