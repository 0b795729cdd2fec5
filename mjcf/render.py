"""Pictures of grasps: views from four sides, and a filmstrip of the hold.

Drawn by MuJoCo's offscreen renderer where the environment names an OpenGL backend (MUJOCO_GL, which
`holdfast.pipeline.backend.configure` sets), and by ray casting where HOLDFAST_RENDERER is `rays` or no
backend is named.
"""

import atexit
import os
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from types import TracebackType
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..errors import MissingBackend
from ..geometry.transforms import perpendicular
from ..objects import Task
from ..solver import Configuration
from .camera import Camera, look_at
from .grasp_model import grasp_mjcf, grasp_qpos
from .hold_result import HoldResult
from .marks import with_caption, with_rings
from .rays import render_rays, seen_from

__all__ = ["VIEWS", "Studio"]

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
_Draw: TypeAlias = Callable[[Any, Camera], Picture]

VIEWS = {"front": (205.0, -18.0), "left": (295.0, -18.0), "back": (25.0, -18.0), "right": (115.0, -18.0)}
"""Azimuth and elevation in degrees of the four views; the palm faces the front."""

_GL_BACKENDS = ("egl", "osmesa", "glfw")
# Where two bodies touch, they hide the very point; a contact is in sight where a point this far beside it is.
_RIM_M = 0.004
_RIM_POINTS = 16
# Size of what is drawn, for the renderer's depth range.
_EXTENT_M = 0.5


class Studio:
    """Draws the configurations of one task.

    The model, and a renderer for each size of picture, are set up at first use (0.2 s each by OpenGL) and
    serve every picture after that (0.05 s each), until the studio is closed:

        with Studio(task) as studio:
            pictures = [studio.view(configuration) for configuration in configurations]
    """

    def __init__(self, task: Task):
        self._task = task
        self._loaded: tuple[Any, Any] | None = None
        self._renderers: dict[tuple[int, int], _Draw] = {}
        self._open = ExitStack()

    def __enter__(self) -> "Studio":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Frees the renderers."""
        self._renderers.clear()
        self._open.close()

    def view(
        self, configuration: Configuration, view: str = "front", *, width: int = 640, height: int = 480
    ) -> Picture:
        """A picture (height, width, 3) of a configuration from one side.

        Args:
            configuration: hand and object, of this studio's task.
            view: one of `VIEWS`.
            width: in pixels.
            height: in pixels.
        """
        model, data = self._pose(configuration)
        camera = look_at(_visible_points(model, data), *VIEWS[view], width / height)
        return self._renderer(width, height)(data, camera)

    def views(self, configuration: Configuration, *, width: int = 640, height: int = 480) -> list[Picture]:
        """Pictures from the four sides in `VIEWS`; rings mark the contacts, dashed where they are hidden."""
        model, data = self._pose(configuration)
        contacts = np.array([point.p_object for point in configuration.contact_points])
        pictures = []
        for azimuth, elevation in VIEWS.values():
            camera = look_at(_visible_points(model, data), azimuth, elevation, width / height)
            picture = self._renderer(width, height)(data, camera)
            in_sight = _contacts_in_sight(model, data, configuration, camera)
            pictures.append(with_rings(picture, camera.project(contacts, width, height), in_sight))
        return pictures

    def filmstrip(
        self, configuration: Configuration, result: HoldResult, *, width: int = 320, height: int = 300
    ) -> Picture:
        """One wide picture: the grasp, the squeeze, and the end of the test in each direction of gravity.

        Args:
            configuration: the grasp's.
            result: its hold test.
            width: of one frame, in pixels.
            height: of one frame, in pixels.
        """
        states = [grasp_qpos(configuration), result.squeezed_qpos, *(d.qpos[-1] for d in result.directions)]
        labels = ["grasp", "squeezed"]
        labels += [f"{_axis_name(d.gravity)}  {d.outcome.value}" for d in result.directions]
        gravities = [None, None, *(_arrow(d.gravity) for d in result.directions)]
        frames, camera = self.states(configuration, states, width=width, height=height, closeness=1.7)
        pictures = [
            with_caption(frame, label, gravity, camera)
            for frame, label, gravity in zip(frames, labels, gravities, strict=True)
        ]
        return np.concatenate(pictures, axis=1)

    def states(
        self,
        configuration: Configuration,
        states: Sequence[Array],
        *,
        width: int = 640,
        height: int = 480,
        view: str = "front",
        closeness: float = 1.0,
    ) -> tuple[list[Picture], Camera]:
        """Pictures of MuJoCo positions, such as those in `DirectionResult.qpos`, all by one camera.

        The camera shows hand and object where the configuration has them; an object that drops leaves the
        picture.

        Args:
            configuration: what the camera is aimed at.
            states: MuJoCo positions (nq,), one a picture.
            width: in pixels.
            height: in pixels.
            view: one of `VIEWS`.
            closeness: 1 shows the whole; above 1 brings the contacts so many times closer.

        Returns:
            Pictures (height, width, 3), and the camera.
        """
        model, data = self._pose(configuration)
        camera = look_at(_visible_points(model, data), *VIEWS[view], width / height)
        if closeness != 1.0:
            contacts = np.array([point.p_object for point in configuration.contact_points])
            camera = replace(
                camera,
                target=contacts.mean(axis=0) + (camera.target - contacts.mean(axis=0)) / closeness**2,
                distance=camera.distance / closeness,
            )
        draw = self._renderer(width, height)
        pictures = []
        for qpos in states:
            _place(model, data, qpos)
            pictures.append(draw(data, camera))
        return pictures, camera

    def _pose(self, configuration: Configuration) -> tuple[Any, Any]:
        """MuJoCo's model and data, with hand and object as the configuration has them."""
        if configuration.task is not self._task:
            raise ValueError(f"this studio draws task {self._task.name}, not {configuration.task.name}")
        if self._loaded is None:
            import mujoco  # late, as in `hold`

            # Configurations of a task differ in the keyframe alone, and in the sites, which are not drawn.
            model = mujoco.MjModel.from_xml_string(grasp_mjcf(configuration))
            # MuJoCo takes this, and with it depths and shadows, from where the object first stands.
            model.stat.center[:], model.stat.extent = 0.0, _EXTENT_M
            self._loaded = model, mujoco.MjData(model)
        model, data = self._loaded
        qpos = grasp_qpos(configuration)
        # The parts that stay behind, if any, stay with the configuration.
        data.mocap_pos[:], data.mocap_quat[:] = qpos[-7:-4], qpos[-4:]
        _place(model, data, qpos)
        return model, data

    def _renderer(self, width: int, height: int) -> _Draw:
        """What draws pictures of this size."""
        assert self._loaded is not None  # `_pose` comes first
        if (width, height) not in self._renderers:
            draw = self._open.enter_context(_renderer(self._loaded[0], width, height))
            if not self._renderers:
                # Registered after OpenGL's own clean-up, so run before it: a studio left open ends quietly.
                atexit.register(_close_if_alive, weakref.ref(self))
            self._renderers[width, height] = draw
        return self._renderers[width, height]


def _close_if_alive(reference: "weakref.ref[Studio]") -> None:
    studio = reference()
    if studio is not None:
        studio.close()


def _place(model: Any, data: Any, qpos: Array) -> None:
    import mujoco  # late, as in `hold`

    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)


@contextmanager
def _renderer(model: Any, width: int, height: int) -> Iterator[_Draw]:
    """What draws, with the lamp above the camera's left shoulder."""
    if not _uses_opengl():

        def draw(data: Any, camera: Camera) -> Picture:
            return render_rays(model, data, camera, _lamp(camera), width, height)

        yield draw
        return
    import mujoco  # late, as in `hold`

    # The buffer for drawing is as large as the picture, however large that is.
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
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


def _visible_points(model: Any, data: Any) -> Array:
    """Corners (n, 3) of the boxes around all geoms that are drawn."""
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    corners = []
    for i in np.flatnonzero(model.geom_group <= 2):
        centre, half = model.geom_aabb[i, :3], model.geom_aabb[i, 3:]
        corners.append((centre + signs * half) @ data.geom_xmat[i].reshape(3, 3).T + data.geom_xpos[i])
    return np.concatenate(corners)


def _contacts_in_sight(model: Any, data: Any, configuration: Configuration, camera: Camera) -> list[bool]:
    """Whether any point around each contact, in the tangent plane, is seen by the camera."""
    angles = np.linspace(0.0, 2.0 * np.pi, _RIM_POINTS, endpoint=False)
    circle = _RIM_M * np.column_stack([np.cos(angles), np.sin(angles)])
    return [
        bool(
            seen_from(model, data, camera.eye, point.p_object + circle @ perpendicular(point.n_object)).any()
        )
        for point in configuration.contact_points
    ]


def _arrow(direction: Sequence[float]) -> Array | None:
    return np.array(direction) if np.any(direction) else None


def _axis_name(direction: Sequence[float]) -> str:
    if not np.any(direction):
        return "at the end"
    i = int(np.argmax(np.abs(direction)))
    return f"gravity {'+' if direction[i] > 0 else '-'}{'xyz'[i]}"
