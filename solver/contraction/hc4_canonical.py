"""Interval propagation over the canonical form: narrows a box without losing a solution, or finds it empty.

Each constraint is solved for each of its variables in outward-rounded arithmetic (as in HC4);
constraints whose variables changed are taken up again until nothing shrinks by a useful share.
"""

import numpy as np

from ...arrays import Array, Indices, offsets
from ..enclosure import bernstein_range, workspace
from ..interval import add, div, down, jit, mul, scale, sqr, sqrt_interval, sub, up
from ..polynomial import CanonicalForm

__all__ = ["Propagator"]


class Propagator:
    """Propagation over one canonical form."""

    def __init__(self, form: CanonicalForm):
        self._rows = form.rows
        self._products = form.products
        self._functions = form.functions
        self._incidence = _incidence(form)
        longest = int(np.diff(form.rows.start).max(initial=1))
        self._scratch = np.zeros((4, longest + 1))
        self._work = workspace(form.functions.degree)

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
        return bool(
            _contract(
                lower, upper, *self._rows, self._products, *self._functions, *self._incidence,
                self._scratch, self._work, least_gain, max_rounds,
            )
        )  # fmt: skip


def _incidence(form: CanonicalForm) -> tuple[Indices, Indices]:
    """Constraints by variable; numbered rows first, then products, then functions."""
    users: list[list[int]] = [[] for _ in range(form.size)]
    n_rows = len(form.rows.lower)
    for r in range(n_rows):
        for j in form.rows.column[form.rows.start[r] : form.rows.start[r + 1]]:
            users[j].append(r)
    for c, triple in enumerate([*form.products, *form.functions.kij]):
        for j in set(triple.tolist()):
            users[j].append(n_rows + c)
    start = offsets([len(u) for u in users])
    return start, np.array([c for u in users for c in u], dtype=np.int64)


@jit
def _narrow(lower, upper, k, lo, hi, least_gain, changed, count):  # type: ignore[no-untyped-def]
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


@jit
def _row_step(lower, upper, start, column, value, row_lower, row_upper, r, scratch, gain, changed):  # type: ignore[no-untyped-def]
    """Solves a linear row for each variable; returns the number of changed ones, -1 where empty."""
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


@jit
def _product_step(lower, upper, k, i, j, gain, changed):  # type: ignore[no-untyped-def]
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


@jit
def _contract(  # type: ignore[no-untyped-def]
    lower, upper, start, column, value, row_lower, row_upper, products, kij, degree, f_start, coefficients,
    user_start, users, scratch, work, gain, max_rounds,
):  # fmt: skip
    """The work list: a ring of constraints that wait, each at most once."""
    n_rows, n_products = len(row_lower), len(products)
    total = n_rows + n_products + len(kij)
    ring = np.arange(total)
    waiting = np.ones(total, dtype=np.bool_)
    changed = np.empty(scratch.shape[1] + 3, dtype=np.int64)
    head, count, visits = 0, total, 0
    while count > 0 and visits < max_rounds * total:
        c = ring[head]
        head = (head + 1) % total
        count -= 1
        waiting[c] = False
        visits += 1
        if c < n_rows:
            n = _row_step(lower, upper, start, column, value, row_lower, row_upper, c, scratch, gain, changed)
        elif c < n_rows + n_products:
            k, i, j = products[c - n_rows]
            n = _product_step(lower, upper, k, i, j, gain, changed)
        else:
            f = c - n_rows - n_products
            k, i, j = kij[f]
            di, dj = degree[f]
            size = (di + 1) * (dj + 1)
            lo, hi = bernstein_range(
                coefficients[f_start[f] : f_start[f] + size],
                di,
                dj,
                lower[i],
                upper[i],
                lower[j],
                upper[j],
                work,
            )
            n = _narrow(lower, upper, k, lo, hi, gain, changed, 0)
        if n < 0:
            return False
        for t in range(n):
            for s in range(user_start[changed[t]], user_start[changed[t] + 1]):
                u = users[s]
                # A product is worth another look even by the change it made itself; a row is not.
                if not waiting[u] and (u != c or c >= n_rows):
                    ring[(head + count) % total] = u
                    waiting[u] = True
                    count += 1
    return True
