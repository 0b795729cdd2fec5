"""Newton's method and the Krawczyk test: from an approximate solution to a proof that one exists.

For a system with fewer equations than inputs the test runs on a square subset: the inputs that a pivoted
QR of the Jacobian picks are solved for, the others are held at their values (Krawczyk 1969; Neumaier,
"Interval methods for systems of equations", 1990, section 5.1).
"""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices, Mask
from ...base.numeric.linalg import damped_step, largest_row, square_inverse
from ..enclosure import ProgramTables, StraightLineProgram, enclose
from ..interval import Interval, add, mul, sub

__all__ = ["ExistenceTest", "ProvedBox"]


_MOST_STEPS = 8
# After a step as short as this what is missing is of the order of its square, which is below rounding.
_SETTLED = 1e-9
# As a share of the largest entry on the diagonal of J J^T; see `damped_step`.
_DAMPING = 1e-14
_MOST_WIDENINGS, _WIDEST = 6, 1e-4


class ProvedBox(NamedTuple):
    """A box that is proved to hold a true solution.

    Attributes:
        lower: (n,) of all variables; where an input is held, both ends are its value.
        upper: (n,)
        middle: (n,) the refined point, with defined variables at their middle.
        held: indices of the inputs held at their value.
    """

    lower: Array
    upper: Array
    middle: Array
    held: Indices


class ExistenceTest:
    """Refines points of one system and proves solutions near them."""

    def __init__(self, program: StraightLineProgram):
        self.program = program
        self.system = program.system

    def refine(self, x: Array) -> Array | None:
        """Least-norm Newton steps on the inputs of `x` (n,); None where they do not settle."""
        x, J = x.copy(), np.empty((len(self.system.equations), len(self.program.inputs)))
        return x if _refine(self.program.tables, x, J) else None

    def prove(self, x: Array) -> ProvedBox | None:
        """Tries to prove a solution near `x` (n,) that keeps the initial box and all inequalities."""
        inputs = self.program.inputs
        if len(self.system.equations) > len(inputs):
            return None  # no square subset of the inputs says the same
        x, held = x.copy(), np.ones(len(x), dtype=bool)
        held[list(self.system.definitions)] = False
        lower, upper = np.empty(len(x)), np.empty(len(x))
        if not _prove(self.program.tables, x, lower, upper, held):
            return None
        return ProvedBox(lower, upper, x, np.flatnonzero(held))


@compiled
def _refine(t: ProgramTables, x: Array, J: Array) -> bool:
    """Least-norm Newton steps in place; whether they settle. J (m, n_inputs) receives slopes next to x."""
    step = np.empty(len(t.inputs))
    for _ in range(_MOST_STEPS):
        _, _, f_lower, f_upper, J_lower, J_upper, _, _ = enclose(t, x, x, len(t.inputs))
        f = 0.5 * (f_lower + f_upper)
        for e in range(len(f)):
            for j in range(len(step)):
                J[e, j] = 0.5 * (J_lower[e, j] + J_upper[e, j])
        if not (np.isfinite(f).all() and np.isfinite(J).all()):
            return False
        damped_step(J, f, _DAMPING * largest_row(J), step)
        longest = 0.0
        for j in range(len(step)):
            x[t.inputs[j]] += step[j]
            longest = max(longest, abs(step[j]))
        if longest < _SETTLED:
            return True
    return False


@compiled
def _prove(t: ProgramTables, x: Array, lower: Array, upper: Array, held: Mask) -> bool:
    """`ExistenceTest.prove` on arrays (n,).

    Args:
        t: the program.
        x: the point; becomes the refined point, with defined variables at their middle.
        lower: receives the box.
        upper: likewise.
        held: marks inputs; those that are solved for are taken out.
    """
    m = t.n_equations
    J = np.empty((m, len(t.inputs)))
    if not _refine(t, x, J):
        return False
    _, _, f_lower, f_upper, _, _, _, _ = enclose(t, x, x, 0)
    rows, solved, Y = np.empty(m, dtype=np.int64), np.empty(m, dtype=np.int64), np.empty((m, m))
    if not square_inverse(J, np.ones(len(t.inputs)), rows, solved, Y):
        return False
    columns = t.inputs[solved]
    for k in range(len(x)):
        lower[k] = upper[k] = x[k]
    if not _krawczyk(t, x, columns, solved, Y, (f_lower, f_upper), (lower, upper)):
        return False
    low, high, _, _, _, _, slack, _ = enclose(t, lower, upper, 0)
    # Every point of the enclosure has to keep the initial box and the inequalities.
    for k in range(len(low)):
        if not (low[k] >= t.lower[k] and high[k] <= t.upper[k]):
            return False
    for value in slack:
        if not value >= 0.0:
            return False
    for k in columns:
        held[k] = False
    for k in range(len(x)):
        lower[k], upper[k] = low[k], high[k]
        if not held[k]:
            x[k] = 0.5 * (low[k] + high[k])
    return True


@compiled
def _krawczyk(
    t: ProgramTables, x: Array, columns: Indices, solved: Indices, Y: Array, f: Interval, box: Interval
) -> bool:
    """Widens a box around x in `columns` until it is proved to hold one solution there.

    The box becomes the image of what was proved, which holds the solution as well.
    """
    n = len(columns)
    lower, upper = box
    radius = np.empty(n)
    for a in range(n):
        newton = 0.0
        for b in range(n):
            newton += Y[a, b] * 0.5 * (f[0][b] + f[1][b])
        radius[a] = 2.0 * abs(newton) + 1e-15 * (1.0 + abs(x[columns[a]]))
    for _ in range(_MOST_WIDENINGS):
        for a in range(n):
            lower[columns[a]], upper[columns[a]] = x[columns[a]] - radius[a], x[columns[a]] + radius[a]
        _, _, _, _, J_lower, J_upper, _, _ = enclose(t, lower, upper, len(t.inputs))
        around, J = (lower[columns], upper[columns]), (J_lower[:, solved], J_upper[:, solved])
        low, high = _krawczyk_step(x[columns], around, Y, f, J)
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            return False
        inside, widest = True, 0.0
        for a in range(n):
            k = columns[a]
            inside = inside and low[a] > lower[k] and high[a] < upper[k]
            radius[a] = 2.0 * max(high[a] - x[k], x[k] - low[a]) + 1e-16
            widest = max(widest, radius[a])
        if inside:
            for a in range(n):
                lower[columns[a]], upper[columns[a]] = low[a], high[a]
            return True
        if widest > _WIDEST:
            return False
    return False


@compiled
def _krawczyk_step(x: Array, box: Interval, Y: Array, f: Interval, J: Interval) -> tuple[Array, Array]:
    """K = x - Y f(x) + (I - Y J(X)) (X - x), outward rounded."""
    n = len(x)
    (lower, upper), (f_lower, f_upper), (J_lower, J_upper) = box, f, J
    low, high = np.zeros(n), np.zeros(n)
    for a in range(n):
        kl, ku = x[a], x[a]
        for b in range(n):
            pl, pu = mul(Y[a, b], Y[a, b], f_lower[b], f_upper[b])
            kl, ku = sub(kl, ku, pl, pu)
        for c in range(n):
            gl, gu = (1.0, 1.0) if a == c else (0.0, 0.0)
            for b in range(n):
                if J_lower[b, c] != 0.0 or J_upper[b, c] != 0.0:
                    pl, pu = mul(Y[a, b], Y[a, b], J_lower[b, c], J_upper[b, c])
                    gl, gu = sub(gl, gu, pl, pu)
            dl, du = sub(lower[c], upper[c], x[c], x[c])
            pl, pu = mul(gl, gu, dl, du)
            kl, ku = add(kl, ku, pl, pu)
        low[a], high[a] = kl, ku
    return low, high
