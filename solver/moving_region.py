"""A contact region that moves with its body, with derivatives by the motion and the patch parameters."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry import Cap, Patch, PointRegion, Region
from ..geometry.transforms import perpendicular
from ..hands import Hand
from ..jit import compiled
from .state import State

__all__ = ["LocalRegion", "Side", "on_link", "on_object"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Side:
    """One side of a contact in the palm frame; columns of derivatives are those of the tangent space.

    Attributes:
        p: (3,) in m: the point of a patch or point region, the centre of a cap.
        J_p: (3, n_tangent).
        directions: (3, 3), unit vectors in rows: the outward normal (of a cap: its axis) and two tangents.
        J_directions: (3, 3, n_tangent).
        radius: of a cap, in m; 0 of other regions.
        cos_half_angle: of a cap; None of other regions, whose normal is `directions[0]`.
    """

    p: Array
    J_p: Array
    directions: Array
    J_directions: Array
    radius: float
    cos_half_angle: float | None

    @property
    def is_cap(self) -> bool:
        """Whether this is a cap, whose contact normal depends on the other side."""
        return self.cos_half_angle is not None


class LocalRegion:
    """A region in the frame of its body, ready to be evaluated many times.

    Attributes:
        columns: where its parameters stand among those of the state.
    """

    def __init__(self, region: Region, first_column: int):
        self._control_points: Array | None = None
        self.radius = 0.0
        self.cos_half_angle: float | None = None
        count = 0
        match region:
            case Patch():
                self._control_points = region.patch.control_points
                count = 2
            case Cap():
                self.radius = region.radius
                self.cos_half_angle = float(np.cos(region.half_angle_rad))
                self._constant = _constant_frame(region.centre, region.axis)
            case PointRegion():
                self._constant = _constant_frame(region.point, region.normal)
        self.columns = slice(first_column, first_column + count)

    def evaluate(self, params: Array) -> tuple[Array, Array, Array, Array]:
        """Point (3,), derivatives (3, k) by the k parameters, directions (3, 3) and theirs (3, 3, k)."""
        if self._control_points is None:
            return self._constant
        u, v = params[self.columns]
        return _patch_frame(self._control_points, u, v)


def on_link(
    region: LocalRegion, hand: Hand, link: int, frames: tuple[Array, Array, Array], state: State
) -> Side:
    """The region on link number `link`; `frames` as from `joint_axes`."""
    p_local, d_point, local, d_directions = region.evaluate(state.params)
    Ts, origins, axes = frames
    tree = hand.tree
    p, J_p, J_w = _link_motion(
        Ts[link],
        p_local,
        tree.moves[link],
        tree.prismatic,
        origins,
        axes,
        hand.coupling_matrix,
        _n_tangent(state),
    )
    first = len(state.q) + 6 + region.columns.start
    directions, J_directions = _carry(Ts[link], local, d_point, d_directions, J_p, J_w, first)
    return Side(p, J_p, directions, J_directions, region.radius, region.cos_half_angle)


def on_object(region: LocalRegion, T_palm_object: Array, state: State) -> Side:
    """The region on the object."""
    p_local, d_point, local, d_directions = region.evaluate(state.params)
    n_q = len(state.q)
    p, J_p, J_w = _object_motion(T_palm_object, p_local, n_q, _n_tangent(state))
    first = n_q + 6 + region.columns.start
    directions, J_directions = _carry(T_palm_object, local, d_point, d_directions, J_p, J_w, first)
    return Side(p, J_p, directions, J_directions, region.radius, region.cos_half_angle)


def _n_tangent(state: State) -> int:
    return len(state.q) + 6 + len(state.params)


def _constant_frame(point: Array, normal: Array) -> tuple[Array, Array, Array, Array]:
    return np.array(point), np.zeros((3, 0)), np.vstack([normal, perpendicular(normal)]), np.zeros((3, 3, 0))


@compiled
def _basis(degree: int, x: float) -> Array:
    """Bernstein polynomials of `degree` at `x`, by their recursion."""
    b = np.zeros(degree + 1)
    b[0] = 1.0
    for d in range(1, degree + 1):
        b[d] = x * b[d - 1]
        for i in range(d - 1, 0, -1):
            b[i] = (1.0 - x) * b[i] + x * b[i - 1]
        b[0] *= 1.0 - x
    return b


@compiled
def _derivative_basis(degree: int, x: float) -> tuple[Array, Array, Array]:
    """Bernstein polynomials with their first and second derivatives."""
    b, b1, b2 = _basis(degree, x), np.zeros(degree + 1), np.zeros(degree + 1)
    lower = _basis(degree - 1, x)
    for i in range(degree):
        b1[i] -= degree * lower[i]
        b1[i + 1] += degree * lower[i]
    if degree >= 2:
        lower = _basis(degree - 2, x)
        for i in range(degree - 1):
            w = degree * (degree - 1) * lower[i]
            b2[i] += w
            b2[i + 1] -= 2.0 * w
            b2[i + 2] += w
    return b, b1, b2


@compiled
def _patch_frame(points: Array, u: float, v: float) -> tuple[Array, Array, Array, Array]:
    """Point, derivatives, unit normal and tangents, and their derivatives, of a Bezier patch."""
    bu, bu1, bu2 = _derivative_basis(points.shape[0] - 1, u)
    bv, bv1, bv2 = _derivative_basis(points.shape[1] - 1, v)
    jet = np.zeros((6, 3))  # p, p_u, p_v, p_uu, p_uv, p_vv
    for i in range(points.shape[0]):
        for j in range(points.shape[1]):
            for a in range(3):
                x = points[i, j, a]
                jet[0, a] += bu[i] * bv[j] * x
                jet[1, a] += bu1[i] * bv[j] * x
                jet[2, a] += bu[i] * bv1[j] * x
                jet[3, a] += bu2[i] * bv[j] * x
                jet[4, a] += bu1[i] * bv1[j] * x
                jet[5, a] += bu[i] * bv2[j] * x
    point, d_point = np.zeros(3), np.zeros((3, 2))
    directions, slopes = np.zeros((3, 3)), np.zeros((3, 3, 2))
    for a in range(3):
        point[a] = jet[0, a]
        d_point[a, 0] = directions[1, a] = jet[1, a]
        d_point[a, 1] = directions[2, a] = jet[2, a]
        slopes[1, a, 0] = jet[3, a]
        slopes[1, a, 1] = slopes[2, a, 0] = jet[4, a]
        slopes[2, a, 1] = jet[5, a]
        b, c = (a + 1) % 3, (a + 2) % 3
        directions[0, a] = jet[1, b] * jet[2, c] - jet[1, c] * jet[2, b]
        for k in range(2):
            slopes[0, a, k] = jet[3 + k, b] * jet[2, c] - jet[3 + k, c] * jet[2, b]
            slopes[0, a, k] += jet[1, b] * jet[4 + k, c] - jet[1, c] * jet[4 + k, b]
    _normalise(directions, slopes)
    return point, d_point, directions, slopes


@compiled
def _normalise(vectors: Array, slopes: Array) -> None:
    """Scales each row to unit length, and its derivatives to match, in place."""
    for i in range(3):
        length = np.sqrt(vectors[i, 0] ** 2 + vectors[i, 1] ** 2 + vectors[i, 2] ** 2)
        for a in range(3):
            vectors[i, a] /= length
        for k in range(2):
            along = (
                vectors[i, 0] * slopes[i, 0, k]
                + vectors[i, 1] * slopes[i, 1, k]
                + vectors[i, 2] * slopes[i, 2, k]
            )
            for a in range(3):
                slopes[i, a, k] = (slopes[i, a, k] - vectors[i, a] * along) / length


@compiled
def _link_motion(
    T: Array,
    p_link: Array,
    moves: NDArray[np.bool_],
    prismatic: NDArray[np.bool_],
    origins: Array,
    axes: Array,
    E: Array,
    n_tangent: int,
) -> tuple[Array, Array, Array]:
    """A link's point in the palm frame, its velocity and the link's angular velocity (3, n_tangent each)."""
    p, J_p, J_w = _place(T, p_link), np.zeros((3, n_tangent)), np.zeros((3, n_tangent))
    for k in range(len(moves)):
        if not moves[k]:
            continue
        for j in range(E.shape[1]):
            e = E[k, j]
            if e == 0.0:
                continue
            for a in range(3):
                if prismatic[k]:
                    J_p[a, j] += e * axes[k, a]
                else:
                    b, c = (a + 1) % 3, (a + 2) % 3
                    J_p[a, j] += e * (
                        axes[k, b] * (p[c] - origins[k, c]) - axes[k, c] * (p[b] - origins[k, b])
                    )
                    J_w[a, j] += e * axes[k, a]
    return p, J_p, J_w


@compiled
def _object_motion(T: Array, p_object: Array, n_q: int, n_tangent: int) -> tuple[Array, Array, Array]:
    """The same for a point of the object, which moves freely."""
    p, J_p, J_w = _place(T, p_object), np.zeros((3, n_tangent)), np.zeros((3, n_tangent))
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        J_p[a, n_q + a] = 1.0
        J_w[a, n_q + 3 + a] = 1.0
        J_p[a, n_q + 3 + b] = p[c] - T[c, 3]
        J_p[a, n_q + 3 + c] = T[b, 3] - p[b]
    return p, J_p, J_w


@compiled
def _place(T: Array, p_local: Array) -> Array:
    p = np.zeros(3)
    for a in range(3):
        p[a] = T[a, 0] * p_local[0] + T[a, 1] * p_local[1] + T[a, 2] * p_local[2] + T[a, 3]
    return p


@compiled
def _carry(
    T: Array, local: Array, d_point: Array, d_local: Array, J_p: Array, J_w: Array, first: int
) -> tuple[Array, Array]:
    """Directions in the palm frame with derivatives; adds the parameters' columns from `first` on to J_p."""
    n_tangent = J_w.shape[1]
    directions, J = np.zeros((3, 3)), np.zeros((3, 3, n_tangent))
    for a in range(3):
        for k in range(d_point.shape[1]):
            for b in range(3):
                J_p[a, first + k] += T[a, b] * d_point[b, k]
    for i in range(3):
        for a in range(3):
            directions[i, a] = T[a, 0] * local[i, 0] + T[a, 1] * local[i, 1] + T[a, 2] * local[i, 2]
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            for t in range(n_tangent):
                J[i, a, t] = J_w[b, t] * directions[i, c] - J_w[c, t] * directions[i, b]
            for k in range(d_point.shape[1]):
                for b in range(3):
                    J[i, a, first + k] += T[a, b] * d_local[i, b, k]
    return directions, J
