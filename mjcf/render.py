"""Pictures of a grasp: four views, and a filmstrip of the hold.

Drawn by MuJoCo's offscreen renderer where the environment names an OpenGL backend (MUJOCO_GL, which
`holdfast.pipeline.backend.configure` sets), and by ray casting where HOLDFAST_RENDERER is `rays` or no
backend is named. Contacts are marked by rings.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from ..errors import MissingBackend
from .camera import Camera, look_at
from .grasp import Grasp
from .grasp_model import GRASP_KEY, grasp_mjcf
from .hold_result import HoldResult
from .rays import render_rays

__all__ = ["VIEWS", "render_filmstrip", "render_states", "render_views"]

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]

VIEWS = {"front": (205.0, -18.0), "left": (295.0, -18.0), "back": (25.0, -18.0), "right": (115.0, -18.0)}
"""Azimuth and elevation in degrees of the four views; the palm faces the front."""

_GL_BACKENDS = ("egl", "osmesa", "glfw")
_RING = (214, 48, 36)
_ARROW = (40, 44, 52)
_INK = (60, 64, 72)


def render_views(grasp: Grasp, *, width: int = 640, height: int = 480) -> list[Picture]:
    """Pictures (height, width, 3) of the grasp from the four sides in `VIEWS`."""
    model, data = _load(grasp)
    points = _visible_points(model, data)
    contacts = np.array([point.p_object for point in grasp.configuration.contact_points])
    pictures = []
    with _renderer(model, width, height) as draw:
        for azimuth, elevation in VIEWS.values():
            camera = look_at(points, azimuth, elevation, width / height)
            picture = draw(data, camera)
            pictures.append(_with_rings(picture, camera.project(contacts, width, height)))
    return pictures


def render_filmstrip(grasp: Grasp, result: HoldResult, *, width: int = 320, height: int = 300) -> Picture:
    """One wide picture: the grasp, the squeeze, and the end of the test in each direction of gravity.

    Args:
        grasp: the grasp.
        result: its hold test.
        width: of one frame, in pixels.
        height: of one frame, in pixels.
    """
    _, data = _load(grasp)
    states = [data.qpos.copy(), result.squeezed_qpos] + [d.qpos[-1] for d in result.directions]
    labels = ["grasp", "squeezed"]
    labels += [f"{_axis_name(d.gravity)}  {d.outcome.value}" for d in result.directions]
    gravities = [None, None, *(np.array(d.gravity) for d in result.directions)]
    frames, camera = render_states(grasp, states, width=width, height=height, closeness=1.7)
    pictures = [
        _captioned(frame, label, gravity, camera)
        for frame, label, gravity in zip(frames, labels, gravities, strict=True)
    ]
    return np.concatenate(pictures, axis=1)


def render_states(
    grasp: Grasp,
    states: Sequence[Array],
    *,
    width: int = 640,
    height: int = 480,
    view: str = "front",
    closeness: float = 1.0,
) -> tuple[list[Picture], Camera]:
    """Pictures of MuJoCo positions, such as those in `DirectionResult.qpos`, all by one camera.

    The camera shows hand and object where the grasp has them; an object that drops leaves the picture.

    Args:
        grasp: the grasp.
        states: MuJoCo positions (nq,), one a picture.
        width: in pixels.
        height: in pixels.
        view: one of `VIEWS`.
        closeness: 1 shows the whole; above 1 brings the contacts so many times closer.

    Returns:
        Pictures (height, width, 3), and the camera.
    """
    model, data = _load(grasp)
    camera = look_at(_visible_points(model, data), *VIEWS[view], width / height)
    if closeness != 1.0:
        contacts = np.array([point.p_object for point in grasp.configuration.contact_points])
        camera = replace(
            camera,
            target=contacts.mean(axis=0) + (camera.target - contacts.mean(axis=0)) / closeness**2,
            distance=camera.distance / closeness,
        )
    import mujoco  # late, as in `hold`

    pictures = []
    with _renderer(model, width, height) as draw:
        for qpos in states:
            data.qpos[:] = qpos
            mujoco.mj_forward(model, data)
            pictures.append(draw(data, camera))
    return pictures, camera


class _Draw(Protocol):
    def __call__(self, data: Any, camera: Camera) -> Picture: ...


@contextmanager
def _renderer(model: Any, width: int, height: int) -> Iterator[_Draw]:
    """What draws, with the lamp above the camera's left shoulder."""
    if not _uses_opengl():

        def draw(data: Any, camera: Camera) -> Picture:
            return render_rays(model, data, camera, _lamp(camera), width, height)

        yield draw
        return
    import mujoco  # late, as in `hold`

    try:
        renderer = mujoco.Renderer(model, height, width)
    except (ImportError, RuntimeError, AttributeError) as error:
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
        return np.array(renderer.render())

    with renderer:
        yield draw_gl


def _uses_opengl() -> bool:
    asked = os.environ.get("HOLDFAST_RENDERER", "").strip().lower()
    named = os.environ.get("MUJOCO_GL", "").strip().lower()
    return asked != "rays" and (asked in _GL_BACKENDS or named in _GL_BACKENDS)


def _lamp(camera: Camera) -> Array:
    right, up, forward = camera.axes
    return camera.target + camera.distance * (-0.6 * right + 0.7 * up - 0.9 * forward)


def _load(grasp: Grasp) -> tuple[Any, Any]:
    """MuJoCo's model and data at the grasp."""
    import mujoco  # late, as in `hold`

    model = mujoco.MjModel.from_xml_string(grasp_mjcf(grasp.configuration, grasp.squeeze.settings))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(GRASP_KEY).id)
    mujoco.mj_forward(model, data)
    return model, data


def _visible_points(model: Any, data: Any) -> Array:
    """Corners (n, 3) of the boxes around all geoms that are drawn."""
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    corners = []
    for i in np.flatnonzero(model.geom_group <= 2):
        centre, half = model.geom_aabb[i, :3], model.geom_aabb[i, 3:]
        corners.append((centre + signs * half) @ data.geom_xmat[i].reshape(3, 3).T + data.geom_xpos[i])
    return np.concatenate(corners)


def _with_rings(picture: Picture, pixels: Array) -> Picture:
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    radius = max(3, picture.shape[0] // 80)
    for x, y in pixels:
        for r, colour in ((radius + 1, (255, 255, 255)), (radius, _RING)):
            draw.ellipse((x - r, y - r, x + r, y + r), outline=colour, width=2)
    return np.array(image)


def _axis_name(direction: Sequence[float]) -> str:
    i = int(np.argmax(np.abs(direction)))
    return f"gravity {'+' if direction[i] > 0 else '-'}{'xyz'[i]}"


def _captioned(picture: Picture, label: str, gravity: Array | None, camera: Camera) -> Picture:
    """Adds a line of text, and an arrow along gravity, which shrinks as gravity points at the camera."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    height, width = picture.shape[:2]
    font = ImageFont.load_default(max(11, height // 22))
    draw.text((8, 6), label, fill=_INK, font=font, stroke_width=2, stroke_fill="white")
    if gravity is not None:
        step = camera.axes[:2] @ gravity * [1.0, -1.0] * 0.11 * height
        middle = np.array([width - 0.15 * height, height - 0.15 * height])
        _arrow(draw, middle - step, middle + step, 0.035 * height)
    draw.line((width - 1, 0, width - 1, height), fill=(225, 228, 232))
    return np.array(image)


def _arrow(draw: ImageDraw.ImageDraw, start: Array, end: Array, head: float) -> None:
    along = end - start
    length = float(np.linalg.norm(along))
    if length < 1e-6:
        return
    along /= length
    head = min(head, length)
    across = np.array([-along[1], along[0]])
    # First wider and white, so that the arrow stands out from whatever is behind it.
    for colour, more in (("white", 2.0), (_ARROW, 0.0)):
        neck = end - head * along
        draw.line((*(start - more * along), *neck), fill=colour, width=round(3 + 2 * more))
        wing = (0.5 * head + 1.5 * more) * across
        corners = [end + 2.0 * more * along, neck - more * along + wing, neck - more * along - wing]
        draw.polygon([(float(x), float(y)) for x, y in corners], fill=colour)
