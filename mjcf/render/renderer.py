"""What draws a MuJoCo model: its offscreen renderer where an OpenGL backend is named, else ray casting."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

import numpy as np

from ...arrays import Array, Picture
from ...errors import MissingBackend
from .camera import Camera
from .rays import render_rays
from .transparency import cut_out

__all__ = ["Draw", "open_renderer"]

Draw: TypeAlias = Callable[[Any, Camera], Picture]
"""Draws MuJoCo's data, after `mj_forward`, as a camera sees it."""

_GL_BACKENDS = ("egl", "osmesa", "glfw")


@contextmanager
def open_renderer(model: Any, width: int, height: int, *, transparent: bool = False) -> Iterator[Draw]:
    """What draws pictures of one size, with the lamp above the camera's left shoulder.

    Args:
        model: MuJoCo's model.
        width: in pixels.
        height: in pixels.
        transparent: whether pictures have no background, but a fourth channel.

    Raises:
        MissingBackend: the OpenGL backend that is named can't draw.
    """
    if not _uses_opengl():

        def draw(data: Any, camera: Camera) -> Picture:
            return render_rays(model, data, camera, _lamp(camera), width, height, transparent=transparent)

        yield draw
        return
    import mujoco  # late, as in `hold.simulation`

    # The buffer for drawing is as large as the picture, however large that is.
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
    try:
        renderer = mujoco.Renderer(model, height, width)
    except (ImportError, RuntimeError, AttributeError, mujoco.FatalError) as error:
        backend = os.environ.get("MUJOCO_GL")
        raise MissingBackend(
            f"MuJoCo can't draw with MUJOCO_GL={backend} ({error}); HOLDFAST_RENDERER=rays needs no OpenGL"
        ) from None
    options = mujoco.MjvOption()
    options.geomgroup[:] = [1, 1, 1, 0, 0, 0]
    options.sitegroup[:] = 0

    def draw_gl(data: Any, camera: Camera) -> Picture:
        eye = mujoco.MjvCamera()
        eye.lookat[:] = camera.target
        eye.azimuth, eye.elevation = camera.azimuth_deg, camera.elevation_deg
        eye.distance = camera.distance
        model.vis.global_.fovy = camera.fovy_deg
        lamp = _lamp(camera)
        data.light_xpos[:] = lamp
        data.light_xdir[:] = (camera.target - lamp) / np.linalg.norm(camera.target - lamp)
        renderer.update_scene(data, eye, options)
        if not transparent:
            return np.array(renderer.render())
        flags = renderer.scene.flags
        flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0
        on_black = np.array(renderer.render())
        # Once more all in white: how much of each pixel there is; without shadows, which take the time.
        for geom in renderer.scene.geoms[: renderer.scene.ngeom]:
            geom.matid, geom.emission, geom.rgba[:3] = -1, 1.0, 1.0
        shadow = flags[mujoco.mjtRndFlag.mjRND_SHADOW]
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        silhouette = np.array(renderer.render())
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = shadow
        return cut_out(on_black, silhouette)

    with renderer:
        yield draw_gl


def _uses_opengl() -> bool:
    asked = os.environ.get("HOLDFAST_RENDERER", "").strip().lower()
    named = os.environ.get("MUJOCO_GL", "").strip().lower()
    return asked != "rays" and (asked in _GL_BACKENDS or named in _GL_BACKENDS)


def _lamp(camera: Camera) -> Array:
    right, up, forward = camera.axes
    return camera.target + camera.distance * (-0.6 * right + 0.7 * up - 0.9 * forward)
