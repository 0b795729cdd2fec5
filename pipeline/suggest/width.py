"""How thick a thing a simple hand can take between two regions: a jaw has no business with what is wider."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from ...base.numeric.arrays import Array
from ...hands import Hand, HandRegion, forward_kinematics

__all__ = ["Widths"]

# Hands with more joints are left alone: their width is not found by looking at a grid of postures.
_MOST_JOINTS = 3
_STEPS = 7
# Pads that turn by more against each other while the hand closes do not stay parallel.
_ALIKE_RAD = np.radians(0.05)
# Sites stand for regions around them and, unless all joints slide, the widest posture lies off the grid.
_SLACK_M = {True: 0.0002, False: 0.003}


class Widths:
    """The postures of a hand with few joints, for what its regions can have between them.

    Args:
        hand: the hand.
        regions: those that may touch.
    """

    def __init__(self, hand: Hand, regions: Sequence[HandRegion]):
        n = len(hand.limits)
        self._slack_m = _SLACK_M[all(axis.kind == "prismatic" for axis in hand.axes)]
        self._placed: dict[str, tuple[Array, Array]] = {}
        # Of each choice of regions, which many combinations of places ask for.
        self._askew_rad: dict[tuple[str, ...], float] = {}
        self._widest_m: dict[tuple[str, ...], float] = {}
        if n > _MOST_JOINTS:
            return
        shares = np.array(list(product(np.linspace(0.0, 1.0, _STEPS), repeat=n))).reshape(-1, n)
        lower, upper = hand.limits.reshape(-1, 2).T
        poses = np.array([forward_kinematics(hand, hand.expand(lower + s * (upper - lower))) for s in shares])
        for region in regions:
            points, normals = region.region.spread()
            R, p = poses[:, region.link, :3, :3], poses[:, region.link, None, :3, 3]
            self._placed[region.name] = (points @ R.swapaxes(1, 2) + p, normals @ R.swapaxes(1, 2))

    @property
    def are_known(self) -> bool:
        """Whether the hand is simple enough."""
        return bool(self._placed)

    def are_parallel(self, choice: Sequence[HandRegion]) -> bool:
        """Whether two regions face each other alike in all postures, or nobody knows."""
        if len(choice) != 2 or not self._placed:
            return True
        m, n = (self._placed[region.name][1].mean(axis=1) for region in choice)
        cosines = np.sum(m * n, axis=1) / (np.linalg.norm(m, axis=1) * np.linalg.norm(n, axis=1))
        return bool(np.ptp(np.arccos(np.clip(cosines, -1.0, 1.0))) <= _ALIKE_RAD)

    def askew_rad(self, choice: Sequence[HandRegion]) -> float:
        """By how much two regions can miss to face each other at most; pi where not known."""
        if len(choice) != 2 or not self._placed:
            return float(np.pi)
        names = tuple(region.name for region in choice)
        if names not in self._askew_rad:
            m, n = (self._placed[name][1] for name in names)
            cosines = np.einsum("pid,pjd->pij", m, -n)
            self._askew_rad[names] = float(np.arccos(np.clip(cosines.min(), -1.0, 1.0)))
        return self._askew_rad[names]

    def widest_m(self, choice: Sequence[HandRegion]) -> float:
        """How far apart contacts of two regions can be along both normals, in m; inf where not known."""
        if len(choice) != 2 or not self._placed:
            return float("inf")
        names = tuple(region.name for region in choice)
        if names not in self._widest_m:
            (p, m), (q, n) = (self._placed[name] for name in names)
            across = q[:, None] - p[:, :, None]
            widths = np.abs([np.sum(across * m[:, :, None], axis=3), np.sum(across * n[:, None], axis=3)])
            self._widest_m[names] = float(widths.min(axis=0).max()) + self._slack_m
        return self._widest_m[names]
