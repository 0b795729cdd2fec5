"""A system as a straight-line program: enclosures of variables and equations, with derivatives by inputs."""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices, offsets
from ..interval import add, mul
from ..polynomial import (
    BernsteinFunction,
    Polynomial,
    PolynomialSystem,
    TrigFunction,
    TrigFunctions,
    pack_trig,
)
from .bernstein import bernstein_value
from .trig import trig_slope, trig_value

__all__ = ["Enclosure", "ProgramTables", "StraightLineProgram", "enclose"]


class _Polynomials(NamedTuple):
    """Polynomials one after another: terms of each, factors of each term."""

    term_start: Indices
    coefficient: Array
    factor_start: Indices
    factor: Indices


class Enclosure(NamedTuple):
    """Enclosures over a box of inputs.

    Attributes:
        lower: (n,) of all variables.
        upper: (n,)
        value_lower: (n_equations,) of the equations.
        value_upper: (n_equations,)
        slope_lower: (n_equations, n_inputs) of their derivatives.
        slope_upper: (n_equations, n_inputs)
        slack_lower: (n_inequalities,) lower ends of the inequalities.
        slack_slope_lower: (n_inequalities, n_inputs) lower ends of their derivatives.
    """

    lower: Array
    upper: Array
    value_lower: Array
    value_upper: Array
    slope_lower: Array
    slope_upper: Array
    slack_lower: Array
    slack_slope_lower: Array


class ProgramTables(NamedTuple):
    """A program as compiled loops take it.

    Attributes:
        inputs: (n_inputs,) indices of the variables that no step fills.
        steps: (n_steps, 3) variable, 0 for a polynomial, 1 for a Bernstein function or 2 for a cosine or
            sine, its number.
        polynomials: of the steps, the equations and the inequalities.
        first_equation: number of the polynomial of the first equation.
        n_equations: how many polynomials from there on are equations; the others are inequalities.
        needed_start: (n + 1,) where a variable's entries in `needed` begin.
        needed: positions in `inputs` of those that a variable depends on.
        function_ij: (n_functions, 2) the two parameters of each Bernstein function.
        degree: (n_functions, 2)
        function_start: (n_functions + 1,) where the coefficients of each begin.
        coefficients: of all functions, row by row.
        trig: cosines and sines.
        lower: (n,) the initial box of all variables.
        upper: (n,)
    """

    inputs: Indices
    steps: Indices
    polynomials: _Polynomials
    first_equation: int
    n_equations: int
    needed_start: Indices
    needed: Indices
    function_ij: Indices
    degree: Indices
    function_start: Indices
    coefficients: Array
    trig: TrigFunctions
    lower: Array
    upper: Array


class StraightLineProgram:
    """Evaluates definitions in order, then equations and inequalities, in outward-rounded arithmetic."""

    def __init__(self, system: PolynomialSystem):
        self.system = system
        self.inputs = system.inputs
        self.tables = _tables(system)

    def enclose(self, lower: Array, upper: Array) -> Enclosure:
        """Encloses everything over a box of inputs.

        Args:
            lower: (n,) of which the inputs' entries count.
            upper: (n,) likewise.
        """
        return Enclosure(*enclose(self.tables, lower, upper, len(self.inputs)))

    def complete(self, x: Array) -> Array:
        """The vector (n,) with definitions filled in from the inputs of `x` (n,), to rounding."""
        lower, upper = enclose(self.tables, x, x, 0)[:2]
        return np.asarray(0.5 * (lower + upper))


def _tables(system: PolynomialSystem) -> ProgramTables:
    polynomials: list[Polynomial] = []
    steps: list[tuple[int, int, int]] = []
    functions: list[BernsteinFunction] = []
    trig: list[tuple[int, TrigFunction]] = []
    needed: list[set[int]] = [set() for _ in range(system.size)]
    for position, k in enumerate(system.inputs):
        needed[k].add(position)
    for k, value in system.definitions.items():
        if isinstance(value, BernsteinFunction):
            steps.append((k, 1, len(functions)))
            functions.append(value)
        elif isinstance(value, TrigFunction):
            steps.append((k, 2, len(trig)))
            trig.append((k, value))
        else:
            steps.append((k, 0, len(polynomials)))
            polynomials.append(value)
        needed[k] = set().union(*(needed[i] for i in value.variables))
    sizes = [f.coefficients.size for f in functions]
    return ProgramTables(
        inputs=system.inputs,
        steps=np.array(steps, dtype=np.int64).reshape(-1, 3),
        polynomials=_pack([*polynomials, *system.equations, *system.inequalities]),
        first_equation=len(polynomials),
        n_equations=len(system.equations),
        needed_start=offsets([len(one) for one in needed]),
        needed=np.array([j for one in needed for j in sorted(one)], dtype=np.int64),
        function_ij=np.array([(f.i, f.j) for f in functions], dtype=np.int64).reshape(-1, 2),
        degree=np.array([np.subtract(f.coefficients.shape, 1) for f in functions], dtype=np.int64).reshape(
            -1, 2
        ),
        function_start=offsets(sizes),
        coefficients=np.concatenate([f.coefficients.ravel() for f in functions] or [np.zeros(0)]),
        trig=pack_trig(trig),
        lower=np.array(system.lower, dtype=float),
        upper=np.array(system.upper, dtype=float),
    )


def _pack(polynomials: list[Polynomial]) -> _Polynomials:
    terms = [list(p.terms.items()) for p in polynomials]
    flat = [term for group in terms for term in group]
    return _Polynomials(
        offsets([len(group) for group in terms]),
        np.array([c for _, c in flat], dtype=np.float64),
        offsets([len(m) for m, _ in flat]),
        np.array([i for m, _ in flat for i in m], dtype=np.int64),
    )


@compiled
def _polynomial(
    t: ProgramTables,
    number: int,
    lo: Array,
    hi: Array,
    grad_lo: Array,
    grad_hi: Array,
    out_lo: Array,
    out_hi: Array,
) -> tuple[float, float]:
    """Value of a polynomial; its gradient is added into `out_*` (m,), of any length but zero."""
    p = t.polynomials
    total_lo, total_hi = 0.0, 0.0
    for term in range(p.term_start[number], p.term_start[number + 1]):
        c = p.coefficient[term]
        first, last = p.factor_start[term], p.factor_start[term + 1]
        vl, vu = c, c
        for f in range(first, last):
            vl, vu = mul(vl, vu, lo[p.factor[f]], hi[p.factor[f]])
        total_lo, total_hi = add(total_lo, total_hi, vl, vu)
        if len(out_lo) == 0:
            continue
        for f in range(first, last):
            # c times the other factors, times the gradient of this one.
            wl, wu = c, c
            for g in range(first, last):
                if g != f:
                    wl, wu = mul(wl, wu, lo[p.factor[g]], hi[p.factor[g]])
            k = p.factor[f]
            for d in range(t.needed_start[k], t.needed_start[k + 1]):
                j = t.needed[d]
                if grad_lo[k, j] != 0.0 or grad_hi[k, j] != 0.0:
                    sl, su = mul(wl, wu, grad_lo[k, j], grad_hi[k, j])
                    out_lo[j], out_hi[j] = add(out_lo[j], out_hi[j], sl, su)
    return total_lo, total_hi


@compiled
def enclose(
    t: ProgramTables, lower: Array, upper: Array, n_slopes: int
) -> tuple[Array, Array, Array, Array, Array, Array, Array, Array]:
    """The parts of an `Enclosure` over a box of inputs, in its order.

    Args:
        t: the program's tables.
        lower: (n,) of which the inputs' entries count.
        upper: (n,) likewise.
        n_slopes: number of inputs; or zero, for enclosures without derivatives.
    """
    n = len(t.lower)
    n_values = len(t.polynomials.term_start) - 1 - t.first_equation
    lo, hi = np.zeros(n), np.zeros(n)
    grad_lo, grad_hi = np.zeros((n, n_slopes)), np.zeros((n, n_slopes))
    for j in range(len(t.inputs)):
        k = t.inputs[j]
        lo[k], hi[k] = lower[k], upper[k]
        if n_slopes:
            grad_lo[k, j] = grad_hi[k, j] = 1.0
    for s in range(len(t.steps)):
        k, kind, number = t.steps[s]
        if kind == 0:
            lo[k], hi[k] = _polynomial(t, number, lo, hi, grad_lo, grad_hi, grad_lo[k], grad_hi[k])
        elif kind == 1:
            _function(t, k, number, lo, hi, grad_lo, grad_hi)
        else:
            _trig(t, number, lo, hi, grad_lo, grad_hi)
    out_lo, out_hi = np.zeros(n_values), np.zeros(n_values)
    slope_lo, slope_hi = np.zeros((n_values, n_slopes)), np.zeros((n_values, n_slopes))
    for e in range(n_values):
        out_lo[e], out_hi[e] = _polynomial(
            t, t.first_equation + e, lo, hi, grad_lo, grad_hi, slope_lo[e], slope_hi[e]
        )
    m = t.n_equations
    return lo, hi, out_lo[:m], out_hi[:m], slope_lo[:m], slope_hi[:m], out_lo[m:], slope_lo[m:]


@compiled
def _function(
    t: ProgramTables, k: int, number: int, lo: Array, hi: Array, grad_lo: Array, grad_hi: Array
) -> None:
    """Fills variable k with a Bernstein function and its gradient."""
    i, j = t.function_ij[number]
    di, dj = t.degree[number]
    b = t.coefficients[t.function_start[number] : t.function_start[number + 1]]
    lo[k], hi[k] = bernstein_value(b, di, dj, lo[i], hi[i], lo[j], hi[j], False, False)
    if grad_lo.shape[1] == 0:
        return
    for parameter, by_i in ((i, True), (j, False)):
        dl, du = bernstein_value(b, di, dj, lo[i], hi[i], lo[j], hi[j], by_i, not by_i)
        for d in range(t.needed_start[parameter], t.needed_start[parameter + 1]):
            c = t.needed[d]
            sl, su = mul(dl, du, grad_lo[parameter, c], grad_hi[parameter, c])
            grad_lo[k, c], grad_hi[k, c] = add(grad_lo[k, c], grad_hi[k, c], sl, su)


@compiled
def _trig(t: ProgramTables, number: int, lo: Array, hi: Array, grad_lo: Array, grad_hi: Array) -> None:
    """Fills a variable with a cosine or sine and its gradient."""
    k, i = t.trig.ki[number]
    kind, ratio, offset = t.trig.kind[number], t.trig.ratio[number], t.trig.offset[number]
    lo[k], hi[k] = trig_value(kind, ratio, offset, lo[i], hi[i])
    if grad_lo.shape[1] == 0:
        return
    dl, du = trig_slope(kind, ratio, offset, lo[i], hi[i])
    for d in range(t.needed_start[i], t.needed_start[i + 1]):
        c = t.needed[d]
        grad_lo[k, c], grad_hi[k, c] = mul(dl, du, grad_lo[i, c], grad_hi[i, c])
