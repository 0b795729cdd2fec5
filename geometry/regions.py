"""Contact regions: spherical caps, Bezier patches and points with a normal, on a hand link or an object."""

from dataclasses import dataclass
from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ..errors import InputError
from ..files import FileModel
from .bezier import BezierPatch
from .transforms import perpendicular

__all__ = ["Cap", "Patch", "PointRegion", "Region", "RegionSpec", "Vector3", "build_region"]

Array = NDArray[np.float64]
Vector3: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Cap:
    """A spherical cap: centre + radius m, for unit m within `half_angle_rad` of `axis`; m is the normal.

    Attributes:
        centre: (3,) in m.
        radius: in m.
        axis: unit vector (3,).
        half_angle_rad: in (0, pi].
    """

    centre: Array
    radius: float
    axis: Array
    half_angle_rad: float

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points and unit normals, each (count, 3), uniform over the cap's area."""
        cosine = rng.uniform(np.cos(self.half_angle_rad), 1.0, count)
        angle = rng.uniform(0.0, 2.0 * np.pi, count)
        e1, e2 = perpendicular(self.axis)
        sine = np.sqrt(1.0 - cosine**2)
        m = cosine[:, None] * self.axis + sine[:, None] * (
            np.cos(angle)[:, None] * e1 + np.sin(angle)[:, None] * e2
        )
        return self.centre + self.radius * m, m


@dataclass(frozen=True, eq=False)
class Patch:
    """A Bezier patch as a contact region."""

    patch: BezierPatch

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points and unit normals, each (count, 3), uniform in the parameters."""
        u, v = rng.uniform(size=(2, count))
        return self.patch.evaluate(u, v), self.patch.unit_normal(u, v)


@dataclass(frozen=True, eq=False)
class PointRegion:
    """A single point (3,) in m with its unit outward normal (3,)."""

    point: Array
    normal: Array

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """The point and its normal, `count` times."""
        del rng
        return np.tile(self.point, (count, 1)), np.tile(self.normal, (count, 1))


Region: TypeAlias = Cap | Patch | PointRegion


class CapSpec(FileModel):
    """`cap:` of a region in a file."""

    centre: Vector3
    radius: Annotated[float, Field(gt=0)]
    axis: Vector3
    half_angle_deg: Annotated[float, Field(gt=0, le=180)]


class RegionSpec(FileModel):
    """A region in a file: exactly one of `bezier`, `cap`, or `point` with `normal`."""

    bezier: list[list[Vector3]] | None = None
    cap: CapSpec | None = None
    point: Vector3 | None = None
    normal: Vector3 | None = None

    @model_validator(mode="after")
    def _one_kind(self) -> "RegionSpec":
        given = [name for name in ("bezier", "cap", "point") if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError("needs exactly one of bezier, cap, or point with normal")
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
        return Cap(np.array(spec.cap.centre), spec.cap.radius, axis, np.deg2rad(spec.cap.half_angle_deg))
    if spec.bezier is not None:
        return Patch(_build_patch(spec.bezier, source, f"{field}.bezier"))
    assert spec.point is not None and spec.normal is not None
    return PointRegion(np.array(spec.point), _unit(spec.normal, source, f"{field}.normal"))


def _build_patch(rows: list[list[Vector3]], source: str, field: str) -> BezierPatch:
    if len(rows) < 2 or any(len(row) < 2 for row in rows):
        raise InputError(source, field, "needs at least 2 x 2 control points")
    if len({len(row) for row in rows}) != 1:
        raise InputError(source, field, "every row must have the same number of control points")
    if len(rows) > 10 or len(rows[0]) > 10:
        raise InputError(source, field, "degrees up to 9 are accepted")
    patch = BezierPatch(np.array(rows))
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
