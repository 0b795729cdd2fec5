"""Products of polynomials with their factors kept apart."""

from collections.abc import Iterable
from typing import Self

from .exact import ExactPolynomial

__all__ = ["FactoredPolynomial"]


class FactoredPolynomial(tuple[ExactPolynomial, ...]):
    """A product, zero wherever one of its factors is: that, and not its value, is what it is kept for.

    Factors that are numbers other than zero are left out, and so are multiples of factors that stand before.
    Without factors it is a number other than zero, and with a factor of no terms it is zero everywhere.
    """

    __slots__ = ()

    @classmethod
    def product(cls, factors: Iterable[ExactPolynomial]) -> Self:
        """The product of some polynomials."""
        by_form: dict[frozenset[object], ExactPolynomial] = {}
        for factor in factors:
            factor = factor.without_zeros()
            if set(factor) != {()}:
                by_form.setdefault(_form(factor), factor)
        return cls(by_form.values())

    @property
    def is_zero(self) -> bool:
        """Whether it is zero everywhere."""
        return not all(self)

    @property
    def variables(self) -> frozenset[int]:
        """The unknowns that occur."""
        return frozenset(v for factor in self for monomial in factor for v, _ in monomial)


def _form(polynomial: ExactPolynomial) -> frozenset[object]:
    """The same for all multiples of a polynomial."""
    if not polynomial:
        return frozenset()
    lead = polynomial[min(polynomial)]
    return frozenset((monomial, c / lead) for monomial, c in polynomial.items())
