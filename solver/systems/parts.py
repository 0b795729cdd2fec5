"""Equations as choices: a product is zero where a factor is, and one in a single unknown where a root is."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

from ..certify import Ends
from ..polynomial import (
    ExactPolynomial,
    FactoredPolynomial,
    WholePolynomial,
    common_divisor,
    normalised,
    quotient,
    real_roots,
    substitute,
    to_exact,
    whole_polynomial,
    with_fewer_terms,
    without_multiple_roots,
)

__all__ = ["Parts", "SystemPart", "equation_parts"]


@dataclass(frozen=True, eq=False)
class SystemPart:
    """One way for an equation to hold.

    Attributes:
        polynomial: must be zero.
        unknown: the only unknown of the polynomial, where a root of it is meant.
        root: the ends of what holds that root, and no other one of the polynomial.
    """

    polynomial: ExactPolynomial
    unknown: int | None = None
    root: tuple[Fraction, Fraction] | None = None


Parts: TypeAlias = tuple[SystemPart, ...]
"""All ways for an equation to hold; roots of one unknown come first, ascending."""


def equation_parts(
    equations: Iterable[FactoredPolynomial], ends: Ends, fixed: Mapping[int, Fraction]
) -> list[Parts]:
    """The ways in which each equation can hold in a box.

    Equations that hold everywhere are left out, and those in one and the same unknown are made one. Roots are
    told apart unless there are fewer equations than unknowns, so that a cover is asked for.

    Args:
        equations: products that must be zero, in all unknowns.
        ends: of the box, for the unknowns that are left.
        fixed: unknowns that have a value; the others are numbered anew without gaps.
    """
    mixed: list[FactoredPolynomial] = []
    alone: dict[int, list[WholePolynomial]] = {}
    products = [
        FactoredPolynomial.product(substitute(factor, fixed) for factor in equation) for equation in equations
    ]
    for product in with_fewer_terms(products):
        if product.is_zero:
            continue
        if len(product.variables) == 1:
            (k,) = product.variables
            known = _coprime(map(whole_polynomial, product))
            alone[k] = _common(alone[k], known) if k in alone else known
        else:
            mixed.append(product)
    ways = _by_root if len(mixed) + len(alone) >= len(ends) else _by_polynomial
    out = [_parts(product, ends, ways) for product in mixed]
    return out + [ways(polynomials, k, ends[k]) for k, polynomials in sorted(alone.items())]


# The ways for polynomials in one unknown, that of the number given, to be zero between its ends.
_Ways: TypeAlias = Callable[[Sequence[WholePolynomial], int, tuple[Fraction, Fraction]], Parts]


def _parts(product: FactoredPolynomial, ends: Ends, ways: _Ways) -> Parts:
    by_unknown: dict[int, list[WholePolynomial]] = {}
    rest = []
    for factor in product:
        unknowns = {v for monomial in factor for v, _ in monomial}
        if len(unknowns) == 1:
            by_unknown.setdefault(unknowns.pop(), []).append(whole_polynomial(factor))
        else:
            rest.append(SystemPart(normalised(factor)))
    alone = [ways(_coprime(ps), k, ends[k]) for k, ps in sorted(by_unknown.items())]
    return (*(part for parts in alone for part in parts), *rest)


def _by_root(polynomials: Sequence[WholePolynomial], k: int, ends: tuple[Fraction, Fraction]) -> Parts:
    found = [root for p in polynomials for root in real_roots(p, *ends)]
    found.sort(key=lambda root: (root.lower, root.upper))
    return tuple(
        SystemPart(normalised(to_exact(root.polynomial, k)), k, (root.lower, root.upper)) for root in found
    )


def _by_polynomial(polynomials: Sequence[WholePolynomial], k: int, ends: tuple[Fraction, Fraction]) -> Parts:
    return tuple(SystemPart(normalised(to_exact(p, k))) for p in polynomials if real_roots(p, *ends))


def _coprime(polynomials: Iterable[WholePolynomial]) -> list[WholePolynomial]:
    """Polynomials with the same roots, each root of one of them and only once."""
    out: list[WholePolynomial] = []
    for p in polynomials:
        p = without_multiple_roots(p)
        for known in out:
            p = quotient(p, common_divisor(p, known))
        out.append(p)
    return out


def _common(these: Sequence[WholePolynomial], those: Sequence[WholePolynomial]) -> list[WholePolynomial]:
    """Polynomials whose roots are those that two lists of coprime ones share."""
    return [common_divisor(p, q) for p in these for q in those]
