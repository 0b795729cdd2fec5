"""The pictures of a run: four views and a filmstrip of the best grasp, one view of every other."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...arrays import Picture
from ...grasping import Refusal, Trial, squeeze_grasp, try_hold
from ...mjcf import HoldSettings
from ...mjcf.render import Studio, write_png
from ...objects import Task
from ...retraction import Approach
from ...solver import Configuration
from ..records import GraspRecord, RunFolder, RunRecord, to_approach, to_configuration

__all__ = ["VIEW_NAMES", "Drawn", "draw_grasp", "draw_grasps", "film_path", "view_path"]

VIEW_NAMES = ("front", "left", "back", "right")
"""The four sides from which a grasp is drawn; the first is the thumbnail's."""

_VIEW = (640, 480)
_THUMBNAIL = (320, 240)
# A filmstrip has a frame for the pregrasp, the squeeze and each direction: too many for one row of a page.
_FRAME = (320, 300)
_FRAMES_A_ROW = 4


@dataclass(frozen=True, eq=False)
class Drawn:
    """What pictures of a grasp show.

    Attributes:
        configuration: where hand and object are.
        trial: the test that a filmstrip shows; None for no filmstrip.
    """

    configuration: Configuration
    trial: Trial | None = None


def view_path(folder: Path, identifier: str, view: str) -> Path:
    """Path of the picture of a grasp from one side."""
    return folder / f"{identifier}_{view}.png"


def film_path(folder: Path, identifier: str) -> Path:
    """Path of the filmstrip of a grasp's hold test."""
    return folder / f"{identifier}_hold.png"


def draw_grasps(
    task: Task,
    record: RunRecord,
    folder: RunFolder,
    settings: HoldSettings,
    known: Mapping[str, Drawn] | None = None,
) -> None:
    """Draws what the report of a run shows; pictures that are there already stay.

    Args:
        task: of the run.
        record: of the run.
        folder: of the run.
        settings: of its hold test.
        known: by id, what is to be drawn of grasps that were just made; of others that is read from their
            records, and the best grasp's test is simulated again.
    """
    known = known or {}
    with Studio(task) as studio:
        for place, grasp in enumerate(record.grasps):
            front = view_path(folder.media, grasp.id, VIEW_NAMES[0])
            if place == 0:
                drawn = known.get(grasp.id) or _from_record(grasp, task, folder.record_path, settings)
                _draw_in_full(studio, drawn, folder.media, grasp.id)
            elif not front.exists():
                width, height = _THUMBNAIL
                configuration = (
                    known[grasp.id].configuration
                    if grasp.id in known
                    else to_configuration(grasp, task, folder.record_path)
                )
                write_png(front, studio.view(configuration, VIEW_NAMES[0], width=width, height=height))


def draw_grasp(
    configuration: Configuration, folder: Path, identifier: str, settings: HoldSettings
) -> list[Path]:
    """Draws a grasp from four sides and, where a squeeze is found, its hold test; gives the paths."""
    with Studio(configuration.task) as studio:
        return _draw_in_full(studio, _simulated(configuration, settings), folder, identifier)


def _from_record(grasp: GraspRecord, task: Task, source: Path, settings: HoldSettings) -> Drawn:
    configuration = to_configuration(grasp, task, source)
    if grasp.hold is None or grasp.is_untested:
        return Drawn(configuration)
    approach = to_approach(grasp.approach, task.hand) if grasp.approach else None
    return _simulated(configuration, settings, approach)


def _simulated(
    configuration: Configuration, settings: HoldSettings, approach: Approach | None = None
) -> Drawn:
    grasp = squeeze_grasp(configuration, settings=settings, approach=approach)
    return Drawn(configuration, None if isinstance(grasp, Refusal) else try_hold(grasp, settings=settings))


def _draw_in_full(studio: Studio, drawn: Drawn, folder: Path, identifier: str) -> list[Path]:
    paths = [view_path(folder, identifier, view) for view in VIEW_NAMES]
    width, height = _VIEW
    for path, view in zip(paths, studio.views(drawn.configuration, width=width, height=height), strict=True):
        write_png(path, view)
    if drawn.trial is not None:
        width, height = _FRAME
        strip = studio.filmstrip(drawn.trial.grasp.grasp, drawn.trial.result, width=width, height=height)
        paths.append(film_path(folder, identifier))
        write_png(paths[-1], _in_rows(strip))
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
