"""Object files (YAML): their fields, and how an object is built from them."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, Strict, model_validator

from ..base.files.fields import Inertia3, Mass, Name, RegionName, Text, Vector3, plain_name
from ..base.files.file_model import parse
from ..base.files.library import FILE_SUFFIXES
from ..base.files.yaml_file import read_yaml
from ..base.numeric.arrays import Array
from ..errors import InputError, UnknownName
from ..geometry import BezierPatch, MassProperties, Patch, Region, combined_mass
from ..geometry.solids import solid_inertia
from .generators import GENERATORS, GeneratedShape
from .object_model import DEFAULT_RGBA, ObjectModel, Part
from .shape_file import ClosedShape, ShapeSpec, build_shape
from .surface_region import ObjectRegionSpec, build_object_region

__all__ = ["is_object_file", "read_object"]

Share = Annotated[float, Strict(), Field(ge=0, le=1)]


class BodySpec(ShapeSpec):
    """A shape with its mass."""

    mass: Mass | None = None
    centre: Vector3 | None = None
    inertia: Inertia3 | None = None
    rgba: tuple[Share, Share, Share, Share] | None = None

    @model_validator(mode="after")
    def _inertia_about_centre(self) -> "BodySpec":
        if self.inertia is not None and self.centre is None:
            raise ValueError("inertia needs centre, the centre of mass that it is about")
        return self

    def given(self, kinds: tuple[str, ...]) -> int:
        """How many of these fields are given."""
        return sum(getattr(self, kind) is not None for kind in kinds)


class PartSpec(BodySpec):
    """One of several bodies of an object, in the object's frame."""

    @model_validator(mode="after")
    def _complete(self) -> "PartSpec":
        if self.given(self.KINDS) != 1:
            raise ValueError(f"needs exactly one of {', '.join(self.KINDS)}")
        if self.mass is None:
            raise ValueError("mass is required (in kg)")
        return self


class ObjectFile(BodySpec):
    """An object file."""

    name: Name | None = None
    description: Text = ""
    generator: str | None = None
    parts: Annotated[dict[Name, PartSpec], Field(min_length=1, max_length=100)] | None = None
    friction: Annotated[float, Strict(), Field(gt=0, le=10)]
    regions: Annotated[dict[RegionName, ObjectRegionSpec], Field(max_length=1000)] = {}
    sources: dict[str, Text] = {}

    @model_validator(mode="after")
    def _complete(self) -> "ObjectFile":
        kinds = (*self.KINDS, "parts", "generator")
        if self.given(kinds) != 1:
            raise ValueError(f"needs exactly one of {', '.join(kinds)}")
        if self.parts is not None and self.given(("mass", "centre", "inertia", "rgba", "pose")):
            raise ValueError("each of the parts has its own mass, centre, inertia, rgba and pose")
        if self.generator is not None and self.pose is not None:
            raise ValueError("an object that is generated has no pose: it lies as it is made")
        if self.mass is None and self.generator is None and self.parts is None:
            raise ValueError("mass is required (in kg)")
        return self


# What only files of objects have, and what those of tasks and of hands have instead.
_FIELDS = {*ShapeSpec.KINDS, "parts", "generator", "friction", "mass"}
_OTHERS = {"contacts", "links", "fingers", "import"}


def is_object_file(path: Path) -> bool:
    """Whether a file is that of an object, or may be one that somebody has made a slip in."""
    if path.suffix.lower() not in FILE_SUFFIXES:
        return False
    try:
        fields = read_yaml(path)
    except InputError:
        return False
    return bool(_FIELDS & fields.keys()) and not _OTHERS & fields.keys()


def read_object(path: Path) -> ObjectModel:
    """Reads an object file.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    spec = parse(ObjectFile, read_yaml(path), path)
    source = str(path)
    name = spec.name or plain_name(path.stem, "object")
    shape = _build(spec, name, path)
    regions = {
        key: build_object_region(region, shape.surfaces, source, f"regions.{key}")
        for key, region in spec.regions.items()
    }
    bounds = np.array([part.mesh.bounds for part in shape.parts])
    for key, region in regions.items():
        _check_near(region, bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0), source, f"regions.{key}")
    sources = {**shape.sources, **spec.sources}
    return ObjectModel(name, shape.parts, spec.friction, regions, sources, spec.description, shape.surfaces)


def _build(spec: ObjectFile, name: str, path: Path) -> GeneratedShape:
    if spec.parts is not None:
        return _build_several(spec.parts, path)
    if spec.generator is None:
        shape = build_shape(spec, path, "")
        part = _build_part(name, spec, shape, str(path), "")
        return GeneratedShape((part,), shape.surfaces, _remarks(shape, "mesh"))
    if spec.generator not in GENERATORS:
        raise UnknownName(path, "generator", "generator", spec.generator, GENERATORS)
    made = GENERATORS[spec.generator]()
    if spec.rgba is not None:
        made = replace(made, parts=tuple(replace(part, rgba=spec.rgba) for part in made.parts))
    if spec.centre is not None:
        raise InputError(path, "centre", "an object that is generated knows its own centre of mass")
    if spec.mass is None:
        return made
    scale = spec.mass / combined_mass(part.inertia for part in made.parts).mass
    scaled = tuple(replace(part, inertia=_scaled(part.inertia, scale)) for part in made.parts)
    return replace(made, parts=scaled)


def _build_several(specs: dict[str, PartSpec], path: Path) -> GeneratedShape:
    """Several bodies; the surfaces of each have its name before theirs."""
    parts: list[Part] = []
    surfaces: dict[str, BezierPatch] = {}
    sources: dict[str, str] = {}
    for name, spec in specs.items():
        shape = build_shape(spec, path, f"parts.{name}")
        parts.append(_build_part(name, spec, shape, str(path), f"parts.{name}."))
        surfaces |= {f"{name}/{surface}": patch for surface, patch in shape.surfaces.items()}
        sources |= _remarks(shape, f"mesh of {name}")
    return GeneratedShape(tuple(parts), surfaces, sources)


def _remarks(shape: ClosedShape, key: str) -> dict[str, str]:
    """What was repaired of a mesh, and why its pieces are coarse where they are."""
    repaired = f"repaired: {'; '.join(shape.repairs)}" if shape.repairs else ""
    remarks = "; ".join(remark for remark in (repaired, shape.note) if remark)
    return {key: remarks} if remarks else {}


def _scaled(body: MassProperties, scale: float) -> MassProperties:
    return MassProperties(scale * body.mass, body.centre, scale * body.inertia)


def _build_part(name: str, spec: BodySpec, shape: ClosedShape, source: str, prefix: str) -> Part:
    rgba = DEFAULT_RGBA if spec.rgba is None else spec.rgba
    inertia = _weigh(spec, shape, source, prefix)
    paint = shape.paint if spec.rgba is None else None
    return Part(name, shape.mesh, shape.pieces, inertia, rgba, shape.closeness, paint)


def _weigh(spec: BodySpec, shape: ClosedShape, source: str, prefix: str) -> MassProperties:
    """The mass that the file gives; centre and inertia as given, else at uniform density."""
    assert spec.mass is not None
    uniform = _scaled(solid_inertia(shape.mesh, 1.0), spec.mass / float(shape.mesh.volume))
    if spec.centre is None:
        return uniform
    lower, upper = shape.mesh.bounds
    centre = np.array(spec.centre)
    if np.any(centre < lower) or np.any(centre > upper):
        raise InputError(source, f"{prefix}centre", "the centre of mass must lie inside the object (metres)")
    if spec.inertia is None:
        d = uniform.centre - centre
        moved = uniform.inertia + spec.mass * (d @ d * np.eye(3) - np.outer(d, d))
        return MassProperties(spec.mass, centre, moved)
    inertia = np.array(spec.inertia)
    _check_inertia(inertia, spec.mass * float((upper - lower) @ (upper - lower)), source, f"{prefix}inertia")
    return MassProperties(spec.mass, centre, inertia)


def _check_inertia(inertia: Array, largest: float, source: str, field: str) -> None:
    moments = np.linalg.eigvalsh(inertia)
    if not np.allclose(inertia, inertia.T, rtol=1e-6, atol=1e-9 * moments[2]):
        raise InputError(source, field, "must be symmetric")
    if moments[0] <= 0 or moments[2] > 1.000001 * (moments[0] + moments[1]):
        raise InputError(source, field, "must be positive, no principal moment above the others' sum")
    if moments[2] > largest:
        raise InputError(source, field, f"no body of this mass and size has more than {largest:.3g} kg m^2")


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
