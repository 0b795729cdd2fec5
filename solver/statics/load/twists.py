"""Twists against which contacts carry little: descent on a smoothed bound of the load.

Against a twist y = (a, w) the load moves by a, and a contact that presses with at most its largest force
takes up at most a power that is sublinear in y. Over a part of its region, that is at most the largest over
the part's control points. For several twists, with the same place of each contact against all of them,

    multiple of the load <= sum over contacts of max over control points of (sum over twists of power)
                            / sum over twists of |a|.                                                   (6)

Any twists will do, so what is found here needs no proof of its own: `bound` takes it up.
"""

import numpy as np

from ....base.machine.jit import compiled
from ....base.numeric.arrays import Array, Indices

__all__ = ["descend", "load_rows", "measure"]

# Shares of the bound by which its kinks are smoothed, one descent after the other; the last ones only where
# the bound is within a share of what is enough.
_SMOOTHINGS, _USUAL = np.array([0.1, 0.01, 1e-3, 1e-4, 1e-5]), 3
_NEARLY = 0.02
_MOST_STEPS, _MOST_HALVINGS = 60, 30
# A descent has ended where so many steps in turn help by no more than this share of the bound.
_LEAST_GAIN, _MOST_IDLE = 1e-4, 3
# Steps must help by this share of what the slope promises.
_SUFFICIENT = 1e-4
# Control points that weigh less than this have no part in the slope.
_LEAST_WEIGHT = 1e-9


def load_rows(
    maps: Array, along: Array, shares: Array, arms: Array, owner: Indices, friction: float
) -> Array:
    """What `measure` needs of control points: (n, 5, 6), for (q_0, mu q_1, mu q_2, mu q_3, mu r q_4).

    Args:
        maps: (n, 8, 6), see `power`.
        along: (n, 3) unit vectors along which lengths of their normals are measured.
        shares: (contacts,) largest force of each, by the weight of the load.
        arms: (contacts,) spin arms.
        owner: contact (n,) of each control point.
        friction: coefficient.
    """
    sizes = (maps[:, 0, :3] * along).sum(axis=1)
    rows = maps[:, :5] * (shares[owner] / sizes)[:, None, None]
    rows[:, 1:] *= friction
    rows[:, 4] *= arms[owner][:, None]
    return np.ascontiguousarray(rows)


@compiled
def measure(
    rows: Array,
    owner: Indices,
    n_contacts: int,
    twists: Array,
    smoothing: float,
    slope: Array,
    weights: Array,
) -> float:
    """The largest power that contacts take up against twists (m, 6), smoothed; above it where it is.

    Args:
        rows: see `load_rows`.
        owner: contact (n,) of each, in ascending order.
        n_contacts: how many contacts there are.
        twists: (m, 6)
        smoothing: about by how much kinks are smoothed; none with 0.
        slope: (m, 6), is overwritten by the derivative.
        weights: (n,), is overwritten by how much each control point counts for its contact; of sum 1 at most.
    """
    n, m = len(owner), len(twists)
    square = smoothing * smoothing / (m * m)
    powers = np.zeros(n)
    q = np.zeros((n, m, 5))
    most = np.full(n_contacts, -np.inf)
    for k in range(n):
        for j in range(m):
            for r in range(5):
                total = 0.0
                for c in range(6):
                    total += rows[k, r, c] * twists[j, c]
                q[k, j, r] = total
            size = np.sqrt(q[k, j, 1] ** 2 + q[k, j, 2] ** 2 + q[k, j, 3] ** 2 + q[k, j, 4] ** 2 + square)
            x = size - q[k, j, 0]
            powers[k] += 0.5 * (x + np.sqrt(x * x + square))
        most[owner[k]] = max(most[owner[k]], powers[k])
    value, sums = 0.0, np.zeros(n_contacts)
    for k in range(n):
        away = powers[k] - most[owner[k]]
        weights[k] = np.exp(away / smoothing) if smoothing > 0.0 else 1.0 if away == 0.0 else 0.0
        sums[owner[k]] += weights[k]
    for i in range(n_contacts):
        value += most[i] + smoothing * np.log(sums[i])
    slope[:] = 0.0
    for k in range(n):
        weights[k] /= sums[owner[k]]
        if weights[k] < _LEAST_WEIGHT:
            continue
        for j in range(m):
            size = np.sqrt(q[k, j, 1] ** 2 + q[k, j, 2] ** 2 + q[k, j, 3] ** 2 + q[k, j, 4] ** 2 + square)
            x = size - q[k, j, 0]
            root = np.sqrt(x * x + square)
            by = weights[k] * 0.5 * (1.0 + (x / root if root > 0.0 else 0.0))
            if by == 0.0:
                continue
            for c in range(6):
                total = -rows[k, 0, c]
                if size > 0.0:
                    for r in range(1, 5):
                        total += q[k, j, r] / size * rows[k, r, c]
                slope[j, c] += by * total
    return value


@compiled
def descend(
    rows: Array, owner: Indices, n_contacts: int, start: Array, enough: float, first: int
) -> tuple[float, Array, Array]:
    """Twists (m, 6) against which contacts carry little: the multiple, the twists, weights (n,) of points.

    Args:
        rows: see `load_rows`.
        owner: contact (n,) of each, in ascending order.
        n_contacts: how many contacts there are.
        start: twists (m, 6) to begin with.
        enough: multiple at which to stop.
        first: number of the first smoothing, the roughest is 0.
    """
    m = len(start)
    # Turns count as motions of the points, so that the descent finds both alike.
    linear, angular = 1e-300, 1e-300
    for k in range(len(owner)):
        for r in range(4):
            for c in range(3):
                linear += rows[k, r, c] ** 2
                angular += rows[k, r, 3 + c] ** 2
    turn = 0.5 * np.sqrt(angular / linear)
    rows = rows.copy()
    rows[:, :, 3:] /= turn
    best = start.copy()
    best[:, 3:] *= turn
    best = _scaled(best)
    slope, weights = np.zeros((m, 6)), np.zeros(len(owner))
    least = measure(rows, owner, n_contacts, best, 0.0, slope, weights)
    at = best.copy()
    for stage in range(first, len(_SMOOTHINGS)):
        if least <= enough or (stage >= _USUAL and least > (1.0 + _NEARLY) * enough):
            break
        smoothing = max(_SMOOTHINGS[stage] * least / n_contacts, 1e-12)
        at = _scaled(_quasi_newton(rows, owner, n_contacts, at, smoothing))
        value = measure(rows, owner, n_contacts, at, 0.0, slope, weights)
        if value < least:
            least = value
            best[:] = at
        measure(rows, owner, n_contacts, at, smoothing, slope, weights)
    best[:, 3:] /= turn
    return least, best, weights


@compiled
def _quasi_newton(rows: Array, owner: Indices, n_contacts: int, start: Array, smoothing: float) -> Array:
    """BFGS on the smoothed measure over sum |a|."""
    m = len(start)
    size = 6 * m
    x, slope, weights = start.copy(), np.zeros((m, 6)), np.zeros(len(owner))
    value = _ratio(rows, owner, n_contacts, x, smoothing, slope, weights)
    g = slope.copy().reshape(size)
    H = np.eye(size)
    fresh, idle = True, 0
    for _ in range(_MOST_STEPS):
        step = -(H @ g)
        promised = g @ step
        if promised >= 0.0:
            H, fresh = np.eye(size), True
            step, promised = -g, -(g @ g)
        if fresh:
            largest = np.sqrt(step @ step)
            if largest > 0.25:
                step, promised = step * (0.25 / largest), promised * (0.25 / largest)
        if promised > -1e-14 * abs(value):
            break
        length, taken = 1.0, False
        trial = x
        after = value
        for _ in range(_MOST_HALVINGS):
            trial = x + (length * step).reshape((m, 6))
            after = _ratio(rows, owner, n_contacts, trial, smoothing, slope, weights)
            if after <= value + _SUFFICIENT * length * promised:
                taken = True
                break
            length *= 0.4
        if not taken:
            if fresh:
                break
            H, fresh = np.eye(size), True
            continue
        s = length * step
        y = slope.copy().reshape(size) - g
        curvature = s @ y
        gain = value - after
        x, value = trial, after
        g = slope.copy().reshape(size)
        if curvature > 1e-12 * np.sqrt((s @ s) * (y @ y)):
            if fresh:
                H = np.eye(size) * (curvature / (y @ y))
            fresh = False
            Hy = H @ y
            by = (1.0 + (y @ Hy) / curvature) / curvature
            for i in range(size):
                for j in range(size):
                    H[i, j] += by * s[i] * s[j] - (Hy[i] * s[j] + s[i] * Hy[j]) / curvature
        idle = idle + 1 if gain <= _LEAST_GAIN * abs(value) else 0
        if idle >= _MOST_IDLE:
            break
    return x


@compiled
def _ratio(
    rows: Array,
    owner: Indices,
    n_contacts: int,
    twists: Array,
    smoothing: float,
    slope: Array,
    weights: Array,
) -> float:
    """The smoothed measure over sum |a|, with its slope."""
    value = measure(rows, owner, n_contacts, twists, smoothing, slope, weights)
    total = _total(twists)
    if total < 1e-9:
        return np.inf
    for j in range(len(twists)):
        size = np.sqrt(twists[j, 0] ** 2 + twists[j, 1] ** 2 + twists[j, 2] ** 2)
        for c in range(6):
            if c < 3 and size > 0.0:
                slope[j, c] -= value / total * twists[j, c] / size
            slope[j, c] /= total
    return value / total


@compiled
def _total(twists: Array) -> float:
    total = 0.0
    for j in range(len(twists)):
        total += np.sqrt(twists[j, 0] ** 2 + twists[j, 1] ** 2 + twists[j, 2] ** 2)
    return total


@compiled
def _scaled(twists: Array) -> Array:
    """Twists with a sum of |a| of 1."""
    return twists / max(_total(twists), 1e-12)
