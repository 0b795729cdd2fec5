"""How a squeeze answers a load: the change of forces of least energy that balances it, all contacts sticking.

Servos are springs, so with C = T^T diag(1/k) T, plus what the skin gives, the change under a wrench w is

    df = -C^-1 G^T (G C^-1 G^T)^+ w,

with a pseudo-inverse, because few contacts can't resist every load. It is that of the contacts as points:
where in a wide one the change is centred is left to the plan.
"""

from functools import lru_cache

import numpy as np

from ...base.numeric.arrays import Array
from .statics import ARM_M, WRENCH_SCALE, Statics

__all__ = ["elastic_response", "normals_slope"]

# Compliance of skin and structure beside that of the servos, in m/N: without it, a contact that no joint can
# move would be rigid.
_SKIN_COMPLIANCE = 1e-5
_RANK = 1e-9


def elastic_response(statics: Statics, loads: Array) -> Array:
    """Changes (k, 4 n) of the contact vector, of contacts as points, under wrenches `loads` (k, 6)."""
    spread, inverse, _ = _resistance(statics)
    return -(spread @ inverse @ (loads * WRENCH_SCALE).T).T


def normals_slope(statics: Statics, load: Array) -> tuple[Array, Array]:
    """How the sum of the changes of normal forces under `load` (6,) depends on G and T, all else the same.

    Returns:
        Weights W_G (6, 4 m) and W_T (n_independent, 4 m): its change is that of the sum of W_G G + W_T T.
    """
    B, inverse, C = _resistance(statics)
    n, G, T = len(C), statics.G[:, : len(C)], statics.T[:, : len(C)]
    v = WRENCH_SCALE * load
    normal = np.zeros(len(C))
    normal[0::4] = 1.0
    softness: Array = np.linalg.solve(C, normal).astype(np.float64)
    # The sum is -normal . B a with a = K^+ v; dB = C^-1 (dG^T - dC B).
    a = inverse @ v
    b = inverse @ (B.T @ normal)
    out_of_reach = v - (WRENCH_SCALE[:, None] * G) @ (B @ a)
    by_G = -a[:, None] * softness
    by_C = [(1.0, softness, B @ a)]
    # dK^+ = -K^+ dK K^+ + K^+ K^+ dK (1 - K K^+) + its transpose, which meets nothing here.
    for sign, x, y in ((1.0, b, a), (-1.0, inverse @ b, out_of_reach)):
        x_f, y_f = B @ x, B @ y
        by_G += sign * (np.outer(x, y_f) + np.outer(y, x_f))
        by_C.append((-sign, x_f, y_f))
    by_T = np.zeros_like(T)
    for weight, x, y in by_C:  # C = T^T diag(1/k) T and a constant
        moved_x, moved_y = (T @ z / statics.stiffness for z in (x, y))
        by_T += weight * (moved_y[:, None] * x + moved_x[:, None] * y)
    more = ((0, 0), (0, statics.G.shape[1] - n))
    return np.pad(WRENCH_SCALE[:, None] * by_G, more), np.pad(by_T, more)


# Asked for by the program of a state and, where a climb goes on from there, by its slope.
@lru_cache(maxsize=8)
def _resistance(statics: Statics) -> tuple[Array, Array, Array]:
    """B = C^-1 G^T (4 n, 6), K^+ = (G C^-1 G^T)^+ (6, 6), both of scaled wrenches, and C (4 n, 4 n)."""
    skin = _SKIN_COMPLIANCE * np.tile([1.0, 1.0, 1.0, 1.0 / ARM_M**2], statics.n_contacts)
    n = len(skin)
    T = statics.T[:, :n]
    C = (T.T / statics.stiffness) @ T + np.diag(skin)
    G = WRENCH_SCALE[:, None] * statics.G[:, :n]
    B: Array = np.linalg.solve(C, G.T).astype(np.float64)
    return B, np.linalg.pinv(G @ B, rcond=_RANK).astype(np.float64), C
