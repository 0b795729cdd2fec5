"""A renderer without OpenGL: casts MuJoCo's own rays and shades what they hit."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from .camera import Camera
from .transparency import straight_alpha

__all__ = ["geoms_hit", "render_rays", "seen_from"]

_SKY_TOP, _SKY_BOTTOM = np.array([0.93, 0.945, 0.96]), np.array([1.0, 1.0, 1.0])
_AMBIENT, _KEY, _FILL, _SHINE = 0.40, 0.52, 0.22, 0.08
_SHADOW_BIAS_M = 5e-4


def render_rays(
    model: Any,
    data: Any,
    camera: Camera,
    light: Array,
    width: int,
    height: int,
    *,
    samples: int = 2,
    transparent: bool = False,
) -> NDArray[np.uint8]:
    """A picture (height, width, 3) of the geoms in groups 0 to 2.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data, after `mj_forward`.
        camera: where from.
        light: position (3,) of the lamp in the palm frame.
        width: in pixels.
        height: in pixels.
        samples: rays per pixel along each side, against jagged edges.
        transparent: whether there is nothing where no geom is, in a fourth channel, in place of a sky.
    """
    w, h = samples * width, samples * height
    rays = camera.rays(w, h).reshape(-1, 3)
    distance, geom, normal = _cast(model, data, camera.eye, rays)
    hit = geom >= 0
    up = 0.5 * (1.0 + np.linspace(1.0, -1.0, h))
    colours = np.repeat(up[:, None, None] * (_SKY_TOP - _SKY_BOTTOM) + _SKY_BOTTOM, w, axis=1).reshape(-1, 3)
    points = camera.eye + distance[hit, None] * rays[hit]
    colours[hit] = _shade(model, data, points, rays[hit], normal[hit], geom[hit], light)
    if transparent:
        layers = np.column_stack([colours * hit[:, None], hit])
        layers = layers.reshape(height, samples, width, samples, 4).mean(axis=(1, 3))
        return straight_alpha(layers[..., :3], layers[..., 3])
    picture = colours.reshape(height, samples, width, samples, 3).mean(axis=(1, 3))
    return (np.clip(picture, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def seen_from(model: Any, data: Any, eye: Array, points: Array) -> NDArray[np.bool_]:
    """Whether nothing that is drawn lies between `eye` (3,) and each of `points` (n, 3)."""
    way = points - eye
    length = np.linalg.norm(way, axis=1)
    distance, _, _ = _cast(model, data, eye, way / length[:, None])
    return (distance < 0.0) | (distance > length - _SHADOW_BIAS_M)


def geoms_hit(model: Any, data: Any, eye: Array, rays: Array) -> NDArray[np.int32]:
    """What unit directions (n, 3) from `eye` (3,) meet first: geoms (n,) that are drawn, -1 for none."""
    return _cast(model, data, eye, rays)[1]


def _shade(
    model: Any, data: Any, points: Array, rays: Array, normals: Array, geom: NDArray[np.int32], light: Array
) -> Array:
    """Colours (n, 3) of points that rays hit: ambient, the lamp with its shadow, light from the camera."""
    # Rays report a face's normal as it lies; shade the side that is seen.
    normals = normals * -np.sign(np.einsum("ij,ij->i", normals, rays))[:, None]
    to_light = light - points
    reach = np.linalg.norm(to_light, axis=1)
    to_light /= reach[:, None]
    facing = np.maximum(np.einsum("ij,ij->i", normals, to_light), 0.0)
    lit = facing > 0.0
    if model.light_castshadow.any():
        from_light = points + _SHADOW_BIAS_M * normals - light
        length = np.linalg.norm(from_light, axis=1)
        blocked, _, _ = _cast(model, data, light, from_light / length[:, None])
        lit &= (blocked < 0.0) | (blocked > length - _SHADOW_BIAS_M)
    half = to_light - rays
    half /= np.linalg.norm(half, axis=1)[:, None]
    shine = np.maximum(np.einsum("ij,ij->i", normals, half), 0.0) ** 40
    head_on = np.maximum(-np.einsum("ij,ij->i", normals, rays), 0.0)
    albedo = model.geom_rgba[geom, :3].astype(float)
    diffuse = _AMBIENT + _KEY * facing * lit + _FILL * head_on
    return albedo * diffuse[:, None] + (_SHINE * shine * lit)[:, None]


def _cast(model: Any, data: Any, origin: Array, rays: Array) -> tuple[Array, NDArray[np.int32], Array]:
    """Distances (n,), -1 where nothing is hit, geoms (n,) and normals (n, 3) of unit rays from one point."""
    import mujoco  # late, as in `hold.simulation`

    n = len(rays)
    distance, normal = np.zeros(n), np.zeros(3 * n)
    geom = np.full(n, -1, dtype=np.int32)
    groups = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
    if n:
        flat = np.ascontiguousarray(rays).ravel()
        mujoco.mj_multiRay(
            model, data, origin, flat, groups, 1, -1, geom, distance, normal, n, mujoco.mjMAXVAL
        )
    return distance, geom, normal.reshape(-1, 3)
