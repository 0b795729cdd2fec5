"""What the card of a grasp shows beside its record."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees
from pathlib import Path

import numpy as np
from markupsafe import Markup

from ...base.numeric.arrays import Array
from ...geometry import invert, pose, quaternion_from_rotation, rotation_from_quaternion
from ...mjcf import TestKind
from ...objects import Task
from ..records import GraspRecord
from .charts import Chart, slip_chart, turn_chart
from .embed import embed_picture
from .formats import fixed
from .pictures import VIEW_NAMES, film_path, video_path, view_path
from .text import leaning
from .why import fault, stage_word

__all__ = ["Card", "make_card"]

# Beyond it, a limit of slip is no run's own; the same of a rotation.
_LARGEST_LIMIT_M, _LARGEST_LIMIT_RAD = 10.0, 10.0
# A figure among the measures that is none: the page says it elsewhere, in words of the test.
_COUNT = "directions_held"


@dataclass(frozen=True)
class Card:
    """What the page shows of a grasp beside its record.

    Attributes:
        stage: how far it came, in a word or two.
        look: `good`, `narrow`, `uncertain`, `bad` or empty: chooses the colour of that.
        line: what stands beside it while the card is closed.
        fault: what went wrong; empty where nothing did.
        advice: what to try then.
        reason: the same in short, for the table.
        noise: how many of the trials with noise were passed, such as `1 of 5`.
        views: names and pictures of the sides.
        film: its filmstrip; None where it has none.
        video: the same, played; None where it has none.
        slip_chart: slip over time; None where it was not simulated.
        turn_chart: rotation over time, likewise.
        rated: by contact, the normal force in N that the link is rated for; None for a palm, which no joint
            moves, and where that is not known.
        over: by contact, whether the squeeze presses with more than that.
        joints: name, position and target of the squeeze (empty without one) by joint, with units.
        measures: name and value of the analytic measures.
        inverse: position and quaternion of the palm in the object's frame.
        files: names and links of its files.
    """

    stage: str
    look: str
    line: str
    fault: str
    advice: str
    reason: str
    noise: str
    views: list[tuple[str, Markup]]
    film: Markup | None
    video: Markup | None
    slip_chart: Chart | None
    turn_chart: Chart | None
    rated: list[float | None]
    over: list[bool]
    joints: list[tuple[str, str, str]]
    measures: list[tuple[str, float]]
    inverse: tuple[list[float], list[float]]
    files: list[tuple[str, str]]


def make_card(
    grasp: GraspRecord,
    task: Task,
    kind: TestKind,
    media: Path,
    page: Path,
    *,
    best: bool,
    enough: bool = False,
) -> Card:
    """The card of a grasp.

    Args:
        grasp: its record.
        task: of the run.
        kind: of its test.
        media: folder of the run's pictures, beside which `grasps` lies.
        page: where the page will be, from which links count.
        best: whether it is the best of the run, of which there are more pictures.
        enough: whether the run has ended as enough grasps hold.
    """
    hold = grasp.hold
    what, advice = fault(grasp, enough=enough)
    views = [(name, embed_picture(view_path(media, grasp.id, name))) for name in VIEW_NAMES]
    stage = stage_word(grasp, kind)
    directions = [] if hold is None else hold.directions
    film = embed_picture(film_path(media, grasp.id)) if best and directions else None
    slip_limit = _limit(grasp, "slip_limit_m", _LARGEST_LIMIT_M)
    turn_limit = _limit(grasp, "rotation_limit_rad", _LARGEST_LIMIT_RAD)
    rated, planned = _rated(grasp, task), hold.squeeze.normal_forces if hold and hold.squeeze else []
    return Card(
        stage=stage,
        look=_look(grasp),
        line=_line(grasp, kind),
        fault=what,
        advice=advice,
        reason=_reason(grasp, what),
        noise=_noise(grasp),
        views=[
            (name, picture)
            for name, picture in views
            if picture is not None and (best or name == VIEW_NAMES[0])
        ],
        film=film,
        video=embed_picture(video_path(media, grasp.id)) if best and directions else None,
        slip_chart=None if slip_limit is None else slip_chart(directions, slip_limit),
        turn_chart=None
        if kind == "press"
        else turn_chart(directions, turn_limit if kind == "lift" else None),
        rated=rated,
        over=[limit is not None and planned[i : i + 1] > [limit] for i, limit in enumerate(rated)],
        joints=_joints(grasp, task),
        measures=[(name.replace("_", " "), value) for name, value in grasp.quality.items() if name != _COUNT],
        inverse=_inverse(grasp),
        files=_files(grasp, media, page),
    )


def _look(grasp: GraspRecord) -> str:
    if grasp.is_good:
        return "narrow" if grasp.is_narrow else "good"
    if grasp.is_held:
        return "uncertain"
    is_blocked = grasp.clearance is not None and not grasp.is_clear
    return "bad" if is_blocked or (grasp.hold is not None and grasp.hold.directions) else ""


def _line(grasp: GraspRecord, kind: TestKind) -> str:
    hold, figures = grasp.hold, []
    if hold is not None and hold.directions and kind == "lift":
        figures.append(f"{hold.held_count} of {len(hold.directions)} directions")
    if hold is not None and hold.slip is not None:
        figures.append(f"slip {1e3 * hold.slip:.2f} mm")
    if hold is not None and hold.margin is not None:
        figures.append(f"margin {hold.margin:.2f}")
    return ", ".join(figures)


def _reason(grasp: GraspRecord, what: str) -> str:
    """A line for the table: what went wrong, or what it leans on."""
    leans = [] if grasp.hold is None else leaning(grasp.hold)
    if grasp.is_good:
        return "; ".join(leans)
    return "; ".join([*([what] if what else []), *leans])


def _noise(grasp: GraspRecord) -> str:
    hold = grasp.hold
    if hold is None or hold.probability is None:
        return ""
    return f"{round(hold.probability * hold.trials)} of {hold.trials}"


def _limit(grasp: GraspRecord, name: str, largest: float) -> float | None:
    limit = grasp.hold.settings.get(name) if grasp.hold else None
    return limit if isinstance(limit, float) and 0.0 < limit < largest else None


def _rated(grasp: GraspRecord, task: Task) -> list[float | None]:
    """By contact, what the link is rated for: a fingertip's force says nothing of a palm."""
    squeeze = None if grasp.hold is None else grasp.hold.squeeze
    if squeeze is None:
        return []
    moves = task.hand.tree.moves
    return [squeeze.rated_force if moves[contact.hand.link].any() else None for contact in task.contacts]


def _joints(grasp: GraspRecord, task: Task) -> list[tuple[str, str, str]]:
    sliding = {axis.name for link in task.hand.links for axis in link.axes if axis.kind == "prismatic"}
    squeeze = None if grasp.hold is None else grasp.hold.squeeze
    targets: Mapping[str, float] = {} if squeeze is None else squeeze.targets

    def written(name: str, value: float) -> str:
        return f"{fixed(1e3 * value, 2)} mm" if name in sliding else f"{fixed(degrees(value), 1)}°"

    return [
        (
            name.replace("_", " "),
            written(name, value),
            written(name, targets[name]) if name in targets else "",
        )
        for name, value in grasp.joints.items()
    ]


def _inverse(grasp: GraspRecord) -> tuple[list[float], list[float]]:
    R = rotation_from_quaternion(np.array(grasp.object.quaternion))
    T: Array = invert(pose(R, np.array(grasp.object.position)))
    position: list[float] = T[:3, 3].tolist()
    quaternion: list[float] = quaternion_from_rotation(T[:3, :3]).tolist()
    return position, quaternion


def _files(grasp: GraspRecord, media: Path, page: Path) -> list[tuple[str, str]]:
    """Links to the grasp's own files, where they lie beside the pictures."""
    found = []
    for suffix in (".json", ".xml"):
        path = media.parent / "grasps" / f"{grasp.id}{suffix}"
        if path.is_file():
            found.append((path.name, Path(os.path.relpath(path, page.parent)).as_posix()))
    return found
