"""Where pictures are taken from: a camera that both renderers use, and how it is best_camera."""

from dataclasses import dataclass
from functools import cached_property
from math import radians, tan

import numpy as np

from ...base.numeric.arrays import Array

__all__ = ["Camera", "look_at"]


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera; up is the palm frame's +z.

    Attributes:
        target: point (3,) in the palm frame at the middle of the picture.
        azimuth_deg: direction of view about +z; at 0 the camera looks along +x.
        elevation_deg: direction of view above the horizontal; negative looks down.
        distance: from the eye to the target, in m.
        fovy_deg: vertical angle of view.
    """

    target: Array
    azimuth_deg: float
    elevation_deg: float
    distance: float
    fovy_deg: float = 30.0

    @cached_property
    def axes(self) -> Array:
        """Rows (3, 3): right, up and forward, in the palm frame."""
        azimuth, elevation = radians(self.azimuth_deg), radians(self.elevation_deg)
        forward = np.array(
            [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
        )
        right = np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])
        (x, y, _), (u, v, w) = right, forward
        # Their cross product, which numpy is slow at for a single one.
        return np.array([right, [y * w, -x * w, x * v - y * u], forward])

    @property
    def eye(self) -> Array:
        """Position (3,) of the camera in the palm frame."""
        return self.target - self.distance * self.axes[2]

    def rays(self, width: int, height: int) -> Array:
        """Unit directions (height, width, 3) through the middles of the pixels."""
        reach = tan(radians(0.5 * self.fovy_deg))
        x = reach * (2.0 * (np.arange(width) + 0.5) - width) / height
        y = reach * (height - 2.0 * (np.arange(height) + 0.5)) / height
        right, up, forward = self.axes
        rays = forward + x[None, :, None] * right + y[:, None, None] * up
        return rays / np.linalg.norm(rays, axis=-1, keepdims=True)

    def project(self, points: Array, width: int, height: int) -> Array:
        """Pixel coordinates (n, 2) of points (n, 3): x to the right, y down."""
        right, up, forward = self.axes @ (np.reshape(points, (-1, 3)) - self.eye).T
        scale = 0.5 * height / (tan(radians(0.5 * self.fovy_deg)) * forward)
        return np.column_stack([0.5 * width + right * scale, 0.5 * height - up * scale])


def look_at(
    points: Array,
    azimuth_deg: float,
    elevation_deg: float,
    aspect: float,
    *,
    margin: float = 1.06,
    fovy_deg: float = 30.0,
) -> Camera:
    """A camera that shows all `points` (n, 3), as large as the picture allows.

    Args:
        points: what must be seen, in the palm frame.
        azimuth_deg: direction of view, as in `Camera`.
        elevation_deg: direction of view, as in `Camera`.
        aspect: width of the picture over its height.
        margin: space left around the points.
        fovy_deg: vertical angle of view, as in `Camera`.
    """
    target, distance = 0.5 * (points.min(axis=0) + points.max(axis=0)), 1.0
    axes = Camera(target, azimuth_deg, elevation_deg, distance, fovy_deg).axes
    reach = tan(radians(0.5 * fovy_deg)) / margin
    # The middle of what is seen moves with the distance, so a few rounds settle both.
    for _ in range(8):
        seen = (points - target) @ axes.T
        depth = np.maximum(seen[:, 2] + distance, 1e-3)
        left_right, up_down = seen[:, 0] / depth, seen[:, 1] / depth
        middle = [0.5 * (v.min() + v.max()) * distance for v in (left_right, up_down)]
        target = target + middle[0] * axes[0] + middle[1] * axes[1]
        seen = (points - target) @ axes.T
        needed = np.maximum(np.abs(seen[:, 0]) / aspect, np.abs(seen[:, 1])) / reach - seen[:, 2]
        distance = float(needed.max())
    return Camera(target, azimuth_deg, elevation_deg, distance, fovy_deg)
