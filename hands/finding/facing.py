"""What the links of a hand look at while it moves: rays from one link onto the others, in many postures."""

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...geometry import halton_points, shape_mesh
from ..hand import Hand
from ..kinematics import forward_kinematics

__all__ = ["Facing"]

_POSTURES = 48
# Rays of a probe: straight out, and leaning so much to four sides.
_LEAN_RAD = np.radians(25.0)
# Directions of the planes that bound a shape here: coarse, for what is seen need not be exact.
_SIDES = np.array(
    [[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)]
)
_SIDES = _SIDES / np.linalg.norm(_SIDES, axis=1, keepdims=True)


class Facing:
    """Postures spread over the limits of a hand, always the same, with its shapes as coarse polyhedra.

    Attributes:
        poses: T_palm_link (n_postures, n_links, 4, 4).
        reach_m: how far a link looks.
    """

    def __init__(self, hand: Hand):
        count = max(1, len(hand.independent))
        shares = halton_points(_POSTURES, count)
        lower, upper = hand.limits.T
        self.poses = np.array(
            [forward_kinematics(hand, hand.expand(lower + s * (upper - lower))) for s in shares]
        )
        owned = [(i, shape) for i, link in enumerate(hand.links) for shape in link.shapes]
        self._owners = np.array([i for i, _ in owned])
        bounds = np.array([(_SIDES @ shape_mesh(shape).vertices.T).max(axis=1) for _, shape in owned])
        T = self.poses[:, self._owners]
        # Planes normals . x <= offsets of every shape in every posture, in the palm frame.
        self._normals = np.einsum("psij,kj->pski", T[..., :3, :3], _SIDES)
        self._offsets = bounds + np.einsum("pski,psi->psk", self._normals, T[..., :3, 3])
        self.reach_m = float(np.ptp(self.poses[..., :3, 3], axis=(0, 1)).max()) + 0.05

    def seen(self, link: int, point: Array, direction: Array, own: set[int]) -> tuple[float, Array]:
        """How much of what a place on a link looks at belongs to other links.

        Args:
            link: the link.
            point: (3,) in its frame.
            direction: unit vector (3,) out of it.
            own: links that do not count.

        Returns:
            Share of the rays that meet another link from outside, and the hits on the palm as rows of point
            and normal (n, 6) in the palm frame.
        """
        others = np.flatnonzero(~np.isin(self._owners, list(own)))
        if not len(others):
            return 0.0, np.zeros((0, 6))
        T = self.poses[:, link]
        origins = T[:, :3, :3] @ point + T[:, :3, 3]
        rays = np.einsum("pij,rj->pri", T[:, :3, :3], _cone(direction))
        depth, side = self._meet(others, origins, rays)
        nearest = depth.argmin(axis=1)
        p, r = np.indices(nearest.shape)
        found = depth[p, nearest, r]
        hit = found < self.reach_m
        on_palm = hit & (self._owners[others[nearest]] == 0)
        at = (origins[:, None] + np.where(hit, found, 0.0)[..., None] * rays)[on_palm]
        normals = self._normals[p, others[nearest], side[p, nearest, r]][on_palm]
        return float(hit.mean()), np.column_stack([at, normals])

    def _meet(self, shapes: Indices, origins: Array, rays: Array) -> tuple[Array, Indices]:
        """Depths (n_postures, n_shapes, n_rays) at which rays enter shapes, and by which plane."""
        normals = self._normals[:, shapes]
        room = self._offsets[:, shapes] - np.einsum("pski,pi->psk", normals, origins)
        speed = np.einsum("pski,pri->pskr", normals, rays)
        with np.errstate(divide="ignore", invalid="ignore"):
            times = room[..., None] / speed
        enter = np.where(speed < -1e-12, times, -np.inf)
        leave = np.where(speed > 1e-12, times, np.inf).min(axis=2)
        aside = np.any((np.abs(speed) <= 1e-12) & (room[..., None] < 0.0), axis=2)
        depth = enter.max(axis=2)
        hit = (depth > 0.0) & (depth < leave) & ~aside
        return np.where(hit, depth, np.inf), enter.argmax(axis=2)


def _cone(direction: Array) -> Array:
    side = np.cross(direction, np.eye(3)[np.abs(direction).argmin()])
    side /= np.linalg.norm(side)
    other = np.cross(direction, side)
    leaning = [np.cos(_LEAN_RAD) * direction + np.sin(_LEAN_RAD) * s for s in (side, -side, other, -other)]
    return np.array([direction, *leaning])
