"""A twist along which all contact forces have positive power, or that there is none: Wolfe's algorithm.

The wrenches of all cones, at unit normal force, have a convex hull. The point of it that is nearest to the
origin is such a twist; where the origin is in it, forces balance each other, and none exists. Wolfe ("Finding
the nearest point in a polytope", Mathematical Programming 11, 1976) needs for that only the wrench that goes
farthest against a given twist. It is known in closed form, so cones stay round.
"""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices

__all__ = ["BALANCED", "SEPARATED", "UNKNOWN", "friction_against", "needed_friction", "separate", "twist_for"]

SEPARATED, BALANCED, UNKNOWN = 1, 0, -1
# A hull that comes nearer to the origin than this holds it, as far as floats can tell.
_NEAREST = 1e-9
# What a twist must reach of the largest margin to be taken: the rest costs more than it helps.
_ENOUGH = 0.2
_MOST_STEPS = 400
# Weights below this are none.
_LEAST_WEIGHT = 1e-12
# The same for the twist that goes farthest.
_FARTHEST = 1.0 - 1e-6
# Coefficients beyond this are as good as no limit; and how closely the needed one is found.
_LARGEST_FRICTION, _HALVINGS = 64.0, 40


@compiled
def separate(
    maps: Array, arms: Array, reaches: Array, owner: Indices, friction: float, n_contacts: int
) -> tuple[int, Array, Array]:
    """A twist along which all forces have positive power, and what each contact adds to the nearest point.

    Args:
        maps: (n, 8, 6), see `power`.
        arms: spin arm (n,) of each.
        reaches: radius (n,) of the disc in which each acts.
        owner: contact (n,) of each.
        friction: coefficient.
        n_contacts: how many contacts there are.

    Returns:
        SEPARATED with the twist (6,), BALANCED where the hull holds the origin, UNKNOWN where neither was
        settled; then the twist, and wrenches (n_contacts, 6) of contacts whose sum is the nearest point.
    """
    status, x, S, lam, who, count = _nearest_of_all(maps, arms, reaches, owner, friction, _ENOUGH)
    wrenches = np.zeros((n_contacts, 6))
    for k in range(count):
        for c in range(6):
            wrenches[who[k], c] += lam[k] * S[k, c]
    return status, x, wrenches


@compiled
def needed_friction(maps: Array, arms: Array, reaches: Array) -> float:
    """The least coefficient at which forces of contacts at points, with maps (n, 8, 6), balance each other.

    Infinite where none is found below a large one.
    """
    n = len(arms)
    owner = np.arange(n)
    low, high = 0.0, _LARGEST_FRICTION
    if separate(maps, arms, reaches, owner, high, n)[0] != BALANCED:
        return np.inf
    for _ in range(_HALVINGS):
        if high - low <= 1e-7 * high:
            break
        # The needed coefficient may be of any size, so sizes are halved until there is a bound below.
        middle = 0.25 * high if low == 0.0 else 0.5 * (low + high)
        if separate(maps, arms, reaches, owner, middle, n)[0] == BALANCED:
            high = middle
        else:
            low = middle
    return high


@compiled
def twist_for(maps: Array, arms: Array, reaches: Array, friction: float) -> tuple[Array, Array]:
    """The twist (6,) that goes farthest against all forces, and how much each contact (n,) counts in it.

    See `friction_against`. Where the coefficient is the needed one there is none; a little below there is.
    """
    n = len(arms)
    _, twist, _, lam, who, count = _nearest_of_all(maps, arms, reaches, np.arange(n), friction, _FARTHEST)
    weights = np.zeros(n)
    for k in range(count):
        weights[who[k]] += lam[k]
    return twist, weights


@compiled
def friction_against(maps: Array, arms: Array, reaches: Array, twist: Array, weights: Array) -> float:
    """The friction at which forces, so much of each contact (n,), have no power along a twist in sum.

    With twist and weights for a little less than the needed friction (`twist_for`) it is nearly that one, and
    changes as that one does.
    """
    gained, lost = 0.0, 0.0
    q = np.zeros(8)
    for k in range(len(arms)):
        power, resisted = _along(maps[k], arms[k], reaches[k], twist, q)
        gained += weights[k] * power
        lost += weights[k] * resisted
    return gained / lost if lost > 0.0 else np.inf


@compiled
def _along(one: Array, arm: float, reach: float, twist: Array, q: Array) -> tuple[float, float]:
    """Power along a twist without friction, and what a coefficient of 1 takes of it; q (8,) is written."""
    for r in range(8):
        q[r] = 0.0
        for c in range(6):
            q[r] += one[r, c] * twist[c]
    size = np.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2 + (arm * q[4]) ** 2)
    tilt = np.sqrt(q[5] ** 2 + q[6] ** 2 + q[7] ** 2)
    return q[0] - reach * tilt, size + reach * abs(q[4])


@compiled
def _nearest_of_all(
    maps: Array, arms: Array, reaches: Array, owner: Indices, friction: float, enough: float
) -> tuple[int, Array, Array, Array, Indices, int]:
    """The point of the hull of all wrenches that is nearest to the origin, to a share `enough` of its size.

    Returns:
        As `separate` the status and the twist x; rows of S, their weights in x, their contacts, their number.
    """
    S, lam, who = np.zeros((8, 6)), np.zeros(8), np.zeros(8, dtype=np.int64)
    x = np.zeros(6)
    for c in range(6):
        for k in range(len(arms)):
            x[c] += maps[k, 0, c]
    _, at = _farthest(maps, arms, reaches, friction, x, S[0])
    lam[0], who[0], count = 1.0, owner[at], 1
    x[:] = S[0]
    status = UNKNOWN
    g = np.zeros(6)
    for _ in range(_MOST_STEPS):
        norm = _dot(x, x)
        if norm <= _NEAREST * _NEAREST:
            status = BALANCED
            break
        least, at = _farthest(maps, arms, reaches, friction, x, g)
        if least > enough * norm:
            status = SEPARATED
            break
        if count >= 7 or norm - least <= 1e-15 * norm:
            break
        S[count], lam[count], who[count] = g, 0.0, owner[at]
        count = _nearest(S, lam, who, count + 1, x)
    return status, x, S, lam, who, count


@compiled
def _farthest(
    maps: Array, arms: Array, reaches: Array, friction: float, y: Array, wrench: Array
) -> tuple[float, int]:
    """The least power along y of any wrench, which is written, and of which control point it is."""
    least, at = np.inf, 0
    q, best = np.zeros(8), np.zeros(8)
    for k in range(len(arms)):
        for r in range(8):
            q[r] = 0.0
            for c in range(6):
                q[r] += maps[k, r, c] * y[c]
        size = np.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2 + (arms[k] * q[4]) ** 2)
        tilt = np.sqrt(q[5] ** 2 + q[6] ** 2 + q[7] ** 2)
        power = q[0] - friction * (size + reaches[k] * abs(q[4])) - reaches[k] * tilt
        if power < least:
            least, at = power, k
            best[:] = q
    arm, reach = arms[at], reaches[at]
    size = np.sqrt(best[1] ** 2 + best[2] ** 2 + best[3] ** 2 + (arm * best[4]) ** 2)
    tilt = np.sqrt(best[5] ** 2 + best[6] ** 2 + best[7] ** 2)
    # What each row of the map counts in it: the derivative of the power by q.
    by = np.zeros(8)
    by[0] = 1.0
    if size > 0.0:
        for r in range(1, 4):
            by[r] = -friction * best[r] / size
        by[4] = -friction * arm * arm * best[4] / size
    by[4] -= friction * reach * np.sign(best[4])
    if tilt > 0.0:
        for r in range(5, 8):
            by[r] = -reach * best[r] / tilt
    for c in range(6):
        wrench[c] = 0.0
        for r in range(8):
            wrench[c] += by[r] * maps[at, r, c]
    return least, at


@compiled
def _nearest(S: Array, lam: Array, who: Indices, count: int, x: Array) -> int:
    """Wolfe's minor cycle: the nearest point x of the hull of the first rows of S; how many rows are left.

    Rows that are not needed are dropped, with their entries of `lam` and `who`.
    """
    while True:
        alpha = _affine_weights(S, count)
        step, leaving = 1.0, -1
        for k in range(count):
            if alpha[k] <= _LEAST_WEIGHT and lam[k] - alpha[k] > 0.0:
                reach = lam[k] / (lam[k] - alpha[k])
                if reach < step:
                    step, leaving = reach, k
        for k in range(count):
            lam[k] += step * (alpha[k] - lam[k])
        if leaving < 0:
            break
        lam[leaving] = 0.0
        kept = 0
        for k in range(count):
            if lam[k] > _LEAST_WEIGHT:
                S[kept], lam[kept], who[kept] = S[k], lam[k], who[k]
                kept += 1
        count = kept
        if count == 1:
            lam[0] = 1.0
            break
    for c in range(6):
        x[c] = 0.0
        for k in range(count):
            x[c] += lam[k] * S[k, c]
    return count


@compiled
def _affine_weights(S: Array, count: int) -> Array:
    """Weights (count,) of sum 1 of the point nearest to the origin in the plane through rows of S."""
    n = count + 1
    A, b = np.zeros((n, n)), np.zeros(n)
    for i in range(count):
        for j in range(count):
            A[i, j] = _dot(S[i], S[j])
        A[i, count], A[count, i] = 1.0, 1.0
    b[count] = 1.0
    for k in range(n):  # elimination with pivots from the whole column
        pivot = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[pivot, k]):
                pivot = i
        if pivot != k:
            for j in range(n):
                A[k, j], A[pivot, j] = A[pivot, j], A[k, j]
            b[k], b[pivot] = b[pivot], b[k]
        if abs(A[k, k]) < 1e-18:
            A[k, k] = 1e-18
        for i in range(k + 1, n):
            factor = A[i, k] / A[k, k]
            for j in range(k, n):
                A[i, j] -= factor * A[k, j]
            b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= A[k, j] * b[j]
        b[k] /= A[k, k]
    return b[:count]


@compiled
def _dot(a: Array, b: Array) -> float:
    total = 0.0
    for c in range(6):
        total += a[c] * b[c]
    return total
