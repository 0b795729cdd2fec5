"""Polynomials from text such as `x**2 + 2*x*(y - 1/3) - 0.5`, with decimals taken exactly."""

import re
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import TypeAlias

from ...errors import InputError, suggest
from .exact import ExactPolynomial
from .factored import FactoredPolynomial

__all__ = ["parse_factors", "parse_polynomial"]

_MAX_TEXT = 100_000
_MAX_DEPTH = 80
_MAX_DEGREE = 60
_MAX_TERMS = 20_000
_MAX_NUMBER = 60  # characters of a number; its decimal exponent stays within +-_MAX_EXPONENT
_MAX_EXPONENT = 300
_MAX_BITS = 20_000  # of a coefficient's numerator and denominator
# Pairs of terms that may be multiplied or added for one equation: some seconds.
_MAX_WORK = 1_000_000

_EQUALS = ("=", "==")
_ALLOWED = "allowed: variables, numbers, + - * / ** =, and parentheses"
_INEQUALITY = "equations only; bounds stand with the variables"

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<sign>\*\*|==?|[-+*/^()]))"
)


def parse_polynomial(text: str, names: Sequence[str], source: str, field: str) -> ExactPolynomial:
    """Parses a polynomial in the named variables, and multiplies it out.

    Numbers, + - * / by a number, ** (or ^) with a whole exponent, and parentheses are understood, and bind as
    in Python. An equation with two sides, `left = right`, is `left - (right)`.

    Raises:
        InputError: for anything else, naming what was not understood.
    """
    return _Reader(text, {name: i for i, name in enumerate(names)}, source, field).read()


def parse_factors(text: str, names: Sequence[str], source: str, field: str) -> FactoredPolynomial:
    """The same with the factors of a product kept apart, each of them once, whatever its exponent.

    Raises:
        InputError: see `parse_polynomial`.
    """
    return _Reader(text, {name: i for i, name in enumerate(names)}, source, field).read_factors()


# Factors with their exponents.
_Product: TypeAlias = list[tuple[ExactPolynomial, int]]


class _Reader:
    """Reads one expression by recursive descent."""

    def __init__(self, text: str, index: dict[str, int], source: str, field: str):
        self._index = index
        self._source = source
        self._field = field
        self._depth = 0
        self._work = 0
        self._tokens = self._split(text)
        self._at = 0

    def read(self) -> ExactPolynomial:
        return self._expanded(self._whole_text())

    def read_factors(self) -> FactoredPolynomial:
        return FactoredPolynomial.product(factor for factor, exponent in self._whole_text() if exponent)

    def _whole_text(self) -> _Product:
        out = self._sum()
        if self._next in _EQUALS:
            self._take()
            out = self._moved_over(out, self._sum())
        if self._next in _EQUALS:
            raise self._refuse("has more than one '='")
        if self._next:
            raise self._refuse(f"an operator such as * is missing before {self._next[:20]!r}")
        return out

    def _moved_over(self, left: _Product, right: _Product) -> _Product:
        """The left side less the right one; a side keeps its factors where the other is zero."""
        subtrahend = self._expanded(right)
        if not subtrahend:
            return left
        out = ExactPolynomial(self._expanded(left))
        if not out:
            return right
        self._add(out, subtrahend, -1)
        return [(out, 1)]

    def _refuse(self, what: str) -> InputError:
        return InputError(self._source, self._field, what)

    def _split(self, text: str) -> list[str]:
        if len(text) > _MAX_TEXT:
            raise self._refuse(f"longer than {_MAX_TEXT} characters")
        text = text.rstrip()
        tokens, at = [], 0
        while at < len(text):
            found = _TOKEN.match(text, at)
            if found is None:
                rest = text[at:].lstrip()
                raise self._refuse(
                    f"{rest[0]!r} in {rest[:20]!r} is not part of a polynomial "
                    f"({_INEQUALITY if rest[0] in '<>≤≥!' else _ALLOWED})"
                )
            tokens.append(found[0].strip().replace("^", "**"))
            at = found.end()
        return [*tokens, ""]

    @property
    def _next(self) -> str:
        return self._tokens[self._at]

    def _take(self) -> str:
        self._at += 1
        return self._tokens[self._at - 1]

    def _spend(self, work: int) -> None:
        self._work += work
        if self._work > _MAX_WORK:
            raise self._refuse("takes too long to expand")

    def _sum(self) -> _Product:
        first = self._product()
        if self._next not in ("+", "-"):
            return first
        out = ExactPolynomial(self._expanded(first))
        while self._next in ("+", "-"):
            sign = 1 if self._take() == "+" else -1
            self._add(out, self._expanded(self._product()), sign)
        return [(out, 1)]

    def _add(self, out: ExactPolynomial, term: ExactPolynomial, sign: int) -> None:
        """Adds a polynomial, or takes it away, within the limits."""
        self._spend(len(term))
        out.add(term, sign)
        self._check(out[monomial] for monomial in term if monomial in out)
        if len(out) > _MAX_TERMS:
            raise self._refuse(f"expands to more than {_MAX_TERMS} terms")

    def _product(self) -> _Product:
        out = self._signed()
        while self._next in ("*", "/"):
            if self._take() == "*":
                out = out + self._signed()
                continue
            divisor = self._expanded(self._signed())
            if set(divisor) != {()}:
                raise self._refuse("division is by a number other than zero only")
            out = [*out, (ExactPolynomial.constant(1 / divisor[()]), 1)]
        return out

    def _signed(self) -> _Product:
        sign = 1
        while self._next in ("+", "-"):
            if self._take() == "-":
                sign = -sign
        out = self._power()
        return out if sign > 0 else [(ExactPolynomial.constant(Fraction(-1)), 1), *out]

    def _power(self) -> _Product:
        base = self._atom()
        if self._next != "**":
            return base
        self._take()
        self._enter()
        exponent = self._expanded(self._signed())
        self._depth -= 1
        value = exponent.get((), Fraction(0)) if set(exponent) <= {()} else Fraction(-1)
        if value.denominator != 1 or not 0 <= value <= _MAX_DEGREE:
            raise self._refuse(f"exponents are whole numbers from 0 to {_MAX_DEGREE}")
        # Numbers are worked out at once, so that exponents of exponents don't pile up on them.
        return [
            (factor, before * int(value)) if factor.degree else (self._expanded([(factor, int(value))]), 1)
            for factor, before in base
        ]

    def _expanded(self, product: _Product) -> ExactPolynomial:
        out = ExactPolynomial.constant(Fraction(1))
        for factor, exponent in product:
            if exponent > _MAX_DEGREE and factor.degree:
                raise self._refuse(f"the degree is above {_MAX_DEGREE}")
            for _ in range(exponent):
                out = self._times(out, factor)
        return out

    def _enter(self) -> None:
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise self._refuse(f"nested more than {_MAX_DEPTH} deep")

    def _atom(self) -> _Product:
        token = self._take()
        if token == "":
            raise self._refuse("ends where a variable or a number was expected")
        if token == "(":
            self._enter()
            out = self._sum()
            if self._take() != ")":
                raise self._refuse("a closing parenthesis is missing")
            self._depth -= 1
            return out
        if token[0].isalpha() or token[0] == "_":
            return [(self._variable(token), 1)]
        if token[0].isdigit() or token[0] == ".":
            return [(self._number(token), 1)]
        raise self._refuse(f"{token!r} stands where a variable or a number was expected")

    def _variable(self, name: str) -> ExactPolynomial:
        if self._next == "(":
            raise self._refuse(f"{name[:40]!r} can't be called: functions are not part of a polynomial")
        if name not in self._index:
            shown = name if len(name) <= 40 else name[:40] + "..."
            raise self._refuse(f"unknown variable {shown!r}{suggest(name, self._index)}")
        return ExactPolynomial.variable(self._index[name])

    def _number(self, text: str) -> ExactPolynomial:
        exponent = text.lower().partition("e")[2]
        if len(text) > _MAX_NUMBER or abs(int(exponent or 0)) > _MAX_EXPONENT:
            raise self._refuse(
                f"the number {text[:20]}... is out of range "
                f"(at most {_MAX_NUMBER} characters, 1e-{_MAX_EXPONENT} to 1e{_MAX_EXPONENT})"
            )
        value = Fraction(text)
        return ExactPolynomial.constant(value).without_zeros()

    def _check(self, coefficients: Iterable[Fraction]) -> None:
        for c in coefficients:
            if max(c.numerator.bit_length(), c.denominator.bit_length()) > _MAX_BITS:
                raise self._refuse("expands to numbers of thousands of digits")

    def _times(self, a: ExactPolynomial, b: ExactPolynomial) -> ExactPolynomial:
        if len(a) * len(b) > _MAX_TERMS:
            raise self._refuse(f"expands to more than {_MAX_TERMS} terms")
        self._spend(len(a) * len(b))
        if a and b and a.degree + b.degree > _MAX_DEGREE:
            raise self._refuse(f"the degree is above {_MAX_DEGREE}")
        out = (a * b).without_zeros()
        self._check(out.values())
        return out
