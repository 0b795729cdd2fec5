"""How wrong the relaxation is at a point: the gaps in products and functions that splits close."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...geometry import de_casteljau
from ..interval import COSINE
from ..polynomial import CanonicalForm, Functions

__all__ = ["errors_by_factor", "relaxation_errors"]


def relaxation_errors(form: CanonicalForm, x: Array) -> Array:
    """|x_k - x_i x_j| of each product, then |x_k - f(x_i, x_j)| of each function, at x (n,).

    In the order of `CanonicalForm.factors`.
    """
    k, i, j = form.products.T
    errors = [np.abs(x[k] - x[i] * x[j]), _function_errors(x, form.functions)]
    if len(form.trig.ki):
        k, i = form.trig.ki.T
        angle = form.trig.ratio * x[i] + form.trig.offset
        value = np.where(form.trig.kind == COSINE, np.cos(angle), np.sin(angle))
        errors.append(np.abs(x[k] - value))
    return np.concatenate(errors)


def errors_by_factor(form: CanonicalForm, x: Array) -> Array:
    """By column (n,): the sum of the errors at x (n,) of the products and functions it is a factor of."""
    score = np.zeros(form.size)
    np.add.at(score, form.factors, relaxation_errors(form, x)[:, None])
    return score


@compiled
def _function_errors(x: Array, functions: Functions) -> Array:
    """|x_k - f(x_i, x_j)| of each function (m,)."""
    kij, degree, start, coefficients = functions
    errors = np.zeros(len(kij))
    for f in range(len(kij)):
        k, i, j = kij[f]
        di, dj = degree[f]
        by_row = np.empty(di + 1)
        for p in range(di + 1):
            first = start[f] + p * (dj + 1)
            by_row[p] = de_casteljau(coefficients[first : first + dj + 1].copy(), x[j])
        errors[f] = abs(x[k] - de_casteljau(by_row, x[i]))
    return errors
