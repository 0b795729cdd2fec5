"""What draws a MuJoCo model: its offscreen renderer where an OpenGL backend is named, else ray casting."""

import ctypes
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array, Picture
from ...errors import MissingBackend
from .camera import Camera
from .rays import render_rays
from .transparency import cut_out

__all__ = ["Draw", "open_renderer"]

Draw: TypeAlias = Callable[[Any, Camera, int, int], Picture]
"""Draws MuJoCo's data, after `mj_forward`, as a camera sees it; width and height are in pixels."""

_GL_BACKENDS = ("egl", "osmesa", "glfw")
# Things that a scene has room for.
_MOST_GEOMS = 10000
# Groups of geoms that are drawn: up to this one.
_LAST_GROUP = 2
# Numbers that OpenGL gives to what these are called.
_GL_READ_FRAMEBUFFER, _GL_RGBA, _GL_UNSIGNED_BYTE = 0x8CA8, 0x1908, 0x1401


@contextmanager
def open_renderer(model: Any, *, transparent: bool = False) -> Iterator[Draw]:
    """What draws pictures of a model, with the lamp above the camera's left shoulder.

    Args:
        model: MuJoCo's model.
        transparent: whether pictures have no background, but a fourth channel.

    Raises:
        MissingBackend: the OpenGL backend that is named can't draw.
    """
    if not _uses_opengl():

        def draw(data: Any, camera: Camera, width: int, height: int) -> Picture:
            return render_rays(model, data, camera, _lamp(camera), width, height, transparent=transparent)

        yield draw
        return
    import mujoco  # late, as in `hold.simulation`

    try:
        canvas = _Canvas(model)
    except (ImportError, RuntimeError, AttributeError, mujoco.FatalError) as error:
        backend = os.environ.get("MUJOCO_GL")
        raise MissingBackend(
            f"MuJoCo can't draw with MUJOCO_GL={backend} ({error}); HOLDFAST_RENDERER=rays needs no OpenGL"
        ) from None

    def draw_gl(data: Any, camera: Camera, width: int, height: int) -> Picture:
        canvas.resize(width, height)
        lamp = _lamp(camera)
        data.light_xpos[:] = lamp
        data.light_xdir[:] = (camera.target - lamp) / np.linalg.norm(camera.target - lamp)
        scene = canvas.place(data, camera)
        if not transparent:
            return canvas.paint()
        scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0
        on_black = canvas.paint()
        opacity = canvas.opacity()
        if opacity is not None:
            return cut_out(on_black, opacity)
        # Once more all in white: how much of each pixel there is; without shadows, which take the time.
        for geom in scene.geoms[: scene.ngeom]:
            geom.matid, geom.emission, geom.rgba[:3] = -1, 1.0, 1.0
        shadow = scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW]
        scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        silhouette = canvas.paint()
        scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = shadow
        return cut_out(on_black, silhouette.max(axis=-1))

    try:
        yield draw_gl
    finally:
        canvas.close()


class _Canvas:
    """What MuJoCo draws on, for pictures of any size.

    Its context holds meshes and the map of shadows and takes a tenth of a second to make, so it serves all
    sizes; the buffer that is drawn to is as large as the picture.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: Any):
        import mujoco  # late, as in `hold.simulation`

        self._model = model
        self._size = (0, 0)
        self._options = mujoco.MjvOption()
        self._options.geomgroup[:] = np.arange(6) <= _LAST_GROUP
        self._options.sitegroup[:] = 0
        self._scene = mujoco.MjvScene(model=model, maxgeom=_MOST_GEOMS)
        self._gl = mujoco.GLContext(model.vis.global_.offwidth, model.vis.global_.offheight)
        self._gl.make_current()
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150.value)

    def resize(self, width: int, height: int) -> None:
        """Sets the size of pictures, in pixels."""
        import mujoco

        self._gl.make_current()
        if (width, height) != self._size:
            mujoco.mjr_resizeOffscreen(width, height, self._context)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
            self._size = width, height

    def place(self, data: Any, camera: Camera) -> Any:
        """MuJoCo's scene, with everything where the data has it."""
        import mujoco

        eye = mujoco.MjvCamera()
        eye.lookat[:] = camera.target
        eye.azimuth, eye.elevation = camera.azimuth_deg, camera.elevation_deg
        eye.distance = camera.distance
        self._model.vis.global_.fovy = camera.fovy_deg
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, self._options, None, eye, everything, self._scene)
        return self._scene

    def paint(self) -> Picture:
        """The scene as a picture (height, width, 3)."""
        import mujoco

        width, height = self._size
        whole = mujoco.MjrRect(0, 0, width, height)
        upside_down = np.empty((height, width, 3), dtype=np.uint8)
        mujoco.mjr_render(whole, self._scene, self._context)
        mujoco.mjr_readPixels(upside_down, None, whole, self._context)
        return np.ascontiguousarray(np.flipud(upside_down))

    def opacity(self) -> NDArray[np.uint8] | None:
        """How much there is of each pixel (height, width) of what was painted last, before nothing.

        That is what OpenGL has kept beside the colours. None where it can't be had, or tells nothing: of what
        can be seen through, or where nothing is left of the background.
        """
        if (self._model.geom_rgba[self._model.geom_group <= _LAST_GROUP, 3] < 1.0).any():
            return None
        width, height = self._size
        kept = np.empty((height, width, 4), dtype=np.uint8)
        try:
            # Late, for other renderers do without; these are quick to import, as they check little.
            from OpenGL.raw.GL.VERSION.GL_1_0 import glReadPixels
            from OpenGL.raw.GL.VERSION.GL_3_0 import glBindFramebuffer

            # Where edges are smoothed, MuJoCo has left the smooth picture in a buffer of its own.
            glBindFramebuffer(_GL_READ_FRAMEBUFFER, self._context.offFBO_r or self._context.offFBO)
            try:
                place = ctypes.c_void_p(kept.ctypes.data)
                glReadPixels(0, 0, width, height, _GL_RGBA, _GL_UNSIGNED_BYTE, place)
            finally:
                glBindFramebuffer(_GL_READ_FRAMEBUFFER, self._context.offFBO)
        except Exception:  # noqa: BLE001 - whatever is amiss with a driver, there is another way
            return None
        opacity = np.flipud(kept[..., 3])
        return None if opacity.all() else opacity

    def close(self) -> None:
        """Frees what it has taken of the graphics card."""
        self._gl.make_current()
        self._context.free()
        self._gl.free()


def _uses_opengl() -> bool:
    asked = os.environ.get("HOLDFAST_RENDERER", "").strip().lower()
    named = os.environ.get("MUJOCO_GL", "").strip().lower()
    return asked != "rays" and (asked in _GL_BACKENDS or named in _GL_BACKENDS)


def _lamp(camera: Camera) -> Array:
    right, up, forward = camera.axes
    return camera.target + camera.distance * (-0.6 * right + 0.7 * up - 0.9 * forward)
