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
from .factored import FactoredPolynomial
from .fewer_terms import with_fewer_terms
from .parse import parse_factors, parse_polynomial
from .polynomial import Polynomial, total
from .presolve import presolve
from .real_roots import RealRoot, real_roots
from .system import BernsteinFunction, PolynomialSystem, SystemBuilder, TrigFunction, bound_polynomial
from .vector import Vector, combine, constant_vector, difference, dot
from .whole import (
    WholePolynomial,
    common_divisor,
    quotient,
    to_exact,
    whole_polynomial,
    without_multiple_roots,
)

__all__ = [
    "BernsteinFunction",
    "CanonicalForm",
    "ExactPolynomial",
    "FactoredPolynomial",
    "Functions",
    "Polynomial",
    "PolynomialSystem",
    "Powers",
    "RealRoot",
    "Rows",
    "SystemBuilder",
    "TrigFunction",
    "TrigFunctions",
    "Vector",
    "WholeForm",
    "WholePolynomial",
    "bound_polynomial",
    "canonical_form",
    "combine",
    "common_divisor",
    "constant_vector",
    "difference",
    "dot",
    "enclose_fraction",
    "equations_in_inputs",
    "evaluate",
    "independent",
    "normalised",
    "pack_trig",
    "parse_factors",
    "parse_polynomial",
    "presolve",
    "quotient",
    "real_roots",
    "simplest_between",
    "substitute",
    "to_exact",
    "total",
    "whole_polynomial",
    "with_fewer_terms",
    "without_multiple_roots",
]
