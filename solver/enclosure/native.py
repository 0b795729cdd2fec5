"""Polynomial systems of any degree as they are, without lifting, packed for compiled loops."""

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array, Indices, offsets
from ..polynomial import ExactPolynomial, Powers, enclose_fraction

__all__ = ["NativeSystem", "native_system"]


class NativeSystem(NamedTuple):
    """Equations as sums of interval coefficients times monomials.

    Attributes:
        term_start: (m + 1,) terms of each equation.
        c_lower: coefficients, lower ends.
        c_upper: coefficients, upper ends.
        factor_start: (terms + 1,) factors of each term.
        variable: variable of each factor.
        exponent: exponent of each factor, >= 1.
        user_start: (n + 1,) equations of each variable.
        user: equations, variable by variable.
        pair: (pairs, 2) variables i <= j that some equation bends in together, ascending.
        pair_start: (pairs + 1,) equations of each pair.
        pair_user: (curvatures,) equations, pair by pair.
        curvature: for each term, the curvatures that its pairs of factors add to, in the order of
            `factor_pairs`.
    """

    term_start: Indices
    c_lower: Array
    c_upper: Array
    factor_start: Indices
    variable: Indices
    exponent: Indices
    user_start: Indices
    user: Indices
    pair: Indices
    pair_start: Indices
    pair_user: Indices
    curvature: Indices


def factor_pairs(monomial: Powers) -> list[tuple[int, int]]:
    """Pairs of variables of a monomial whose second derivative is not zero, factor by factor."""
    return [
        (i, j) for f, (i, exponent) in enumerate(monomial) for j, _ in monomial[f:] if i != j or exponent > 1
    ]


def native_system(equations: Sequence[ExactPolynomial], n: int) -> NativeSystem:
    """Packs exact equations in n variables."""
    terms = [list(eq.items()) for eq in equations]
    flat = [term for group in terms for term in group]
    ends = [enclose_fraction(c) for _, c in flat]
    users: list[list[int]] = [[] for _ in range(n)]
    for e, eq in enumerate(equations):
        for k in sorted({v for m in eq for v, _ in m}):
            users[k].append(e)
    by_term = [(i, j, e) for e, eq in enumerate(equations) for m in eq for i, j in factor_pairs(m)]
    bends = sorted(set(by_term))
    place = {bend: at for at, bend in enumerate(bends)}
    pairs = Counter((i, j) for i, j, _ in bends)
    return NativeSystem(
        offsets([len(group) for group in terms]),
        np.array([lo for lo, _ in ends], dtype=np.float64),
        np.array([hi for _, hi in ends], dtype=np.float64),
        offsets([len(m) for m, _ in flat]),
        np.array([v for m, _ in flat for v, _ in m], dtype=np.int64),
        np.array([e for m, _ in flat for _, e in m], dtype=np.int64),
        offsets([len(u) for u in users]),
        np.array([e for u in users for e in u], dtype=np.int64),
        np.array(list(pairs), dtype=np.int64).reshape(-1, 2),
        offsets(list(pairs.values())),
        np.array([e for _, _, e in bends], dtype=np.int64),
        np.array([place[bend] for bend in by_term], dtype=np.int64),
    )
