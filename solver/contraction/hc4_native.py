"""HC4 on sums of monomials: each equation is solved for each factor of each of its monomials."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices
from ..enclosure import NativeSystem
from ..interval import add, div, mul, power, root_interval

__all__ = ["hc4"]


@compiled
def _revise(
    s: NativeSystem, e: int, lower: Array, upper: Array, gain: float, terms: Array, changed: Indices
) -> int:
    """HC4 on one equation; number of changed variables, -1 where empty."""
    first, last = s.term_start[e], s.term_start[e + 1]
    m = last - first
    terms[0, 0] = 0.0
    terms[1, 0] = 0.0
    for t in range(m):
        vl, vu = s.c_lower[first + t], s.c_upper[first + t]
        for f in range(s.factor_start[first + t], s.factor_start[first + t + 1]):
            pl, pu = power(lower[s.variable[f]], upper[s.variable[f]], s.exponent[f])
            vl, vu = mul(vl, vu, pl, pu)
        terms[2, t], terms[3, t] = vl, vu
        terms[0, t + 1], terms[1, t + 1] = add(terms[0, t], terms[1, t], vl, vu)
    if terms[0, m] > 0.0 or terms[1, m] < 0.0:
        return -1
    count = 0
    bl, bu = 0.0, 0.0
    for t in range(m - 1, -1, -1):
        begin, end = s.factor_start[first + t], s.factor_start[first + t + 1]
        ol, ou = add(terms[0, t], terms[1, t], bl, bu)
        bl, bu = add(bl, bu, terms[2, t], terms[3, t])
        if begin == end:
            continue
        # The term must equal minus the sum of the others.
        rl, ru = max(-ou, terms[2, t]), min(-ol, terms[3, t])
        if rl > ru:
            return -1
        for f in range(begin, end):
            k = s.variable[f]
            wl, wu = s.c_lower[first + t], s.c_upper[first + t]
            for g in range(begin, end):
                if g != f:
                    pl, pu = power(lower[s.variable[g]], upper[s.variable[g]], s.exponent[g])
                    wl, wu = mul(wl, wu, pl, pu)
            if wl <= 0.0 <= wu and rl <= 0.0 <= ru:
                continue
            if wl == 0.0 and wu == 0.0:
                return -1
            ql, qu = div(rl, ru, wl, wu)
            lo, hi = root_interval(ql, qu, s.exponent[f], lower[k], upper[k])
            if lo > hi:
                return -1
            old = upper[k] - lower[k]
            lower[k], upper[k] = lo, hi
            if old - (hi - lo) > gain * old:
                changed[count] = k
                count += 1
    return count


@compiled
def hc4(s: NativeSystem, lower: Array, upper: Array, gain: float, max_rounds: int) -> bool:
    """HC4 until nothing shrinks by the share `gain`; False where the box is proved empty."""
    m = len(s.term_start) - 1
    longest = 1
    for e in range(m):
        longest = max(longest, s.term_start[e + 1] - s.term_start[e])
    terms = np.empty((4, longest + 1))
    changed = np.empty(len(s.variable) + 1, dtype=np.int64)
    ring = np.arange(m)
    waiting = np.ones(m, dtype=np.bool_)
    head, count, visits = 0, m, 0
    while count > 0 and visits < max_rounds * m:
        e = ring[head]
        head = (head + 1) % m
        count -= 1
        waiting[e] = False
        visits += 1
        n = _revise(s, e, lower, upper, gain, terms, changed)
        if n < 0:
            return False
        for c in range(n):
            k = changed[c]
            for u in range(s.user_start[k], s.user_start[k + 1]):
                other = s.user[u]
                if not waiting[other]:
                    ring[(head + count) % m] = other
                    waiting[other] = True
                    count += 1
    return True
