"""Polynomials from text such as `x**2 + 2*x*(y - 1/3) - 0.5`, with decimals taken exactly."""

import ast
from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

from ..errors import InputError, suggest

__all__ = ["ExactPolynomial", "parse_polynomial"]

# Coefficients by monomial; a monomial lists (variable, exponent) with exponents >= 1, variables ascending.
ExactPolynomial: TypeAlias = dict[tuple[tuple[int, int], ...], Fraction]

_MAX_DEGREE = 60
_MAX_TERMS = 20_000
_MAX_DIGITS = 400


def parse_polynomial(text: str, names: Sequence[str], source: str, field: str) -> ExactPolynomial:
    """Parses a polynomial in the named variables.

    Numbers, + - * / by a number, ** (or ^) with a whole exponent, and parentheses are understood.

    Raises:
        InputError: for anything else, naming what was not understood.
    """
    if len(text) > 100_000:
        raise InputError(source, field, "longer than 100000 characters")
    try:
        tree = ast.parse(text.replace("^", "**").strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise InputError(source, field, f"not an expression: {text[:60]!r}") from None
    index = {name: i for i, name in enumerate(names)}
    try:
        return _Reader(index, text, source, field).read(tree.body)
    except RecursionError:
        raise InputError(source, field, "nested too deeply") from None


class _Reader:
    """Turns a syntax tree into a polynomial."""

    def __init__(self, index: dict[str, int], text: str, source: str, field: str):
        self._index = index
        self._text = text.replace("^", "**").strip()
        self._source = source
        self._field = field

    def _refuse(self, what: str) -> InputError:
        return InputError(self._source, self._field, what)

    def read(self, node: ast.expr) -> ExactPolynomial:
        match node:
            case ast.Constant():
                return self._number(node)
            case ast.Name():
                if node.id not in self._index:
                    raise self._refuse(f"unknown variable {node.id!r}{suggest(node.id, self._index)}")
                return {((self._index[node.id], 1),): Fraction(1)}
            case ast.UnaryOp(op=ast.UAdd()):
                return self.read(node.operand)
            case ast.UnaryOp(op=ast.USub()):
                return _scaled(self.read(node.operand), Fraction(-1))
            case ast.BinOp():
                return self._operation(node)
        raise self._refuse(
            f"{ast.unparse(node)[:40]!r} is not part of a polynomial (allowed: + - * / ** and numbers)"
        )

    def _number(self, node: ast.Constant) -> ExactPolynomial:
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            raise self._refuse(f"{node.value!r} is not a number")
        # The text of the number, not its float: 0.1 means one tenth.
        text = ast.get_source_segment(self._text, node) or repr(node.value)
        try:
            value = Fraction(text.replace("_", ""))
        except ValueError:
            value = Fraction(node.value)
        if value != 0 and not Fraction(1, 10**_MAX_DIGITS) < abs(value) < 10**_MAX_DIGITS:
            raise self._refuse(f"the number {text[:30]} is out of range")
        return {(): value} if value else {}

    def _operation(self, node: ast.BinOp) -> ExactPolynomial:
        left, right = self.read(node.left), self.read(node.right)
        match node.op:
            case ast.Add():
                return _sum(left, right)
            case ast.Sub():
                return _sum(left, _scaled(right, Fraction(-1)))
            case ast.Mult():
                return self._product(left, right)
            case ast.Div():
                if set(right) != {()}:
                    raise self._refuse("division is by a number other than zero only")
                return _scaled(left, 1 / right[()])
            case ast.Pow():
                exponent = right.get((), Fraction(0)) if set(right) <= {()} else Fraction(-1)
                if exponent.denominator != 1 or not 0 <= exponent <= _MAX_DEGREE:
                    raise self._refuse(f"exponents are whole numbers from 0 to {_MAX_DEGREE}")
                return self._power(left, int(exponent))
        raise self._refuse(f"{ast.unparse(node)[:40]!r} is not part of a polynomial")

    def _power(self, base: ExactPolynomial, exponent: int) -> ExactPolynomial:
        out: ExactPolynomial = {(): Fraction(1)}
        for _ in range(exponent):
            out = self._product(out, base)
        return out

    def _product(self, a: ExactPolynomial, b: ExactPolynomial) -> ExactPolynomial:
        if len(a) * len(b) > _MAX_TERMS:
            raise self._refuse(f"expands to more than {_MAX_TERMS} terms")
        out: ExactPolynomial = {}
        for m, c in a.items():
            for n, d in b.items():
                exponents = dict(m)
                for variable, e in n:
                    exponents[variable] = exponents.get(variable, 0) + e
                if sum(exponents.values()) > _MAX_DEGREE:
                    raise self._refuse(f"the degree is above {_MAX_DEGREE}")
                key = tuple(sorted(exponents.items()))
                out[key] = out.get(key, Fraction(0)) + c * d
        return {m: c for m, c in out.items() if c}


def _sum(a: ExactPolynomial, b: ExactPolynomial) -> ExactPolynomial:
    out = dict(a)
    for m, c in b.items():
        out[m] = out.get(m, Fraction(0)) + c
    return {m: c for m, c in out.items() if c}


def _scaled(a: ExactPolynomial, factor: Fraction) -> ExactPolynomial:
    return {m: c * factor for m, c in a.items()} if factor else {}
