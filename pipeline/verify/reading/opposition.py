"""How well contacts press against each other, by the directions in which they press alone."""

from math import inf, sqrt

import numpy as np
from scipy.optimize import nnls

from ....base.numeric.arrays import Array

__all__ = ["friction_to_oppose", "unopposed"]

# Weight of the condition that shares sum up to one; what comes out does not depend on it.
_SUM = 10.0


def unopposed(normals: Array) -> float:
    """What is left of pressing forces of sum 1 that cancel each other best: 0 to 1; 1 for none or one.

    Args:
        normals: (k, 3) unit vectors along which contacts press.
    """
    if len(normals) < 2:
        return 1.0
    rows = np.vstack([normals.T, np.full(len(normals), _SUM)])
    shares, _ = nnls(rows, np.array([0.0, 0.0, 0.0, _SUM]))
    return float(np.linalg.norm(normals.T @ shares) / shares.sum())


def friction_to_oppose(normals: Array) -> float:
    """The least friction at which forces of these contacts can cancel each other; infinite for none.

    Their torques are left out: an object is free to turn between jaws until pads lie flush with it. So it
    says the same of fingers that are far apart and of those on both sides of a wall. Forces within friction
    cones of half angle a cancel if, and only if, what is left of the normals is at most sin a.

    Args:
        normals: (k, 3) unit vectors along which contacts press.
    """
    left = unopposed(normals)
    return left / sqrt(1.0 - left * left) if left < 1.0 else inf
