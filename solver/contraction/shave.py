"""Shaving: slices at the ends of a variable that contraction proves empty are cut off."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices
from ..enclosure import NativeSystem
from .hc4_native import hc4

__all__ = ["shave"]


@compiled
def shave(
    s: NativeSystem,
    lower: Array,
    upper: Array,
    variables: Indices,
    slices: int,
    gain: float,
    scratch_l: Array,
    scratch_u: Array,
) -> bool:
    """3B-CID: each variable is sliced, each slice contracted, and the hull of what is left is kept.

    Cuts from both ends until a slice survives; then the rest is taken as one more slice.
    """
    n = len(lower)
    for k in variables:
        width = upper[k] - lower[k]
        if width <= 1e-12 * max(1.0, abs(lower[k]), abs(upper[k])):
            continue
        start_l, start_u = lower[k], upper[k]
        hull_l, hull_u = np.full(n, np.inf), np.full(n, -np.inf)
        found = False
        edges_low, edges_high = 0, slices
        # From below.
        while edges_low < edges_high:
            a = start_l + width * (edges_low / slices)
            b = start_u if edges_low + 1 == slices else start_l + width * ((edges_low + 1) / slices)
            if _slice(s, lower, upper, k, a, b, gain, scratch_l, scratch_u):
                found = True
                for j in range(n):
                    hull_l[j], hull_u[j] = min(hull_l[j], scratch_l[j]), max(hull_u[j], scratch_u[j])
                edges_low += 1
                break
            edges_low += 1
        if not found:
            return False
        # From above.
        while edges_high > edges_low:
            a = start_l + width * ((edges_high - 1) / slices)
            b = start_u if edges_high == slices else start_l + width * (edges_high / slices)
            edges_high -= 1
            if _slice(s, lower, upper, k, a, b, gain, scratch_l, scratch_u):
                for j in range(n):
                    hull_l[j], hull_u[j] = min(hull_l[j], scratch_l[j]), max(hull_u[j], scratch_u[j])
                break
        if edges_high > edges_low:
            a = start_l + width * (edges_low / slices)
            b = start_l + width * (edges_high / slices)
            if _slice(s, lower, upper, k, a, b, gain, scratch_l, scratch_u):
                for j in range(n):
                    hull_l[j], hull_u[j] = min(hull_l[j], scratch_l[j]), max(hull_u[j], scratch_u[j])
        for j in range(n):
            lower[j], upper[j] = max(lower[j], hull_l[j]), min(upper[j], hull_u[j])
            if lower[j] > upper[j]:
                return False
    return True


@compiled
def _slice(
    s: NativeSystem,
    lower: Array,
    upper: Array,
    k: int,
    a: float,
    b: float,
    gain: float,
    out_l: Array,
    out_u: Array,
) -> bool:
    out_l[:] = lower
    out_u[:] = upper
    out_l[k], out_u[k] = max(a, lower[k]), min(b, upper[k])
    if out_l[k] > out_u[k]:
        return False
    return hc4(s, out_l, out_u, gain, 3)
