"""Link shapes as they stand in hand files."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, Strict, model_validator

from ..base.files.fields import Coordinate, Extent, RegionName, Vector3
from ..base.files.file_model import FileModel
from ..base.numeric.arrays import Array
from ..errors import InputError, UnknownName
from ..geometry import BezierPatch, Box, Capsule, Hull, Shape, Sphere, pose

__all__ = ["ShapeSpec", "build_shape"]

_RING_POINTS = 24
# Samples along each parameter of a patch that a hull takes in: on the SA hand's pads, whose surface bulges
# by at most 3 mm, the facets between them stay within 0.025 mm of the patch.
_PATCH_SAMPLES = 13


class SphereSpec(FileModel):
    """A ball in the link's frame."""

    centre: Vector3
    radius: Extent


class CapsuleSpec(FileModel):
    """A capsule in the link's frame."""

    start: Vector3
    end: Vector3
    radius: Extent


class BoxSpec(FileModel):
    """A box along the link's axes."""

    centre: Vector3
    half_extents: tuple[Extent, Extent, Extent]


class SectionSpec(FileModel):
    """A rounded cross-section of a hull: at `at` along `along`, a superellipse of exponent `roundness`."""

    at: Coordinate
    centre: tuple[Coordinate, Coordinate] = (0.0, 0.0)
    half: tuple[Extent, Extent]
    roundness: Annotated[float, Strict(), Field(ge=2, le=20)] = 2.0


class HullSpec(FileModel):
    """The convex hull of points, of cross-sections, and of the patches of named regions of the same link."""

    points: Annotated[list[Vector3], Field(max_length=10_000)] = []
    along: Literal["x", "y", "z"] = "x"
    sections: Annotated[list[SectionSpec], Field(max_length=200)] = []
    regions: Annotated[list[RegionName], Field(max_length=100)] = []


class ShapeSpec(FileModel):
    """One convex shape of a link."""

    sphere: SphereSpec | None = None
    capsule: CapsuleSpec | None = None
    box: BoxSpec | None = None
    hull: HullSpec | None = None

    @model_validator(mode="after")
    def _one_kind(self) -> "ShapeSpec":
        if sum(value is not None for value in (self.sphere, self.capsule, self.box, self.hull)) != 1:
            raise ValueError("needs exactly one of sphere, capsule, box or hull")
        return self


def build_shape(spec: ShapeSpec, patches: dict[str, BezierPatch], source: str, field: str) -> Shape:
    """Builds a shape from its description in a file.

    Args:
        spec: the description.
        patches: the Bezier regions of the same link, by name.
        source: the file, for error messages.
        field: where in it the description stands.

    Raises:
        InputError: a capsule of no length, a flat hull, an unknown region.
    """
    if spec.sphere is not None:
        return Sphere(np.array(spec.sphere.centre), spec.sphere.radius)
    if spec.capsule is not None:
        start, end = np.array(spec.capsule.start), np.array(spec.capsule.end)
        if np.linalg.norm(end - start) < 1e-6:
            raise InputError(source, f"{field}.capsule", "start and end must differ (or use a sphere)")
        return Capsule(start, end, spec.capsule.radius)
    if spec.box is not None:
        return Box(pose(np.eye(3), np.array(spec.box.centre)), np.array(spec.box.half_extents))
    assert spec.hull is not None
    return _build_hull(spec.hull, patches, source, f"{field}.hull")


def _build_hull(spec: HullSpec, patches: dict[str, BezierPatch], source: str, field: str) -> Hull:
    clouds = [np.array(spec.points).reshape(-1, 3)]
    clouds += [_section_points(section, spec.along) for section in spec.sections]
    u = np.linspace(0.0, 1.0, _PATCH_SAMPLES)
    for name in spec.regions:
        if name not in patches:
            raise UnknownName(source, f"{field}.regions", "bezier region of this link", name, patches)
        clouds.append(patches[name].evaluate(u[:, None], u[None, :]).reshape(-1, 3))
    points = np.concatenate(clouds)
    if len(points) < 4 or np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-6) < 3:
        raise InputError(source, field, "needs at least four points that are not all in one plane")
    return Hull.from_points(points)


def _section_points(section: SectionSpec, along: str) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, _RING_POINTS, endpoint=False)
    exponent = 2.0 / section.roundness
    ring = np.column_stack([np.sign(f) * np.abs(f) ** exponent for f in (np.cos(angle), np.sin(angle))])
    axis = "xyz".index(along)
    points = np.full((_RING_POINTS, 3), section.at)
    points[:, [i for i in range(3) if i != axis]] = ring * section.half + section.centre
    return points
