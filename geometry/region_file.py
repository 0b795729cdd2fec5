"""Contact regions as they stand in files."""

from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, Strict, model_validator

from ..base.files.fields import Extent, Vector3
from ..base.files.file_model import FileModel
from ..base.numeric.arrays import Array
from ..errors import InputError
from .bezier import BezierPatch
from .regions import Cap, Patch, PointRegion, Region

__all__ = ["RegionSpec", "build_patch", "build_region", "check_regular", "region_fields"]

_HIGHEST_DEGREE = 9
_SMALLEST_PATCH_M = 1e-4


class CapSpec(FileModel):
    """`cap:` of a region in a file."""

    centre: Vector3
    radius: Extent
    axis: Vector3
    half_angle_deg: Annotated[float, Strict(), Field(gt=0, le=180)]


class RegionSpec(FileModel):
    """A region in a file: exactly one of `bezier`, `cap`, or `point` with `normal`.

    `off_surface: true` is for one that is meant to lie off its body's surface, or to face inwards there.
    """

    KINDS: ClassVar[tuple[str, ...]] = ("bezier", "cap", "point")

    bezier: list[list[Vector3]] | None = None
    cap: CapSpec | None = None
    point: Vector3 | None = None
    normal: Vector3 | None = None
    off_surface: Annotated[bool, Strict()] = False

    @model_validator(mode="after")
    def _one_kind(self) -> "RegionSpec":
        given = [name for name in self.KINDS if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"needs exactly one of {', '.join(self.KINDS[:-1])}, or point with normal")
        if (self.point is None) != (self.normal is None):
            raise ValueError("a point needs a normal, and a normal a point")
        return self


def build_region(spec: RegionSpec, source: str, field: str) -> Region:
    """Builds a region from its description in a file.

    Raises:
        InputError: ragged or too small nets, a vanishing normal, a zero axis.
    """
    if spec.cap is not None:
        axis = _unit(spec.cap.axis, source, f"{field}.cap.axis")
        half_angle_rad = np.deg2rad(spec.cap.half_angle_deg)
        return Cap(np.array(spec.cap.centre), spec.cap.radius, axis, half_angle_rad, spec.off_surface)
    if spec.bezier is not None:
        where = f"{field}.bezier"
        return Patch(check_regular(build_patch(spec.bezier, source, where), source, where), spec.off_surface)
    assert spec.point is not None and spec.normal is not None
    normal = _unit(spec.normal, source, f"{field}.normal")
    return PointRegion(np.array(spec.point), normal, spec.off_surface)


def region_fields(region: Region) -> dict[str, Any]:
    """The region as `build_region` takes it from a file: plain numbers by the names of fields."""
    meant = {"off_surface": True} if region.off_surface else {}
    match region:
        case Patch():
            return {"bezier": region.patch.control_points.tolist(), **meant}
        case Cap():
            return {
                "cap": {
                    "centre": region.centre.tolist(),
                    "radius": region.radius,
                    "axis": region.axis.tolist(),
                    "half_angle_deg": float(np.rad2deg(region.half_angle_rad)),
                },
                **meant,
            }
        case PointRegion():
            return {"point": region.point.tolist(), "normal": region.normal.tolist(), **meant}


def build_patch(rows: list[list[Vector3]], source: str, field: str) -> BezierPatch:
    """Builds a patch from its control points, whose normal may vanish at most at a pole.

    Raises:
        InputError: ragged, too small or too large nets.
    """
    if len(rows) < 2 or any(len(row) < 2 for row in rows):
        raise InputError(source, field, "needs at least 2 x 2 control points")
    if len({len(row) for row in rows}) != 1:
        raise InputError(source, field, "every row must have the same number of control points")
    if max(len(rows), len(rows[0])) > _HIGHEST_DEGREE + 1:
        raise InputError(source, field, f"degrees up to {_HIGHEST_DEGREE} are accepted")
    points = np.array(rows)
    if np.ptp(points, axis=(0, 1)).max() < _SMALLEST_PATCH_M:
        raise InputError(
            source, field, f"must be larger than {_SMALLEST_PATCH_M:g} m (lengths are in metres)"
        )
    return BezierPatch(points)


def check_regular(patch: BezierPatch, source: str, field: str) -> BezierPatch:
    """The patch itself, once its normal is known to vanish nowhere, as a contact region needs.

    Raises:
        InputError: the normal vanishes, or may.
    """
    if patch.normal_may_vanish():
        raise InputError(
            source, field, "the normal p_u x p_v vanishes (or may) on the patch: it must not be degenerate"
        )
    return patch


def _unit(v: Vector3, source: str, field: str) -> Array:
    length = float(np.linalg.norm(v))
    if length < 1e-9:
        raise InputError(source, field, "must not be the zero vector")
    return np.array(v) / length
