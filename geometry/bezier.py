"""Bezier patches of any degree: evaluation, the normal patch, subdivision (paper, equations 1-3 and 19)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..base.numeric.arrays import Array
from .bernstein import bernstein, bernstein_product, split_at

__all__ = ["BezierPatch"]


@dataclass(frozen=True, eq=False)
class BezierPatch:
    """A tensor-product Bezier patch p(u, v) on [0, 1]^2; the outward normal is p_u x p_v.

    Attributes:
        control_points: (M + 1, N + 1, 3), in metres, in the frame of the body that carries the patch.
    """

    control_points: Array

    def __post_init__(self) -> None:
        points = np.array(self.control_points, dtype=float, order="C")
        points.setflags(write=False)
        object.__setattr__(self, "control_points", points)

    @property
    def degree(self) -> tuple[int, int]:
        """Degrees (M, N) in u and v."""
        return self.control_points.shape[0] - 1, self.control_points.shape[1] - 1

    def evaluate(self, u: Array | float, v: Array | float) -> Array:
        """Points (*shape, 3) at the parameters (equation 3)."""
        M, N = self.degree
        return np.einsum("...i,...j,ijk->...k", bernstein(M, u), bernstein(N, v), self.control_points)

    @cached_property
    def du(self) -> "BezierPatch":
        """The derivative p_u as a patch of degree (M - 1, N)."""
        return BezierPatch(self.degree[0] * np.diff(self.control_points, axis=0))

    @cached_property
    def dv(self) -> "BezierPatch":
        """The derivative p_v as a patch of degree (M, N - 1)."""
        return BezierPatch(self.degree[1] * np.diff(self.control_points, axis=1))

    @cached_property
    def normal(self) -> "BezierPatch":
        """The unnormalised normal p_u x p_v as a patch of degree (2M - 1, 2N - 1) (equation 19)."""
        a, b = self.du.control_points, self.dv.control_points
        components = []
        for i, j in ((1, 2), (2, 0), (0, 1)):
            components.append(
                bernstein_product(a[..., i], b[..., j]) - bernstein_product(a[..., j], b[..., i])
            )
        return BezierPatch(np.stack(components, axis=-1))

    def unit_normal(self, u: Array | float, v: Array | float) -> Array:
        """Unit normals (*shape, 3) at the parameters."""
        n = self.normal.evaluate(u, v)
        return n / np.linalg.norm(n, axis=-1, keepdims=True)

    def split(self, axis: int, t: float = 0.5) -> tuple["BezierPatch", "BezierPatch"]:
        """The two halves of the patch, cut at parameter `t` of u (axis 0) or v (axis 1)."""
        points = np.moveaxis(self.control_points, axis, 0)
        first, second = split_at(points, t)
        return BezierPatch(np.moveaxis(first, 0, axis)), BezierPatch(np.moveaxis(second, 0, axis))

    def restrict(self, u: tuple[float, float], v: tuple[float, float]) -> "BezierPatch":
        """The same polynomial surface over [u0, u1] x [v0, v1], again over the unit square.

        De Casteljau's rule holds outside [0, 1] as well, so the surface may also be continued beyond it.
        """
        patch = self
        for axis, (lo, hi) in enumerate((u, v)):
            if hi != 1.0:
                patch = patch.split(axis, hi)[0]
            if lo != 0.0:
                patch = patch.split(axis, lo / hi)[1]
        return patch

    def normal_may_vanish(self, max_depth: int = 6) -> bool:
        """False where subdivision shows that the normal vanishes nowhere on the patch.

        A piece is settled when all its normal control points lie strictly on one side of a plane through
        the origin (the convex-hull property). The answer True may be over-cautious, False never is wrong
        beyond rounding.
        """
        scale = float(np.abs(self.normal.control_points).max())
        if scale == 0.0:
            return True
        pending = [(self.normal, 0)]
        while pending:
            piece, depth = pending.pop()
            points = piece.control_points.reshape(-1, 3)
            mean = points.mean(axis=0)
            if np.all(points @ mean > 1e-9 * scale * scale):
                continue
            if depth >= max_depth:
                return True
            pending.extend((half, depth + 1) for half in piece.split(depth % 2))
        return False
