"""Polynomials in one unknown with whole coefficients: common divisors and parts without multiple roots.

Coefficients stand in ascending order, (c_0, ..., c_d); the zero polynomial is (). Primitive ones have no
common divisor, and c_d > 0.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import gcd, lcm
from typing import TypeAlias

from .exact import ExactPolynomial, Powers

__all__ = [
    "WholePolynomial",
    "common_divisor",
    "derivative",
    "quotient",
    "sign_at",
    "to_exact",
    "whole_polynomial",
    "without_multiple_roots",
]

WholePolynomial: TypeAlias = tuple[int, ...]

# Common divisors are looked for modulo this prime first: mostly there are none, and then none at all.
_PRIME = 2**61 - 1


def whole_polynomial(polynomial: Mapping[Powers, Fraction]) -> WholePolynomial:
    """The primitive multiple, with whole coefficients, of a polynomial in at most one unknown."""
    below = lcm(*(c.denominator for c in polynomial.values()))
    by_degree = {
        sum(e for _, e in monomial): c.numerator * (below // c.denominator)
        for monomial, c in polynomial.items()
    }
    return _primitive([by_degree.get(k, 0) for k in range(max(by_degree, default=-1) + 1)])


def to_exact(p: WholePolynomial, variable: int) -> ExactPolynomial:
    """The same in the unknown of that number."""
    return ExactPolynomial({((variable, k),) if k else (): Fraction(c) for k, c in enumerate(p) if c})


def sign_at(p: WholePolynomial, x: Fraction) -> int:
    """The sign of p(x), exactly: -1, 0 or 1."""
    n, d = x.numerator, x.denominator
    total, power = 0, 1
    for c in reversed(p):
        total = total * n + c * power
        power *= d
    return (total > 0) - (total < 0)


def derivative(p: WholePolynomial) -> WholePolynomial:
    """The primitive multiple of the derivative."""
    return _primitive([k * c for k, c in enumerate(p)][1:])


def without_multiple_roots(p: WholePolynomial) -> WholePolynomial:
    """A polynomial with the same roots, each of them once."""
    return quotient(p, common_divisor(p, derivative(p)))


def common_divisor(p: WholePolynomial, q: WholePolynomial) -> WholePolynomial:
    """The greatest common divisor, primitive."""
    if p and q and not _may_share(p, q):
        return (1,)
    while q:
        p, q = q, _primitive(_remainder(p, q))
    return _primitive(p)


def quotient(p: WholePolynomial, divisor: WholePolynomial) -> WholePolynomial:
    """The primitive multiple of p / divisor, which must leave no remainder."""
    rest, lead = list(p), divisor[-1]
    out = [0] * (len(p) - len(divisor) + 1)
    for k in reversed(range(len(out))):
        top = rest[k + len(divisor) - 1]
        if top % lead:  # both made multiples, so that the division comes out
            factor = abs(lead) // gcd(top, lead)
            rest, out, top = [factor * c for c in rest], [factor * c for c in out], factor * top
        out[k] = top // lead
        for i, c in enumerate(divisor):
            rest[k + i] -= out[k] * c
    assert not any(rest), "the divisor leaves a remainder"
    return _primitive(out)


def _primitive(p: Sequence[int]) -> WholePolynomial:
    """Divided by the greatest common divisor of its coefficients, and the one at the top positive."""
    end = max((k for k, c in enumerate(p) if c), default=-1) + 1
    if not end:
        return ()
    content = gcd(*p[:end]) * (1 if p[end - 1] > 0 else -1)
    return tuple(c // content for c in p[:end])


def _remainder(p: WholePolynomial, q: WholePolynomial) -> list[int]:
    """A multiple of p modulo q."""
    rest, lead = list(p), q[-1]
    while len(rest) >= len(q):
        top = rest[-1]
        shared = gcd(top, lead)
        rest = [lead // shared * c for c in rest]
        for i, c in enumerate(q):
            rest[len(rest) - len(q) + i] -= top // shared * c
        while rest and not rest[-1]:
            rest.pop()
    return rest


def _may_share(p: WholePolynomial, q: WholePolynomial) -> bool:
    """Whether a common divisor is not ruled out modulo a prime."""
    if p[-1] % _PRIME == 0 or q[-1] % _PRIME == 0:
        return True
    a, b = [c % _PRIME for c in p], [c % _PRIME for c in q]
    while b:
        inverse = pow(b[-1], -1, _PRIME)
        while len(a) >= len(b):
            factor = a[-1] * inverse % _PRIME
            for i, c in enumerate(b):
                a[len(a) - len(b) + i] = (a[len(a) - len(b) + i] - factor * c) % _PRIME
            while a and not a[-1]:
                a.pop()
        a, b = b, a
    return len(a) > 1
