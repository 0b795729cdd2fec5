"""Small convex quadratic programs, by daqp."""

import daqp
import numpy as np

from .arrays import Array, Mask

__all__ = ["solve_quadratic_program"]

_EQUALITY = 5  # daqp's code for a row whose bounds are equal and always active


def solve_quadratic_program(
    H: Array, f: Array, A: Array, lower: Array, upper: Array, equal: Mask
) -> Array | None:
    """Minimises z'Hz / 2 + f'z subject to lower <= (z, A z) <= upper.

    Args:
        H: (n, n), positive definite.
        f: (n,)
        A: (m, n), general constraints.
        lower: (n + m,) bounds of the variables, then of the constraints; infinite where there is none.
        upper: (n + m,)
        equal: (n + m,) marks those whose bounds are equal.

    Returns:
        z (n,), or None where the solver finds none.
    """
    sense = np.where(equal, _EQUALITY, 0).astype(np.int32)
    z, _, flag, _ = daqp.solve(H, f, np.ascontiguousarray(A), upper, lower, sense)
    return np.array(z) if flag > 0 else None
