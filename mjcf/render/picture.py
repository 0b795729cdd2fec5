"""Pictures of diagrams: each from the sides that show most of its regions, or from one that is named."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import radians, tan
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array, Picture
from ...errors import InputError, UnknownName
from ...geometry import Region
from .camera import Camera, look_at
from .diagram import Diagram
from .diagram_model import diagram_model
from .labels import Callout, colour_of, with_axes, with_callouts, with_scale_bar, with_title
from .rays import seen_from
from .region_mesh import region_sheet
from .renderer import open_renderer
from .views import drawn_corners

__all__ = ["SIDES", "draw_diagrams", "parse_view"]

SIDES = {
    "front": (180.0, 0.0),
    "left": (270.0, 0.0),
    "back": (0.0, 0.0),
    "right": (90.0, 0.0),
    "top": (180.0, -89.9),
    "bottom": (180.0, 89.9),
    "iso": (215.0, -30.0),
}
"""Azimuth and elevation in degrees of views by name; the front is what faces +x, the top what faces +z."""

View = tuple[float, float]

# A narrow angle is nearly a parallel projection: the scale bar then holds for all depths.
_FOVY_DEG = 8.0
_PANEL = (900, 700)
_COLUMN_PX = 190
_AXES_PX = 46.0
# Where a view is chosen, from so many sides.
_AZIMUTHS_DEG = tuple(np.arange(35.0, 395.0, 45.0))
_ELEVATIONS_DEG = (-25.0, 25.0, -55.0)
# Places of a region that are looked for, and the share of them from which on a region is in sight.
_SAMPLED = 24
_IN_SIGHT = 0.15
# How far above a region it is looked for, in sizes of what is drawn; above its sheet.
_ABOVE = 0.003


def parse_view(text: str) -> View:
    """Azimuth and elevation in degrees from a name in `SIDES` or from `AZIMUTH,ELEVATION`.

    Raises:
        InputError: neither.
    """
    if text in SIDES:
        return SIDES[text]
    azimuth, comma, elevation = text.partition(",")
    if not comma:
        raise UnknownName("show", "--view", "view", text, (*SIDES, "AZIMUTH,ELEVATION"))
    try:
        view = float(azimuth), float(elevation)
    except ValueError:
        view = np.nan, np.nan
    if not (abs(view[0]) <= 360.0 and abs(view[1]) <= 90.0):
        raise InputError(
            "show",
            "--view",
            f"must be one of {', '.join(SIDES)} or AZIMUTH,ELEVATION in degrees, not {text!r}",
        )
    return view[0], float(np.clip(view[1], -89.9, 89.9))


def draw_diagrams(diagrams: Sequence[Diagram], view: View | None = None) -> Picture:
    """One picture (height, width, 3) of diagrams side by side.

    Args:
        diagrams: what is drawn; a single one is drawn from two sides unless a view is given.
        view: azimuth and elevation in degrees; by default the sides that show most regions.

    Raises:
        InputError: a name that a model can't carry.
        MissingBackend: the OpenGL backend that is named can't draw.
    """
    panels = 2 if len(diagrams) == 1 else 1
    return np.concatenate([_draw(diagram, view, panels) for diagram in diagrams], axis=1)


@dataclass(frozen=True, eq=False)
class _Sighting:
    """A region as a camera has it.

    Attributes:
        pixel: (2,) where to point at.
        share: of its places that are seen.
        clearness: the share, less where the region is seen from its side, 0 from behind.
    """

    pixel: Array
    share: float
    clearness: float


@dataclass(frozen=True, eq=False)
class _Places:
    """Where a region is looked for: points (n, 3) just above it, the middle first, and its normal there."""

    points: Array
    normal: Array


def _draw(diagram: Diagram, view: View | None, panels: int) -> Picture:
    model, data, size = diagram_model(diagram)
    points = np.concatenate(list(drawn_corners(model, data).values()))
    places = [_places(mark.region, size) for mark in diagram.marks]
    cameras = [_camera(points, view)] if view else _choose(model, data, points, places, panels)
    seen = [_sightings(model, data, places, camera) for camera in cameras]
    best = np.array([[s.share for s in row] for row in seen]).reshape(len(cameras), -1).max(axis=0)
    pictures = []
    with open_renderer(model) as draw:
        for k, camera in enumerate(cameras):
            # What no picture shows is named in the last one, as hidden.
            callouts = [
                Callout(mark.label, s.pixel, colour_of(mark.colour), hidden=s.share < _IN_SIGHT)
                for mark, s, most in zip(diagram.marks, seen[k], best, strict=True)
                if s.share >= _IN_SIGHT or (most < _IN_SIGHT and k == len(cameras) - 1)
            ]
            picture = with_callouts(draw(data, camera, *_PANEL), callouts, _COLUMN_PX)
            picture = _with_axes(picture, camera, diagram.frame, size)
            picture = with_scale_bar(picture, _metres_per_px(camera))
            side = f"azimuth {camera.azimuth_deg % 360.0:.0f}°, elevation {camera.elevation_deg:.0f}°"
            pictures.append(with_title(picture, f"{diagram.title}   ({side})"))
    return np.concatenate(pictures, axis=1)


def _camera(points: Array, view: View) -> Camera:
    """A camera that keeps what it shows out of the columns for names, title and scale bar."""
    width, height = _PANEL
    margin = 1.14
    aspect = margin * (width - 2 * _COLUMN_PX) / height
    return look_at(points, *view, aspect, margin=margin, fovy_deg=_FOVY_DEG)


def _choose(model: Any, data: Any, points: Array, places: list[_Places], count: int) -> list[Camera]:
    """The cameras that together have most of the regions in sight; without regions, opposite ones."""
    iso = SIDES["iso"]
    if not places:
        return [_camera(points, iso), _camera(points, (iso[0] + 180.0, -iso[1]))][:count]
    cameras = [_camera(points, (a, e)) for e, a in product(_ELEVATIONS_DEG, _AZIMUTHS_DEG)]
    shares = np.array([[s.clearness for s in _sightings(model, data, places, camera)] for camera in cameras])
    chosen: list[int] = []
    for _ in range(count):
        had = shares[chosen].max(axis=0, initial=0.0)
        # First how many are in sight, then how well.
        together = np.maximum(shares, had)
        score = (together >= _IN_SIGHT).sum(axis=1) + together.mean(axis=1)
        # The side across from what is shown already is worth more than its neighbour.
        far = [
            min((cameras[i].axes[2] @ -cameras[k].axes[2] for k in chosen), default=0.0)
            for i in range(len(cameras))
        ]
        chosen.append(int(np.argmax(score + 0.2 * np.array(far))))
    return [cameras[i] for i in chosen]


def _places(region: Region, size: float) -> _Places:
    middle, normal = region.middle()
    sheet = region_sheet(region, _ABOVE * size)
    outer = sheet.vertices[: len(sheet.vertices) // 2]
    chosen = outer[np.linspace(0, len(outer) - 1, _SAMPLED).round().astype(int)]
    return _Places(np.vstack([middle + _ABOVE * size * normal, chosen]), normal)


def _sightings(model: Any, data: Any, places: list[_Places], camera: Camera) -> list[_Sighting]:
    if not places:
        return []
    seen = seen_from(model, data, camera.eye, np.concatenate([own.points for own in places]))
    found, start = [], 0
    for own in places:
        pixels = camera.project(own.points, *_PANEL)
        visible = seen[start : start + len(own.points)]
        start += len(own.points)
        # The middle where it is in sight, else the place in sight that is nearest to it.
        away = np.linalg.norm(pixels - pixels[0], axis=1) + np.where(visible, 0.0, 1e6)
        share = float(visible.mean())
        facing = float(np.clip(-2.0 * camera.axes[2] @ own.normal, 0.0, 1.0))
        found.append(_Sighting(pixels[int(np.argmin(away))], share, share * facing))
    return found


def _with_axes(picture: Picture, camera: Camera, frame: str, size: float) -> Picture:
    """Axes at the origin where that is between the columns of names, else in the corner at the lower left."""
    width, height = _PANEL
    metres = _AXES_PX * _metres_per_px(camera)
    origin, *ends = camera.project(np.vstack([np.zeros(3), metres * np.eye(3)]), width, height)
    inside = _COLUMN_PX < origin[0] < width - _COLUMN_PX and 0.1 * height < origin[1] < 0.9 * height
    if not inside:
        corner = np.array([_COLUMN_PX + _AXES_PX, height - 2.0 * _AXES_PX])
        ends = [corner + _AXES_PX * np.array([camera.axes[0] @ e, -camera.axes[1] @ e]) for e in np.eye(3)]
        origin = corner
    return with_axes(picture, origin, np.array(ends), frame, is_at_origin=bool(inside))


def _metres_per_px(camera: Camera) -> float:
    """Metres per pixel in the plane through the camera's target."""
    return 2.0 * camera.distance * tan(radians(0.5 * camera.fovy_deg)) / _PANEL[1]
