"""The contact equations in compiled loops, and moves in the space of states; see `manifold.py`.

States are passed as joints q (n_q,), rotation R (3, 3), position p (3,) and parameters (n_params,).
"""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Mask
from ...base.numeric.linalg import damped_step, largest_row
from ...geometry import turn_by
from .frames import ContactFrames, contact_frames
from .tables import CAP, ContactTables

__all__ = [
    "is_feasible",
    "largest",
    "largest_error",
    "mark_leaving",
    "move",
    "project",
    "put_equations",
    "put_inequalities",
]

# Rows that compare directions are weighed as if they acted at this arm, so that all rows are in metres.
_DIRECTION_ARM_M = 0.02
# Damping of projections, as a share of the largest diagonal entry of J J^T: they are Newton's steps but for
# directions in which contacts hardly move.
_PROJECTION_DAMPING = 1e-14


@compiled
def put_equations(t: ContactTables, at: ContactFrames, R: Array, p: Array, c: Array, J: Array) -> None:
    """Fills residual (n_rows,) and Jacobian (n_rows, n_tangent) of the contact equations."""
    for k in range(len(t.kind) // 2):
        _put_contact(t, at, k, c, J)
    if len(t.T_fixed):
        first = t.first_row[-1]
        _put_fixed_object(t.T_fixed[0], R, p, t.coupling.shape[1], c[first:], J[first:])


@compiled
def _put_contact(t: ContactTables, at: ContactFrames, k: int, c: Array, J: Array) -> None:
    """The rows of contact k."""
    row, h, o = t.first_row[k], 2 * k, 2 * k + 1
    n = J.shape[1]
    if t.kind[h] == CAP and t.kind[o] == CAP:
        distance = _distance(at.p[h], at.p[o])
        c[row] = distance - t.radius[h] - t.radius[o]
        for j in range(n):
            J[row, j] = 0.0
            for a in range(3):
                J[row, j] += (at.p[h, a] - at.p[o, a]) / distance * (at.J_p[h, a, j] - at.J_p[o, a, j])
        return
    # A sphere's centre lies on the other surface's offset; a radius of zero leaves the points themselves.
    offset, normal = (-t.radius[h], o) if t.kind[h] == CAP else (t.radius[o], h)
    for a in range(3):
        c[row + a] = at.p[h, a] - at.p[o, a] + offset * at.directions[normal, 0, a]
        for j in range(n):
            J[row + a, j] = at.J_p[h, a, j] - at.J_p[o, a, j] + offset * at.J_directions[normal, 0, a, j]
    if t.first_row[k + 1] - row == 3:
        return
    arm = _DIRECTION_ARM_M
    for i in range(1, 3):
        tangent, J_tangent = at.directions[o, i], at.J_directions[o, i]
        slope = J[row + 2 + i]
        c[row + 2 + i] = arm * _dot(
            at.directions[h, 0], at.J_directions[h, 0], tangent, J_tangent, arm, slope
        )


@compiled
def _dot(x: Array, J_x: Array, y: Array, J_y: Array, weight: float, slope: Array) -> float:
    """Product of two vectors (3,); `slope` (n,) gets `weight` times its slopes, from theirs (3, n)."""
    for k in range(len(slope)):
        slope[k] = 0.0
        for a in range(3):
            slope[k] += weight * (x[a] * J_y[a, k] + y[a] * J_x[a, k])
    return float(x[0] * y[0] + x[1] * y[1] + x[2] * y[2])


@compiled
def _distance(a: Array, b: Array) -> float:
    return float(np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2))


@compiled
def _put_fixed_object(T: Array, R: Array, p: Array, n_q: int, c: Array, J: Array) -> None:
    """The object is at pose T: six rows of its shift, and of its turn as the skew part of M = R T^-1."""
    M = np.zeros((3, 3))
    for a in range(3):
        for b in range(3):
            for k in range(3):
                M[a, b] += R[a, k] * T[b, k]
    trace = M[0, 0] + M[1, 1] + M[2, 2]
    half_arm = 0.5 * _DIRECTION_ARM_M
    for row in range(6):
        for j in range(J.shape[1]):
            J[row, j] = 0.0
    for a in range(3):
        c[a] = p[a] - T[a, 3]
        J[a, n_q + a] = 1.0
        i, k = (a + 1) % 3, (a + 2) % 3
        c[3 + a] = half_arm * (M[k, i] - M[i, k])
        for b in range(3):
            J[3 + a, n_q + 3 + b] = half_arm * ((trace if a == b else 0.0) - M[a, b])


@compiled
def put_inequalities(t: ContactTables, at: ContactFrames, g: Array, G: Array) -> None:
    """Fills values (n_inequalities,) and Jacobian (n_inequalities, n_tangent) of caps and of normals.

    Contact by contact: that its normals face each other, or each of its caps; then the room of its normals.
    """
    row = 0
    for k in range(len(t.kind) // 2):
        h, o = 2 * k, 2 * k + 1
        if t.kind[h] != CAP and t.kind[o] != CAP:
            g[row] = _facing(at, h, o, G[row])
            row += 1
        for own, other in ((h, o), (o, h)):
            if t.kind[own] == CAP:
                g[row] = _put_cap(t, at, own, other, G[row])
                row += 1
        if t.sine_room[k] > 0.0:
            g[row] = t.sine_room[k] - _put_sine(at, h, o, G[row])
            row += 1


@compiled
def _facing(at: ContactFrames, s: int, r: int, slope: Array) -> float:
    """Cosine between the normal of one side and the reverse of the other's."""
    n, J_n = at.directions[s, 0], at.J_directions[s, 0]
    return -_dot(n, J_n, at.directions[r, 0], at.J_directions[r, 0], -1.0, slope)


@compiled
def _put_sine(at: ContactFrames, s: int, r: int, slope: Array) -> float:
    """Sine of the angle between two sides' normals; `slope` (n_tangent,) gets the slopes of its negative.

    Cosines don't tell small angles apart. Where the sine is zero it has no slope, and gets none.
    """
    n, other = at.directions[s, 0], at.directions[r, 0]
    J_n, J_other = at.J_directions[s, 0], at.J_directions[r, 0]
    cross = np.empty(3)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        cross[a] = n[b] * other[c] - n[c] * other[b]
    sine = np.sqrt(cross[0] ** 2 + cross[1] ** 2 + cross[2] ** 2)
    for k in range(len(slope)):
        slope[k] = 0.0
        if sine > 0.0:
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                turned = J_n[b, k] * other[c] + n[b] * J_other[c, k]
                turned -= J_n[c, k] * other[b] + n[c] * J_other[b, k]
                slope[k] -= cross[a] / sine * turned
    return float(sine)


@compiled
def _put_cap(t: ContactTables, at: ContactFrames, own: int, other: int, slope: Array) -> float:
    """Cosine of the angle between a cap's axis and its contact normal, less that of the half angle."""
    if t.kind[other] != CAP:
        return _facing(at, own, other, slope) - t.cos_half_angle[own]
    distance = _distance(at.p[own], at.p[other])
    axis, normal = at.directions[own, 0], np.empty(3)
    cosine = 0.0
    for a in range(3):
        normal[a] = (at.p[other, a] - at.p[own, a]) / distance
        cosine += axis[a] * normal[a]
    for k in range(len(slope)):
        slope[k] = 0.0
    for a in range(3):
        # What turns the line of centres is the part of their motion that is perpendicular to it.
        lever = (axis[a] - cosine * normal[a]) / distance
        for k in range(len(slope)):
            apart = at.J_p[other, a, k] - at.J_p[own, a, k]
            slope[k] += lever * apart + normal[a] * at.J_directions[own, 0, a, k]
    return cosine - t.cos_half_angle[own]


@compiled
def move(t: ContactTables, q: Array, R: Array, p: Array, params: Array, dx: Array, share: float) -> None:
    """Moves a state in place by `share` of a tangent step; what has limits is clipped to them."""
    n = len(q)
    for j in range(n):
        q[j] = min(max(q[j] + share * dx[j], t.lower[j]), t.upper[j])
    for j in range(len(params)):
        x = params[j] + share * dx[n + 6 + j]
        params[j] = min(max(x, t.lower[n + j]), t.upper[n + j])
    w = np.empty(3)
    for a in range(3):
        p[a] += share * dx[n + a]
        w[a] = share * dx[n + 3 + a]
    turn_by(R, w)


@compiled
def mark_leaving(t: ContactTables, q: Array, params: Array, dx: Array, room: float, out: Mask) -> None:
    """Marks in `out` (n_tangent,) coordinates that a step takes over a limit by more than `room`."""
    n = len(q)
    for k in range(n + len(params)):
        x, j = (q[k], k) if k < n else (params[k - n], k + 6)
        if x + dx[j] < t.lower[k] - room or x + dx[j] > t.upper[k] + room:
            out[j] = True


@compiled
def is_feasible(t: ContactTables, at: ContactFrames, q: Array, params: Array, tolerance: float) -> bool:
    """Whether limits, patch bounds, caps and facing normals hold."""
    n = len(q)
    for k in range(n + len(params)):
        x = q[k] if k < n else params[k - n]
        if x < t.lower[k] - tolerance or x > t.upper[k] + tolerance:
            return False
    g, G = np.empty(t.n_inequalities), np.empty((t.n_inequalities, n + 6 + len(params)))
    put_inequalities(t, at, g, G)
    least = np.inf
    for value in g:
        least = min(least, value)
    return least >= -tolerance


@compiled
def largest(values: Array) -> float:
    """The largest absolute value; zero of none."""
    out = 0.0
    for value in values:
        out = max(out, abs(value))
    return out


@compiled
def largest_error(t: ContactTables, q: Array, R: Array, p: Array, params: Array) -> float:
    """The largest absolute value of the contact equations."""
    c, J = np.empty(t.n_rows), np.empty((t.n_rows, len(q) + 6 + len(params)))
    put_equations(t, contact_frames(t, q, R, p, params), R, p, c, J)
    return largest(c)


@compiled
def project(
    t: ContactTables, q: Array, R: Array, p: Array, params: Array, tolerance_m: float, max_steps: int
) -> int:
    """Least-norm Newton steps, in place; coordinates that would leave their limits are held there.

    Returns:
        Steps made, or -1 where the equations don't hold in the end.
    """
    n = len(q) + 6 + len(params)
    c, J, step = np.empty(t.n_rows), np.empty((t.n_rows, n)), np.empty(n)
    held = np.zeros(n, dtype=np.bool_)
    error = np.inf
    for count in range(max_steps + 1):
        put_equations(t, contact_frames(t, q, R, p, params), R, p, c, J)
        error = largest(c)
        if error < tolerance_m:
            return count
        if count == max_steps:
            break
        for j in range(n):
            if held[j]:
                for i in range(t.n_rows):
                    J[i, j] = 0.0
        damped_step(J, c, _PROJECTION_DAMPING * largest_row(J), step)
        mark_leaving(t, q, params, step, 1e-15, held)
        move(t, q, R, p, params, step, 1.0)
    return max_steps if error < 1e3 * tolerance_m else -1
