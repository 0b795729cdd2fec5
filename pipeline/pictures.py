"""The pictures of a run: four views and a filmstrip of the best grasp, one view of every other."""

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..geometry.transforms import quaternion_from_rotation
from ..mjcf import Grasp, HoldSettings, NotHoldable, Squeeze, hold_test, plan_squeeze
from ..mjcf.render import render_filmstrip, render_states, render_views
from ..objects import Task
from ..solver import Configuration
from .grasps import to_configuration
from .media import VIEW_NAMES, film_path, view_path
from .records import RunRecord
from .run_folder import RunFolder

__all__ = ["draw_grasp", "draw_grasps", "picture"]

Picture = NDArray[np.uint8]
# A filmstrip has a frame for the grasp, the squeeze and each direction: too many for one row of a page.
_FRAME = (320, 300)
_FRAMES_A_ROW = 4


def draw_grasps(task: Task, record: RunRecord, folder: RunFolder, settings: HoldSettings) -> None:
    """Draws what the report of a run shows; pictures that are there already stay."""
    for place, grasp in enumerate(record.grasps):
        configuration = to_configuration(grasp, task, folder.record_path)
        if place == 0:
            draw_grasp(configuration, folder.media, grasp.id, settings)
        elif not view_path(folder.media, grasp.id, VIEW_NAMES[0]).exists():
            _write(view_path(folder.media, grasp.id, VIEW_NAMES[0]), picture(configuration, 240, 320))


def draw_grasp(
    configuration: Configuration, folder: Path, identifier: str, settings: HoldSettings
) -> list[Path]:
    """Draws a grasp from four sides and, where a squeeze is found, its hold test; gives the paths."""
    squeeze = plan_squeeze(configuration, settings)
    grasp = _at_rest(configuration) if isinstance(squeeze, NotHoldable) else Grasp(configuration, squeeze)
    paths = [view_path(folder, identifier, view) for view in VIEW_NAMES]
    for path, view in zip(paths, render_views(grasp), strict=True):
        _write(path, view)
    if not isinstance(squeeze, NotHoldable):
        strip = render_filmstrip(grasp, hold_test(grasp, settings), width=_FRAME[0], height=_FRAME[1])
        paths.append(film_path(folder, identifier))
        _write(paths[-1], _in_rows(strip))
    return paths


def picture(configuration: Configuration, height: int, width: int) -> Picture:
    """A picture (height, width, 3) of a configuration from the front."""
    state = configuration.state
    # MuJoCo's positions: the joints, then the object, which floats.
    object_pose = [state.p_palm_object, quaternion_from_rotation(state.R_palm_object)]
    qpos = np.concatenate([configuration.joint_vector, *object_pose])
    pictures, _ = render_states(_at_rest(configuration), [qpos], width=width, height=height)
    return pictures[0]


def _at_rest(configuration: Configuration) -> Grasp:
    """A grasp that does not squeeze, for drawing."""
    n, contacts = len(configuration.state.q), len(configuration.task.contacts)
    settings = HoldSettings()
    none = np.zeros((contacts, 4))
    loaded = np.zeros((len(settings.directions), contacts, 4))
    return Grasp(configuration, Squeeze(configuration.state.q, np.zeros(n), none, loaded, 0.0, settings))


def _in_rows(strip: Picture) -> Picture:
    """The frames of a strip in rows, the last one filled up with white."""
    frames = [strip[:, start : start + _FRAME[0]] for start in range(0, strip.shape[1], _FRAME[0])]
    missing = -len(frames) % _FRAMES_A_ROW
    frames += [np.full_like(frames[0], 255)] * missing
    rows = [
        np.concatenate(frames[start : start + _FRAMES_A_ROW], axis=1)
        for start in range(0, len(frames), _FRAMES_A_ROW)
    ]
    return np.concatenate(rows, axis=0)


def _write(path: Path, pixels: Picture) -> None:
    """Writes a picture whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        Image.fromarray(pixels).save(temporary, "PNG", optimize=True)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
