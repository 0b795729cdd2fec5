"""Polynomials in floats and in rationals, systems of them, and their canonical form (paper, section 4.1)."""

from .canonical import CanonicalForm, Functions, Rows, TrigFunctions, canonical_form, pack_trig
from .elimination import equations_in_inputs
from .exact import (
    ExactPolynomial,
    Powers,
    WholeForm,
    enclose_fraction,
    evaluate,
    independent,
    normalised,
    simplest_between,
    substitute,
)
from .parse import parse_polynomial
from .polynomial import Polynomial, total
from .presolve import presolve
from .system import BernsteinFunction, PolynomialSystem, SystemBuilder, TrigFunction, bound_polynomial
from .vector import Vector, combine, constant_vector, difference, dot

__all__ = [
    "BernsteinFunction",
    "CanonicalForm",
    "ExactPolynomial",
    "Functions",
    "Polynomial",
    "PolynomialSystem",
    "Powers",
    "Rows",
    "SystemBuilder",
    "TrigFunction",
    "TrigFunctions",
    "Vector",
    "WholeForm",
    "bound_polynomial",
    "canonical_form",
    "combine",
    "constant_vector",
    "difference",
    "dot",
    "enclose_fraction",
    "equations_in_inputs",
    "evaluate",
    "independent",
    "normalised",
    "pack_trig",
    "parse_polynomial",
    "presolve",
    "simplest_between",
    "substitute",
    "total",
]
