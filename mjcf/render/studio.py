"""Pictures of grasps: views from four sides, and a filmstrip of the test.

Drawn by MuJoCo's offscreen renderer where the environment names an OpenGL backend (MUJOCO_GL, which
`holdfast.base.machine.backend.configure` sets), and by ray casting where HOLDFAST_RENDERER is `rays` or no
backend is named.
"""

import atexit
import weakref
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import numpy as np

from ...base.machine.cancellation import give_up_if_asked
from ...base.numeric.arrays import Array, Picture
from ...objects import Task
from ...solver import Configuration
from ..gravity import gravity_names
from ..hold import HoldResult, outcome_word
from ..model import Grasp, compiled_model, grasp_qpos
from ..settings import HoldSettings
from .annotations import with_caption, with_rings
from .camera import Camera
from .renderer import Draw, open_renderer
from .views import VIEWS, ContactMarks, best_camera, visible_contacts, zoomed_in

__all__ = ["VIEWS", "Studio"]

# A film is about the contacts.
_FILM_CLOSENESS = 1.3
# Size of what is drawn, for the renderer's depth range.
_EXTENT_M = 0.5
# Side of the map of shadows, and the share of the lamp's cone that it covers: what the camera sees, which the
# lamp, farther away, has within 21 of its 60 degrees. A finer or wider map would take most of the time.
_SHADOW_PX, _SHADOW_SHARE = 1280, 0.4


class Studio:
    """Draws the configurations of one task.

    The model and a renderer are set up at first use (0.2 s by OpenGL), or when they are told to
    `get_ready`, and serve every picture after that (0.05 s each), until the studio is closed:

        with Studio(task) as studio:
            pictures = [studio.view(configuration) for configuration in configurations]

    Args:
        task: whose configurations it draws.
        transparent: whether pictures (height, width, 4) have no background, so that they suit any page.

    Attributes:
        task: as above.
    """

    def __init__(self, task: Task, *, transparent: bool = False):
        self.task = task
        self._transparent = transparent
        self._loaded: tuple[Any, Any] | None = None
        self._draw: Draw | None = None
        self._open = ExitStack()
        # Of the films that were drawn last: the configuration, the picture's aspect and the camera.
        self._filmed: tuple[Configuration, float, Camera] | None = None

    def __enter__(self) -> "Studio":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Frees the renderer."""
        self._draw = None
        self._open.close()

    @property
    def is_ready(self) -> bool:
        """Whether the next picture needs nothing but to be drawn."""
        return self._draw is not None

    def get_ready(self) -> None:
        """Sets up model and renderer.

        Raises:
            MissingBackend: the OpenGL backend that is named can't draw.
        """
        self._renderer()

    def view(
        self, configuration: Configuration, view: str = "front", *, width: int = 640, height: int = 480
    ) -> Picture:
        """A picture (height, width, 3) of a configuration from about one side; rings mark the contacts.

        Args:
            configuration: hand and object, of this studio's task.
            view: one of `VIEWS`; the camera looks from nearby where that shows more.
            width: in pixels.
            height: in pixels.
        """
        model, data = self._pose(configuration)
        marks = ContactMarks.of(configuration)
        camera = best_camera(model, data, marks, [VIEWS[view]], width / height)
        return self._marked(marks, camera, width, height)

    def filmstrip(
        self, grasp: Grasp, result: HoldResult, *, width: int = 320, height: int = 300
    ) -> Iterator[Picture]:
        """The frames of a filmstrip of a test, from the side that shows most; each is drawn when asked for.

        They are the open fingers, the squeeze, and the end of the test in each direction of gravity; of a
        turn or a press the middle and the end.

        Args:
            grasp: the grasp.
            result: its test.
            width: of one frame, in pixels.
            height: of one frame, in pixels.
        """
        return self._captioned(grasp, _frames(grasp, result), width, height)

    def video(
        self, grasp: Grasp, result: HoldResult, *, width: int = 256, height: int = 240, frames: int = 18
    ) -> Iterator[Picture]:
        """The pictures of a video of a test, from the side that shows most; each is drawn when asked for.

        The fingers close, squeeze, and hold in the direction of gravity in which the object moves most.

        Args:
            grasp: the grasp.
            result: its test.
            width: of a picture, in pixels.
            height: of a picture, in pixels.
            frames: how many pictures there are, about.
        """
        return self._captioned(grasp, _video_frames(grasp, result, frames), width, height)

    def _captioned(self, grasp: Grasp, frames: "list[_Frame]", width: int, height: int) -> Iterator[Picture]:
        camera = self._film_camera(grasp.configuration, width / height)
        for frame in frames:
            picture = self.state(grasp.configuration, frame.qpos, camera, width=width, height=height)
            yield with_caption(picture, frame.label, frame.gravity, camera)

    def _film_camera(self, configuration: Configuration, aspect: float) -> Camera:
        """The camera of a film: from the side that shows most of hand and contacts, and close to these."""
        known = self._filmed
        if known is not None and known[0] is configuration and known[1] == aspect:
            return known[2]
        model, data = self._pose(configuration)
        marks = ContactMarks.of(configuration)
        camera = zoomed_in(
            best_camera(model, data, marks, list(VIEWS.values()), aspect), marks, _FILM_CLOSENESS
        )
        self._filmed = configuration, aspect, camera
        return camera

    def state(
        self, configuration: Configuration, qpos: Array, camera: Camera, *, width: int, height: int
    ) -> Picture:
        """A picture (height, width, 3) of a MuJoCo position, such as those in `DirectionResult.qpos`.

        An object that drops leaves the picture. Rings mark the contacts' places on the object.

        Args:
            configuration: whose contacts they are.
            qpos: MuJoCo position (nq,).
            camera: where from.
            width: in pixels.
            height: in pixels.
        """
        model, data = self._pose(configuration)
        _place(model, data, qpos)
        return self._marked(ContactMarks.of(configuration, qpos[-7:]), camera, width, height)

    def _marked(self, marks: ContactMarks, camera: Camera, width: int, height: int) -> Picture:
        """What stands before the camera, with rings around the contacts, dashed where they are hidden."""
        give_up_if_asked()
        draw = self._renderer()
        model, data = self._model()
        picture = draw(data, camera, width, height)
        in_sight = visible_contacts(model, data, marks, camera)
        return with_rings(picture, camera.project(marks.points, width, height), in_sight)

    def _pose(self, configuration: Configuration) -> tuple[Any, Any]:
        """MuJoCo's model and data, with hand and object as the configuration has them."""
        if configuration.task is not self.task:
            raise ValueError(f"this studio draws task {self.task.name}, not {configuration.task.name}")
        model, data = self._model()
        qpos = grasp_qpos(configuration)
        # The parts that stay behind, if any, stay with the configuration.
        data.mocap_pos[:], data.mocap_quat[:] = qpos[-7:-4], qpos[-4:]
        _place(model, data, qpos)
        return model, data

    def _model(self) -> tuple[Any, Any]:
        """MuJoCo's model and data."""
        if self._loaded is None:
            import mujoco  # late, as in `hold.simulation`

            model = compiled_model(self.task, HoldSettings(), floats=True)
            # MuJoCo takes this, and with it depths and shadows, from where the object first stands.
            model.stat.center[:], model.stat.extent = 0.0, _EXTENT_M
            model.vis.quality.shadowsize, model.vis.map.shadowscale = _SHADOW_PX, _SHADOW_SHARE
            self._loaded = model, mujoco.MjData(model)
        return self._loaded

    def _renderer(self) -> Draw:
        """What draws the model."""
        if self._draw is None:
            self._draw = self._open.enter_context(
                open_renderer(self._model()[0], transparent=self._transparent)
            )
            # Registered after OpenGL's own clean-up, so run before it: a studio left open ends quietly.
            atexit.register(_close_if_alive, weakref.ref(self))
        return self._draw


def _close_if_alive(reference: "weakref.ref[Studio]") -> None:
    studio = reference()
    if studio is not None:
        studio.close()


def _place(model: Any, data: Any, qpos: Array) -> None:
    import mujoco  # late, as in `hold.simulation`

    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)


@dataclass(frozen=True, eq=False)
class _Frame:
    """A frame of a filmstrip."""

    qpos: Array
    label: str
    gravity: Array | None = None


def _frames(grasp: Grasp, result: HoldResult) -> list[_Frame]:
    configuration = grasp.configuration
    start = grasp_qpos(configuration)
    start[:-7] = configuration.task.hand.expand(grasp.approach.pregrasp)
    frames = [_Frame(start, "open"), _Frame(result.squeezed_qpos, "squeezed")]
    for direction, label in zip(result.directions, _gravity_labels(result), strict=True):
        last = direction.qpos[-1]
        outcome = outcome_word(direction.outcome, result.kind)
        if np.any(direction.gravity):
            gravity = np.array(direction.gravity)
            frames.append(_Frame(last, f"{label}  {outcome}", gravity))
        else:
            frames.append(_Frame(direction.qpos[len(direction.qpos) // 2], "half way"))
            frames.append(_Frame(last, f"at the end  {outcome}"))
    return frames


def _video_frames(grasp: Grasp, result: HoldResult, count: int) -> list[_Frame]:
    """States of a test about evenly apart: a third of them for the closing, the squeeze, and what follows."""
    each = max(2, count // 3)
    configuration = grasp.configuration
    pose = grasp_qpos(configuration)[-7:]
    q = np.array([configuration.task.hand.expand(row) for row in grasp.approach.waypoints])
    way = np.concatenate([[0.0], np.abs(np.diff(q, axis=0)).max(axis=1).cumsum()])
    places = np.linspace(0.0, way[-1], each)
    closing = np.column_stack([np.interp(places, way, joint) for joint in q.T])
    frames = [_Frame(np.concatenate([row, pose]), "closing") for row in closing]
    start, end = frames[-1].qpos, result.squeezed_qpos
    frames += [
        _Frame(start + share * (end - start), "squeezing") for share in np.linspace(0.0, 1.0, each)[1:]
    ]
    worst = max(result.directions, key=lambda entry: np.nan_to_num(entry.slip_m, nan=np.inf))
    whole = np.flatnonzero(np.isfinite(worst.qpos).all(axis=1))
    gravity = np.array(worst.gravity) if np.any(worst.gravity) else None
    label = "the test" if gravity is None else _gravity_labels(result)[result.directions.index(worst)]
    for k in np.unique(np.linspace(0, len(whole) - 1, each).round().astype(int)):
        frames.append(_Frame(worst.qpos[whole[k]], label, gravity))
    last = frames[-1]
    outcome = outcome_word(worst.outcome, result.kind)
    return [*frames[:-1], _Frame(last.qpos, f"{last.label}  {outcome}", last.gravity)]


def _gravity_labels(result: HoldResult) -> list[str]:
    """`gravity -y` and the like for each direction, as far as the font of pictures goes."""
    names = gravity_names([entry.gravity for entry in result.directions])
    return [f"gravity {name.replace('−', '-')}" for name in names]
