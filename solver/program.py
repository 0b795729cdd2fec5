"""A system as a straight-line program: enclosures of variables and equations, with derivatives by inputs."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .polynomial import Polynomial
from .rounding import add, jit, mul, scale, sub
from .system import BernsteinFunction, PolynomialSystem

__all__ = ["Enclosure", "Program"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class _Polynomials(NamedTuple):
    """Polynomials one after another: terms of each, factors of each term."""

    term_start: Index
    coefficient: Array
    factor_start: Index
    factor: Index


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


class Program:
    """Evaluates definitions in order, then equations and inequalities, in outward-rounded arithmetic."""

    def __init__(self, system: PolynomialSystem):
        self.system = system
        self.inputs = system.inputs
        polynomials: list[Polynomial] = []
        steps: list[tuple[int, int, int]] = []  # target, 0 polynomial / 1 function, its number
        functions: list[BernsteinFunction] = []
        for k, value in system.definitions.items():
            if isinstance(value, BernsteinFunction):
                steps.append((k, 1, len(functions)))
                functions.append(value)
            else:
                steps.append((k, 0, len(polynomials)))
                polynomials.append(value)
        self._steps = np.array(steps, dtype=np.int64).reshape(-1, 3)
        self._first_equation = len(polynomials)
        self._first_inequality = len(polynomials) + len(system.equations)
        self._polynomials = _pack([*polynomials, *system.equations, *system.inequalities])
        self._function_ij = np.array([(f.i, f.j) for f in functions], dtype=np.int64).reshape(-1, 2)
        self._degree = np.array(
            [np.subtract(f.coefficients.shape, 1) for f in functions], dtype=np.int64
        ).reshape(-1, 2)
        sizes = [f.coefficients.size for f in functions]
        self._function_start = np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)]).astype(np.int64)
        self._coefficients = np.concatenate([f.coefficients.ravel() for f in functions] or [np.zeros(0)])

    def enclose(self, lower: Array, upper: Array) -> Enclosure:
        """Encloses everything over a box of inputs.

        Args:
            lower: (n,) of which the inputs' entries count.
            upper: (n,) likewise.
        """
        n, m = self.system.size, len(self.inputs)
        lo, hi = np.zeros(n), np.zeros(n)
        lo[self.inputs], hi[self.inputs] = lower[self.inputs], upper[self.inputs]
        grad_lo, grad_hi = np.zeros((n, m)), np.zeros((n, m))
        grad_lo[self.inputs, np.arange(m)] = 1.0
        grad_hi[self.inputs, np.arange(m)] = 1.0
        n_eq, n_in = len(self.system.equations), len(self.system.inequalities)
        out = np.zeros((2, n_eq + n_in))
        slope = np.zeros((2, n_eq + n_in, m))
        _run(
            self._steps, self._polynomials, self._function_ij, self._degree, self._function_start,
            self._coefficients, self._first_equation, lo, hi, grad_lo, grad_hi, out, slope,
        )  # fmt: skip
        return Enclosure(
            lo, hi, out[0, :n_eq], out[1, :n_eq], slope[0, :n_eq], slope[1, :n_eq],
            out[0, n_eq:], slope[0, n_eq:],
        )  # fmt: skip


def _pack(polynomials: list[Polynomial]) -> _Polynomials:
    terms = [list(p.terms.items()) for p in polynomials]
    flat = [term for group in terms for term in group]
    return _Polynomials(
        np.concatenate([[0], np.cumsum([len(group) for group in terms], dtype=np.int64)]).astype(np.int64),
        np.array([c for _, c in flat], dtype=np.float64),
        np.concatenate([[0], np.cumsum([len(m) for m, _ in flat], dtype=np.int64)]).astype(np.int64),
        np.array([i for m, _ in flat for i in m], dtype=np.int64),
    )


@jit
def _polynomial(p, number, lo, hi, grad_lo, grad_hi, out_lo, out_hi):  # type: ignore[no-untyped-def]
    """Value of a polynomial; its gradient is added into `out_*` (m,)."""
    m = len(out_lo)
    total_lo, total_hi = 0.0, 0.0
    for t in range(p.term_start[number], p.term_start[number + 1]):
        c = p.coefficient[t]
        first, last = p.factor_start[t], p.factor_start[t + 1]
        vl, vu = c, c
        for f in range(first, last):
            vl, vu = mul(vl, vu, lo[p.factor[f]], hi[p.factor[f]])
        total_lo, total_hi = add(total_lo, total_hi, vl, vu)
        for f in range(first, last):
            # c times the other factors, times the gradient of this one.
            wl, wu = c, c
            for g in range(first, last):
                if g != f:
                    wl, wu = mul(wl, wu, lo[p.factor[g]], hi[p.factor[g]])
            k = p.factor[f]
            for j in range(m):
                if grad_lo[k, j] != 0.0 or grad_hi[k, j] != 0.0:
                    sl, su = mul(wl, wu, grad_lo[k, j], grad_hi[k, j])
                    out_lo[j], out_hi[j] = add(out_lo[j], out_hi[j], sl, su)
    return total_lo, total_hi


@jit
def _casteljau(values_lo, values_hi, count, stride, xl, xu, steps):  # type: ignore[no-untyped-def]
    """`steps` rounds of de Casteljau in place along a line of `count` interval coefficients."""
    yl, yu = sub(1.0, 1.0, xl, xu)
    for s in range(steps):
        for a in range(count - 1 - s):
            ul, uu = mul(yl, yu, values_lo[a * stride], values_hi[a * stride])
            vl, vu = mul(xl, xu, values_lo[(a + 1) * stride], values_hi[(a + 1) * stride])
            values_lo[a * stride], values_hi[a * stride] = add(ul, uu, vl, vu)


@jit
def _bernstein(b, di, dj, il, iu, jl, ju, by_i, by_j):  # type: ignore[no-untyped-def]
    """Enclosure of a Bernstein function, or of its derivative by x_i or x_j, by de Casteljau on intervals."""
    w = dj + 1
    cl, cu = b.copy(), b.copy()
    ni, nj = di + 1, dj + 1
    if by_i:
        for a in range(di):
            for c in range(w):
                sl, su = sub(b[(a + 1) * w + c], b[(a + 1) * w + c], b[a * w + c], b[a * w + c])
                cl[a * w + c], cu[a * w + c] = scale(float(di), sl, su)
        ni = di
    if by_j:
        for a in range(ni):
            for c in range(dj):
                sl, su = sub(b[a * w + c + 1], b[a * w + c + 1], b[a * w + c], b[a * w + c])
                cl[a * w + c], cu[a * w + c] = scale(float(dj), sl, su)
        nj = dj
    if ni == 0 or nj == 0:
        return 0.0, 0.0
    for c in range(nj):
        _casteljau(cl[c:], cu[c:], ni, w, il, iu, ni - 1)
    _casteljau(cl, cu, nj, 1, jl, ju, nj - 1)
    return cl[0], cu[0]


@jit
def _run(  # type: ignore[no-untyped-def]
    steps,
    p,
    function_ij,
    degree,
    function_start,
    coefficients,
    first_equation,
    lo,
    hi,
    grad_lo,
    grad_hi,
    out,
    slope,
):
    for s in range(len(steps)):
        k, kind, number = steps[s]
        if kind == 0:
            lo[k], hi[k] = _polynomial(p, number, lo, hi, grad_lo, grad_hi, grad_lo[k], grad_hi[k])
            continue
        i, j = function_ij[number]
        di, dj = degree[number]
        b = coefficients[function_start[number] : function_start[number + 1]]
        box = (lo[i], hi[i], lo[j], hi[j])
        lo[k], hi[k] = _bernstein(b, di, dj, *box, False, False)
        for parameter, by_i in ((i, True), (j, False)):
            dl, du = _bernstein(b, di, dj, *box, by_i, not by_i)
            for c in range(grad_lo.shape[1]):
                sl, su = mul(dl, du, grad_lo[parameter, c], grad_hi[parameter, c])
                grad_lo[k, c], grad_hi[k, c] = add(grad_lo[k, c], grad_hi[k, c], sl, su)
    for e in range(out.shape[1]):
        out[0, e], out[1, e] = _polynomial(
            p, first_equation + e, lo, hi, grad_lo, grad_hi, slope[0, e], slope[1, e]
        )
