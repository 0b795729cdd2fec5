"""How well a hand's regions can be laid on sites, guessed from postures drawn at random.

For each choice of fingers and each posture the best rigid motion is known in closed form (Kabsch, "A solution
for the best rotation to relate two sets of vectors", 1976); what is left of the distances between regions and
sites is the misfit. It is a guess to sort tries by and refuses nothing.
"""

from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Array
from ...hands import Hand, HandRegion, forward_kinematics
from .screen import Combination

__all__ = ["NORMAL_M", "Postures", "placed_middles"]

_POSTURES = 192
NORMAL_M = 0.02
"""A normal that is off by a radian counts like a point that is off by so much."""


class Postures:
    """Postures of a hand, drawn once.

    Args:
        hand: the hand.
        regions: those that may touch.
        seed: of the postures.
    """

    def __init__(self, hand: Hand, regions: Sequence[HandRegion], seed: int):
        rng = np.random.default_rng(seed)
        lower, upper = hand.limits.reshape(-1, 2).T
        drawn = rng.uniform(lower, upper, size=(_POSTURES, len(lower)))
        poses = np.array([forward_kinematics(hand, hand.expand(q)) for q in drawn])
        self._places = {region.name: placed_middles(poses, region) for region in regions}

    def misfit_m(self, combination: Combination, regions: Sequence[HandRegion]) -> float:
        """Root mean square of what is left between regions and sites in the best posture, in m."""
        points = np.stack([self._places[region.name][0] for region in regions], axis=1)
        normals = np.stack([self._places[region.name][1] for region in regions], axis=1)
        hand = np.concatenate([points, points + NORMAL_M * normals], axis=1)
        p = np.array([site.point for site in combination.sites])
        n = np.array([site.normal for site in combination.sites])
        obj = np.concatenate([p, p - NORMAL_M * n])
        return float(np.sqrt(_squares_left(hand, obj).min() / len(obj)))


def placed_middles(poses: Array, region: HandRegion) -> tuple[Array, Array]:
    """Middles (n, 3) and normals (n, 3) of a region in the palm frame."""
    point, normal = region.region.middle()
    T = poses[:, region.link]
    return T[:, :3, :3] @ point + T[:, :3, 3], T[:, :3, :3] @ normal


def _squares_left(a: Array, b: Array) -> Array:
    """Least sums of squared distances (n,) between points a (n, k, 3) and b (k, 3), moved as a body."""
    a = a - a.mean(axis=1, keepdims=True)
    b = b - b.mean(axis=0)
    H = a.swapaxes(1, 2) @ b
    widths = np.linalg.svd(H, compute_uv=False)
    widths[:, 2] *= np.sign(np.linalg.det(H))
    return np.asarray(np.maximum(np.sum(a**2, axis=(1, 2)) + np.sum(b**2) - 2.0 * widths.sum(axis=1), 0.0))
