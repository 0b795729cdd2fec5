"""Newton's method and the Krawczyk test: from an approximate solution to a proof that one exists.

For a system with fewer equations than inputs the test runs on a square subset: the inputs that a pivoted
QR of the Jacobian picks are solved for, the others are held at their values (Krawczyk 1969; Neumaier,
"Interval methods for systems of equations", 1990, section 5.1).
"""

from typing import NamedTuple

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from .program import Enclosure, Program
from .rounding import add, jit, mul, sub

__all__ = ["ExistenceTest", "ProvedBox"]

Array = NDArray[np.float64]


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
    held: NDArray[np.int64]


class ExistenceTest:
    """Refines points of one system and proves solutions near them."""

    def __init__(self, program: Program):
        self.program = program
        self.system = program.system

    def refine(self, x: Array, *, max_steps: int = 8, tolerance: float = 1e-14) -> Array | None:
        """Least-norm Newton steps on the inputs of `x` (n,); None where they do not settle."""
        inputs = self.program.inputs
        x = x.copy()
        for _ in range(max_steps):
            enclosure = self.program.enclose(x, x)
            f, J = _middle(enclosure)
            if not (np.isfinite(f).all() and np.isfinite(J).all()):
                return None
            step = np.linalg.lstsq(J, -f, rcond=1e-12)[0]
            x[inputs] += step
            if np.abs(step).max(initial=0.0) < tolerance:
                return x
        return x if np.abs(step).max(initial=0.0) < 1e-9 else None

    def prove(self, x: Array) -> ProvedBox | None:
        """Tries to prove a solution near `x` (n,) that keeps the initial box and all inequalities."""
        refined = self.refine(x)
        if refined is None:
            return None
        x = refined
        inputs = self.program.inputs
        J = _middle(self.program.enclose(x, x))[1]
        n = J.shape[0]
        if n > J.shape[1]:
            return None  # more equations than inputs: no square subset says the same
        order = scipy.linalg.qr(J, mode="r", pivoting=True)[1] if n else np.zeros(0, dtype=np.int64)
        solved = np.sort(order[:n])
        try:
            Y = np.linalg.inv(J[:, solved]).astype(np.float64)
        except np.linalg.LinAlgError:
            return None
        box = self._krawczyk(x, inputs[solved], solved, Y)
        if box is None:
            return None
        enclosure = self.program.enclose(*box)
        if not self._admissible(enclosure):
            return None
        middle = 0.5 * (enclosure.lower + enclosure.upper)
        held = np.setdiff1d(inputs, inputs[solved])
        middle[held] = x[held]
        return ProvedBox(enclosure.lower, enclosure.upper, middle, held)

    def _krawczyk(
        self, x: Array, columns: NDArray[np.int64], solved: NDArray[np.int64], Y: Array
    ) -> tuple[Array, Array] | None:
        at_point = self.program.enclose(x, x)
        newton = np.abs(Y @ _middle(at_point)[0])
        radius = 2.0 * newton + 1e-15 * (1.0 + np.abs(x[columns]))
        for _ in range(6):
            lower, upper = x.copy(), x.copy()
            lower[columns] -= radius
            upper[columns] += radius
            over_box = self.program.enclose(lower, upper)
            low, high = _krawczyk_step(
                x[columns], lower[columns], upper[columns], Y, at_point.value_lower, at_point.value_upper,
                np.ascontiguousarray(over_box.slope_lower[:, solved]),
                np.ascontiguousarray(over_box.slope_upper[:, solved]),
            )  # fmt: skip
            if not (np.isfinite(low).all() and np.isfinite(high).all()):
                return None
            if np.all(low > lower[columns]) and np.all(high < upper[columns]):
                # The solution is unique in the larger box and lies in the image as well.
                lower[columns], upper[columns] = low, high
                return lower, upper
            radius = 2.0 * np.maximum(high - x[columns], x[columns] - low) + 1e-16
            if radius.max() > 1e-4:
                return None
        return None

    def _admissible(self, enclosure: Enclosure) -> bool:
        """Whether every point of the enclosure keeps the initial box and the inequalities."""
        inside = np.all(enclosure.lower >= self.system.lower) and np.all(enclosure.upper <= self.system.upper)
        return bool(inside and np.all(enclosure.slack_lower >= 0.0))


def _middle(enclosure: Enclosure) -> tuple[Array, Array]:
    return (
        0.5 * (enclosure.value_lower + enclosure.value_upper),
        0.5 * (enclosure.slope_lower + enclosure.slope_upper),
    )


@jit
def _krawczyk_step(x, lower, upper, Y, f_lower, f_upper, J_lower, J_upper):  # type: ignore[no-untyped-def]
    """K = x - Y f(x) + (I - Y J(X)) (X - x), outward rounded."""
    n = len(x)
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
