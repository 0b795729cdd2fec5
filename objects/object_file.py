"""Object files (YAML): their fields, and how an object is built from them."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import trimesh
from numpy.typing import NDArray
from pydantic import Field, Strict, model_validator

from ..errors import InputError
from ..fields import Extent, Inertia3, Mass, Name, RegionName, Text, Vector3
from ..files import FileModel, parse, read_yaml, resolve_beside
from ..geometry import (
    Box,
    Capsule,
    MassProperties,
    Patch,
    Region,
    RegionSpec,
    Sphere,
    build_region,
    shape_mesh,
)
from .decompose import convex_pieces
from .generators import GENERATORS
from .mesh_file import read_mesh
from .object_model import ObjectModel, Part

__all__ = ["read_object"]

Array = NDArray[np.float64]
# A hand of human size holds nothing beyond these; a wrong unit does.
_SMALLEST_M, _LARGEST_M = 1e-3, 5.0


class BoxSpec(FileModel):
    """A box along the object's axes, centred at its origin."""

    half_extents: tuple[Extent, Extent, Extent]


class CylinderSpec(FileModel):
    """A cylinder along the object's z axis, centred at its origin."""

    radius: Extent
    length: Extent


class SphereSpec(FileModel):
    """A ball centred at the object's origin."""

    radius: Extent


class CapsuleSpec(FileModel):
    """A capsule along the object's z axis, centred at its origin; `length` is that of its straight part."""

    radius: Extent
    length: Extent


class ObjectFile(FileModel):
    """An object file."""

    name: Name
    description: Text = ""
    mesh: str | None = None
    box: BoxSpec | None = None
    cylinder: CylinderSpec | None = None
    sphere: SphereSpec | None = None
    capsule: CapsuleSpec | None = None
    generator: Literal["scalpel"] | None = None
    mass: Mass | None = None
    centre: Vector3 | None = None
    inertia: Inertia3 | None = None
    friction: Annotated[float, Strict(), Field(gt=0, le=10)]
    regions: Annotated[dict[RegionName, RegionSpec], Field(max_length=1000)] = {}
    sources: dict[str, Text] = {}

    @model_validator(mode="after")
    def _one_shape(self) -> "ObjectFile":
        kinds = ("mesh", "box", "cylinder", "sphere", "capsule", "generator")
        if sum(getattr(self, kind) is not None for kind in kinds) != 1:
            raise ValueError(f"needs exactly one of {', '.join(kinds)}")
        if self.mass is None and self.generator is None:
            raise ValueError("mass is required (in kg)")
        if self.inertia is not None and self.centre is None:
            raise ValueError("inertia needs centre, the centre of mass that it is about")
        return self


def read_object(path: Path) -> ObjectModel:
    """Reads an object file.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    spec = parse(ObjectFile, read_yaml(path), path)
    source = str(path)
    parts = _build_parts(spec, path)
    inertia = _build_inertia(spec, parts, source)
    regions = {name: build_region(region, source, f"regions.{name}") for name, region in spec.regions.items()}
    bounds = np.array([part.mesh.bounds for part, _ in parts])
    for name, region in regions.items():
        _check_near(region, bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0), source, f"regions.{name}")
    return ObjectModel(
        spec.name,
        tuple(part for part, _ in parts),
        inertia,
        spec.friction,
        regions,
        dict(spec.sources),
        spec.description,
    )


def _build_parts(spec: ObjectFile, path: Path) -> list[tuple[Part, float]]:
    """Parts with densities in kg/m^3, 1 where only the total mass is known."""
    if spec.generator is not None:
        return GENERATORS[spec.generator]()
    mesh = _primitive(spec) if spec.mesh is None else _mesh(spec.mesh, path)
    size = float(np.linalg.norm(mesh.extents))
    if not _SMALLEST_M <= size <= _LARGEST_M:
        hint = " (are these millimetres?)" if size > _LARGEST_M else ""
        raise InputError(
            path,
            "mesh" if spec.mesh else "",
            f"the object is {size:.3g} m across, outside [{_SMALLEST_M:g}, {_LARGEST_M:g}] m{hint}",
        )
    return [(Part(spec.name, mesh, convex_pieces(mesh)), 1.0)]


def _mesh(name: str, path: Path) -> trimesh.Trimesh:
    return read_mesh(resolve_beside(path, name, "mesh"), str(path), "mesh")


def _primitive(spec: ObjectFile) -> trimesh.Trimesh:
    if spec.box is not None:
        return shape_mesh(Box(np.eye(4), np.array(spec.box.half_extents)))
    if spec.cylinder is not None:
        return trimesh.creation.cylinder(spec.cylinder.radius, spec.cylinder.length, sections=48)
    if spec.sphere is not None:
        return shape_mesh(Sphere(np.zeros(3), spec.sphere.radius))
    assert spec.capsule is not None
    end = np.array([0.0, 0.0, 0.5 * spec.capsule.length])
    return shape_mesh(Capsule(-end, end, spec.capsule.radius))


def _check_near(region: Region, lower: Array, upper: Array, source: str, field: str) -> None:
    """A region farther from the object than the object is large is a slip, most often of units."""
    points, _ = region.sample(16, np.random.default_rng(0))
    if isinstance(region, Patch):
        points = region.patch.control_points.reshape(-1, 3)
    outside = np.maximum(0.0, np.maximum(lower - points, points - upper))
    distance = float(np.linalg.norm(outside, axis=1).max())
    if distance > np.linalg.norm(upper - lower):
        raise InputError(
            source, field, f"lies {distance:.3g} m outside the object's bounding box (lengths are in metres)"
        )


def _build_inertia(spec: ObjectFile, parts: list[tuple[Part, float]], source: str) -> MassProperties:
    masses = np.array([part.mesh.volume * density for part, density in parts])
    scale = 1.0 if spec.mass is None else spec.mass / masses.sum()
    mass = float(masses.sum() * scale)
    centre = masses @ np.array([part.mesh.center_mass for part, _ in parts]) / masses.sum()
    bounds = np.array([part.mesh.bounds for part, _ in parts])
    lower, upper = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    if spec.centre is not None:
        centre = np.array(spec.centre)
        if np.any(centre < lower) or np.any(centre > upper):
            raise InputError(source, "centre", "the centre of mass must lie inside the object (metres)")
    if spec.inertia is not None:
        inertia = np.array(spec.inertia)
        _check_inertia(inertia, mass * float((upper - lower) @ (upper - lower)), source)
        return MassProperties(mass, centre, inertia)
    inertia = np.zeros((3, 3))
    for (part, density), m in zip(parts, masses, strict=True):
        d = part.mesh.center_mass - centre
        own = part.mesh.moment_inertia / part.mesh.density * density
        inertia += scale * (own + m * (d @ d * np.eye(3) - np.outer(d, d)))
    return MassProperties(mass, centre, inertia)


def _check_inertia(inertia: Array, largest: float, source: str) -> None:
    moments = np.linalg.eigvalsh(inertia)
    if not np.allclose(inertia, inertia.T, rtol=1e-6, atol=1e-9 * moments[2]):
        raise InputError(source, "inertia", "must be symmetric")
    if moments[0] <= 0 or moments[2] > 1.000001 * (moments[0] + moments[1]):
        raise InputError(source, "inertia", "must be positive, no principal moment above the others' sum")
    if moments[2] > largest:
        raise InputError(
            source, "inertia", f"no body of this mass and size has more than {largest:.3g} kg m^2"
        )
