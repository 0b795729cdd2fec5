"""The pictures of a run: four views and a filmstrip of the best grasp, one view of every other.

A run without grasps has a picture of what was asked for.
"""

import io
import warnings
from collections.abc import Generator, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from ...base.files.input_file import read_input
from ...base.numeric.arrays import Picture
from ...errors import InputError
from ...grasping import Refusal, Trial, squeeze_grasp, try_hold
from ...mjcf import HoldSettings
from ...mjcf.hand_folder import open_posture
from ...mjcf.render import Studio, draw_diagrams, task_diagrams, write_png, write_video
from ...objects import Task
from ...retraction import Approach
from ...solver import Configuration
from ..records import GraspRecord, RunFolder, RunRecord, to_approach, to_configuration

__all__ = [
    "VIEW_NAMES",
    "Drawn",
    "draw_first",
    "draw_grasp",
    "draw_grasps",
    "film_path",
    "missing_pictures",
    "picture_bytes",
    "task_path",
    "video_path",
    "view_path",
]

VIEW_NAMES = ("front", "left", "back", "right")
"""The four sides from which a grasp is drawn; the first is the thumbnail's."""

_VIEW = (640, 480)
_THUMBNAIL = (320, 240)
# A filmstrip has a frame for the pregrasp, the squeeze and each direction: too many for one row of a page.
_FRAME = (320, 300)
_FRAMES_A_ROW = 4
_VIDEO = (256, 240)
_LARGEST_BYTES = 32 * 1024 * 1024
_MOST_PIXELS = 16_000_000


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


def video_path(folder: Path, identifier: str) -> Path:
    """Path of the video of a grasp's hold test."""
    return folder / f"{identifier}_hold.webp"


def task_path(folder: Path) -> Path:
    """Path of the picture of what a task asks for, which runs without grasps have."""
    return folder / "task.png"


def draw_grasps(
    studio: Studio,
    record: RunRecord,
    folder: RunFolder,
    settings: HoldSettings,
    known: Mapping[str, Drawn] | None = None,
) -> Generator[bool, None, None]:
    """Draws what the report of a run shows, one by one as asked for; pictures that are there already stay.

    Args:
        studio: of the run's task, which stays open.
        record: of the run.
        folder: of the run.
        settings: of its hold test.
        known: by id, what is to be drawn of grasps that were just made; of others that is read from their
            records, and the best grasp's test is simulated again.

    Yields:
        After each picture, and each that is there already, whether it is the last one of its grasp.
    """
    known, task = known or {}, studio.task
    if not record.grasps and picture_bytes(task_path(folder.media)) is None:
        write_png(task_path(folder.media), draw_diagrams(task_diagrams(task, open_posture(task.hand))))
    for place, grasp in enumerate(record.grasps):
        if place == 0:
            drawn = known.get(grasp.id) or _from_record(grasp, task, folder.record_path, settings)
            for _ in _draw_in_full(studio, drawn, folder.media, grasp.id):
                yield False
        elif grasp.id in known or picture_bytes(view_path(folder.media, grasp.id, VIEW_NAMES[0])) is None:
            _draw_front(studio, grasp, folder, known, _THUMBNAIL)
        yield True


def draw_first(studio: Studio, record: RunRecord, folder: RunFolder, known: Mapping[str, Drawn]) -> None:
    """Draws the first grasp of a run from one side, which shows why a run was given up; see `draw_grasps`."""
    if record.grasps:
        _draw_front(studio, record.grasps[0], folder, known, _VIEW)


def _draw_front(
    studio: Studio, grasp: GraspRecord, folder: RunFolder, known: Mapping[str, Drawn], size: tuple[int, int]
) -> None:
    """Draws a grasp from the front, as wide and as high as `size` says."""
    drawn = known.get(grasp.id)
    configuration = drawn.configuration if drawn else to_configuration(grasp, studio.task, folder.record_path)
    picture = studio.view(configuration, VIEW_NAMES[0], width=size[0], height=size[1])
    write_png(view_path(folder.media, grasp.id, VIEW_NAMES[0]), picture)


def missing_pictures(record: RunRecord, folder: RunFolder) -> list[Path]:
    """Pictures that a whole run has and this folder lacks; of the best grasp those from all sides."""
    wanted = [view_path(folder.media, grasp.id, VIEW_NAMES[0]) for grasp in record.grasps]
    if not record.grasps:
        wanted.append(task_path(folder.media))
    else:
        best = record.grasps[0]
        wanted += [view_path(folder.media, best.id, view) for view in VIEW_NAMES[1:]]
        if best.hold is not None and best.hold.squeeze is not None:
            wanted += [film_path(folder.media, best.id), video_path(folder.media, best.id)]
    return [path for path in wanted if picture_bytes(path) is None]


def draw_grasp(
    configuration: Configuration, folder: Path, identifier: str, settings: HoldSettings
) -> list[Path]:
    """Draws a grasp from four sides and, where a squeeze is found, its hold test; gives the paths."""
    with Studio(configuration.task) as studio:
        drawn = _draw_in_full(studio, _simulated(configuration, settings), folder, identifier)
        return list(dict.fromkeys(drawn))


def _from_record(grasp: GraspRecord, task: Task, source: Path, settings: HoldSettings) -> Drawn:
    configuration = to_configuration(grasp, task, source)
    if grasp.hold is None or grasp.is_untested:
        return Drawn(configuration)
    approach = to_approach(grasp.approach, task.hand, source) if grasp.approach else None
    return _simulated(configuration, settings, approach)


def _simulated(
    configuration: Configuration, settings: HoldSettings, approach: Approach | None = None
) -> Drawn:
    grasp = squeeze_grasp(configuration, settings=settings, approach=approach)
    return Drawn(configuration, None if isinstance(grasp, Refusal) else try_hold(grasp, settings=settings))


def _draw_in_full(studio: Studio, drawn: Drawn, folder: Path, identifier: str) -> Iterator[Path]:
    """All pictures of a grasp; yields the path of each file after each picture that goes into it."""
    for view in VIEW_NAMES:
        path, (width, height) = view_path(folder, identifier, view), _VIEW
        write_png(path, studio.view(drawn.configuration, view, width=width, height=height))
        yield path
    if drawn.trial is None:
        return
    grasp, result = drawn.trial.grasp.grasp, drawn.trial.result
    path, (width, height) = film_path(folder, identifier), _FRAME
    frames = []
    for frame in studio.filmstrip(grasp, result, width=width, height=height):
        frames.append(frame)
        yield path
    write_png(path, _in_rows(frames))
    path, (width, height) = video_path(folder, identifier), _VIDEO
    frames = []
    for frame in studio.video(grasp, result, width=width, height=height):
        frames.append(frame)
        yield path
    write_video(path, frames)


def _in_rows(frames: list[Picture]) -> Picture:
    """The frames of a strip in rows, the last one filled up."""
    blank = np.full_like(frames[0], 255)
    blank[..., 3:] = 0
    frames = [*frames, *[blank] * (-len(frames) % _FRAMES_A_ROW)]
    rows = [
        np.concatenate(frames[start : start + _FRAMES_A_ROW], axis=1)
        for start in range(0, len(frames), _FRAMES_A_ROW)
    ]
    return np.concatenate(rows, axis=0)


def picture_bytes(path: Path) -> bytes | None:
    """A picture file as `draw_grasps` leaves it; None where there is none, or something else in its place.

    A link is something else: it could bring a file from anywhere into a page that is passed on.
    """
    if path.parent.is_symlink():
        return None
    try:
        data = read_input(path, _LARGEST_BYTES, links=False)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of many pixels, which are looked at here
            with Image.open(io.BytesIO(data), formats=("PNG", "WEBP")) as image:
                frames = getattr(image, "n_frames", 1)
                if image.width * image.height * frames > _MOST_PIXELS:
                    return None
                image.load()
    except (InputError, OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    return data
