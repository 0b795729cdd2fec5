"""The pictures of a run: four views and a filmstrip of the best grasp, one view of every other."""

import io
from pathlib import Path

import numpy as np
from PIL import Image

from ...arrays import Picture
from ...files import write_bytes
from ...mjcf import Grasp, HoldSettings, NotHoldable, hold_test, plan_squeeze
from ...mjcf.render import Studio
from ...objects import Task
from ...retraction import Approach
from ...solver import Configuration
from ..records import RunFolder, RunRecord, to_approach, to_configuration
from .media import VIEW_NAMES, film_path, view_path

__all__ = ["draw_grasp", "draw_grasps"]

_VIEW = (640, 480)
_THUMBNAIL = (320, 240)
# A filmstrip has a frame for the pregrasp, the squeeze and each direction: too many for one row of a page.
_FRAME = (320, 300)
_FRAMES_A_ROW = 4


def draw_grasps(task: Task, record: RunRecord, folder: RunFolder, settings: HoldSettings) -> None:
    """Draws what the report of a run shows; pictures that are there already stay."""
    with Studio(task) as studio:
        for place, grasp in enumerate(record.grasps):
            configuration = to_configuration(grasp, task, folder.record_path)
            front = view_path(folder.media, grasp.id, VIEW_NAMES[0])
            if place == 0:
                approach = to_approach(grasp.approach, task.hand) if grasp.approach else None
                _draw_best(studio, configuration, folder.media, grasp.id, settings, approach)
            elif not front.exists():
                width, height = _THUMBNAIL
                _write(front, studio.view(configuration, VIEW_NAMES[0], width=width, height=height))


def draw_grasp(
    configuration: Configuration, folder: Path, identifier: str, settings: HoldSettings
) -> list[Path]:
    """Draws a grasp from four sides and, where a squeeze is found, its hold test; gives the paths."""
    with Studio(configuration.task) as studio:
        return _draw_best(studio, configuration, folder, identifier, settings)


def _draw_best(
    studio: Studio,
    configuration: Configuration,
    folder: Path,
    identifier: str,
    settings: HoldSettings,
    known_approach: Approach | None = None,
) -> list[Path]:
    paths = [view_path(folder, identifier, view) for view in VIEW_NAMES]
    width, height = _VIEW
    for path, view in zip(paths, studio.views(configuration, width=width, height=height), strict=True):
        _write(path, view)
    squeeze = plan_squeeze(configuration, settings=settings)
    if not isinstance(squeeze, NotHoldable):
        grasp = Grasp(configuration, squeeze, known_approach)
        result = hold_test(grasp, settings=settings)
        width, height = _FRAME
        paths.append(film_path(folder, identifier))
        _write(paths[-1], _in_rows(studio.filmstrip(grasp, result, width=width, height=height)))
    return paths


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
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG")
    write_bytes(path, buffer.getvalue())
