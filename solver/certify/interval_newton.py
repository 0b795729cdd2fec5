"""Proofs that a box holds exactly one solution of a square polynomial system, and where precisely.

Equations are evaluated exactly at points, so that the enclosure of a solution is as narrow as its condition
and the floats allow; the rest is interval arithmetic.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache

import numpy as np

from ...base.numeric.arrays import Array
from ...base.numeric.linalg import square_inverse
from ..contraction import CERTIFIED, contract_native, newton_step, pivot_weights, smear
from ..enclosure import Expansion, centre_slopes, curvatures, native_system, values_and_slopes
from ..interval import Interval, is_within
from ..linear import vertex_program
from ..polynomial import ExactPolynomial, WholeForm, enclose_fraction

__all__ = ["Certifier", "compile_kernels"]


class Certifier:
    """The Newton test on boxes of one system of m equations in n unknowns."""

    def __init__(self, equations: Sequence[ExactPolynomial], n: int):
        self.m, self.n = len(equations), n
        self.system = native_system(equations, n)
        self.program = vertex_program(equations, n)
        self._whole_forms = [WholeForm(equation) for equation in equations]
        self._H = tuple(np.zeros(len(self.system.pair_user)) for _ in range(2))
        self.workspace = Expansion(
            *(np.zeros(self.m) for _ in range(2)), *(np.zeros((self.m, n)) for _ in range(4)), *self._H
        )

    def approximate(self, x: Array, within: Interval | None = None) -> Array | None:
        """Newton's method from x, least-norm where the Jacobian is not square or singular.

        Args:
            x: (n,)
            within: a box that is given up when it is left.

        Returns:
            Where it comes to rest, or None.
        """
        for _ in range(12):
            f, J = self.middle_slopes(x)
            if not (np.isfinite(f).all() and np.isfinite(J).all()):
                return None
            try:
                step = np.linalg.lstsq(J, -f, rcond=1e-10)[0]
            except np.linalg.LinAlgError:
                return None
            x = x + step
            if within is not None and not is_within((x, x), within):
                return None
            size = np.abs(step).max(initial=0.0) / (1.0 + np.abs(x).max(initial=0.0))
            if size < 1e-13:
                return x
        # Where solutions are ill-conditioned, rounding keeps the steps above that.
        return x if size < 1e-6 else None

    def middle_slopes(self, x: Array) -> tuple[Array, Array]:
        """Values (m,) and slopes (m, n) at a point, to rounding."""
        f_lower, f_upper, J_lower, J_upper = self._slopes(x, x)
        return 0.5 * (f_lower + f_upper), 0.5 * (J_lower + J_upper)

    def _slopes(self, lower: Array, upper: Array) -> tuple[Array, Array, Array, Array]:
        out = np.zeros(self.m), np.zeros(self.m), np.zeros((self.m, self.n)), np.zeros((self.m, self.n))
        values_and_slopes(self.system, lower, upper, *out)
        return out

    def exact_values(self, x: Array) -> Interval:
        """The two floats next to the exact value of each equation at a point of floats."""
        ratios = [v.as_integer_ratio() for v in x.tolist()]
        denominator = max(below for _, below in ratios)  # all are powers of two
        numerators = [above * (denominator // below) for above, below in ratios]
        ends = [enclose_fraction(f.value_of_ratios(numerators, denominator)) for f in self._whole_forms]
        return np.array([lo for lo, _ in ends]), np.array([hi for _, hi in ends])

    def test(self, x: Array, box: Interval, values: Interval | None = None) -> tuple[bool, Interval]:
        """The Newton test on a box around x.

        Args:
            x: (n,) point in the box.
            box: the box.
            values: enclosures of the equations at x, where they are known already.

        Returns:
            Whether the box is proved to hold exactly one solution (with fewer equations than unknowns: for
            all values of those unknowns that have no width), and a part of it that holds all its solutions.
        """
        low, high = box[0].copy(), box[1].copy()
        k = min(self.m, self.n)
        rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
        Y = np.empty((k, self.m))
        _, _, J0_lower, J0_upper = self._slopes(x, x)
        weight = pivot_weights(low, high)
        if self.m > self.n or not square_inverse(0.5 * (J0_lower + J0_upper), weight, rows, columns, Y):
            return False, (low, high)
        f_lower, f_upper = self.exact_values(x) if values is None else values
        _, _, J_lower, J_upper = self._slopes(low, high)
        at = Expansion(f_lower, f_upper, J0_lower, J0_upper, J_lower, J_upper, *self._H)
        curvatures(self.system, low, high, *self._H)
        centre_slopes(self.system, x, low, high, at)
        status = newton_step(self.system, x, low, high, columns, Y, at)
        return bool(status == CERTIFIED), (low, high)

    def refine(self, box: Interval, scale: Array) -> Interval:
        """A part, as small as can be found, of a box with exactly one solution that holds the solution.

        Args:
            box: the box.
            scale: (n,) as in `widest_unique`.
        """
        for _ in range(60):
            width = box[1] - box[0]
            _, (low, high) = self.test(0.5 * (box[0] + box[1]), box)
            if np.any(low > high):  # can't be for a box that holds one
                break
            box = low, high
            if np.all(high - low > 0.5 * width):
                # From the middle it goes no further, but it may from next to the solution.
                x = self.approximate(0.5 * (low + high))
                near = None if x is None else self.widest_unique(x, np.minimum(scale, 0.25 * width))
                if near is None or not is_within(near, box):
                    break
                box = near
        return box

    def widest_unique(self, x: Array, scale: Array) -> Interval | None:
        """The widest box tried around the approximate solution x in which exactly one solution is proved.

        Args:
            x: (n,)
            scale: (n,) the widest radius to try.
        """
        values = self.exact_values(x)
        least = 4.0 * np.spacing(np.abs(x))
        share = 1.0
        while share >= 1e-15:
            radius = np.maximum(share * scale, least)
            box = x - radius, x + radius
            if self.test(x, box, values)[0]:
                return box
            share /= 4.0
        return None


@cache
def compile_kernels() -> None:
    """Compiles what is not compiled yet, so that nobody's time budget pays for it."""
    certifier = Certifier([ExactPolynomial({((0, 2),): Fraction(1), (): Fraction(-1)})], 1)
    lower, upper = np.array([-3.0]), np.array([2.0])
    contract_native(certifier.system, certifier.program, lower, upper, certifier.workspace, 2)
    smear(certifier.system, lower, upper, certifier.workspace)
    certifier.widest_unique(np.array([1.0]), np.array([1.0]))
