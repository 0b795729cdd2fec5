"""Roots of intervals, rounded outward."""

import numpy as np

from ...base.machine.jit import compiled
from .arithmetic import power

__all__ = ["root_interval"]


@compiled
def root_interval(al: float, au: float, n: int, xl: float, xu: float) -> tuple[float, float]:
    """Part of [xl, xu] whose n-th power may lie in [al, au], as a hull; empty as (inf, -inf)."""
    if n == 1:
        return max(al, xl), min(au, xu)
    if n % 2 == 0:
        if au < 0.0:
            return np.inf, -np.inf
        hi = _root_up(au, n)
        lo = _root_down(al, n) if al > 0.0 else 0.0
        low, high = max(-hi, xl), min(hi, xu)
        if low > -lo:
            low = max(low, lo)
        if high < lo:
            high = min(high, -lo)
        return low, high
    lo = _root_down(al, n) if al >= 0.0 else -_root_up(-al, n)
    hi = _root_up(au, n) if au >= 0.0 else -_root_down(-au, n)
    return max(lo, xl), min(hi, xu)


@compiled
def _root_up(a: float, n: int) -> float:
    """At or above the n-th root of a >= 0: a float whose power, rounded down, is at least a."""
    if a == 0.0 or a == np.inf:
        return a
    r = a ** (1.0 / n)
    step = abs(r) * 1e-15 + 1e-300
    for _ in range(60):
        if power(r, r, n)[0] >= a:
            return r
        r += step
        step *= 2.0
    return np.inf


@compiled
def _root_down(a: float, n: int) -> float:
    """At or below the n-th root of a >= 0."""
    if a == 0.0:
        return 0.0
    if a == np.inf:
        return 1.7e308 ** (1.0 / n)
    r = a ** (1.0 / n)
    step = abs(r) * 1e-15 + 1e-300
    for _ in range(60):
        if r <= 0.0 or power(r, r, n)[1] <= a:
            return max(r, 0.0)
        r -= step
        step *= 2.0
    return 0.0
