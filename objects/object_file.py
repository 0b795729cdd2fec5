"""Object files (YAML): their fields, and how an object is built from them."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import trimesh
from pydantic import Field, model_validator

from ..errors import InputError
from ..files import FileModel, parse, read_yaml, resolve_beside
from ..geometry import MassProperties, RegionSpec, build_region
from ..geometry.regions import Vector3
from .decompose import convex_pieces
from .generators import GENERATORS
from .object_model import ObjectModel, Part

__all__ = ["read_object"]

Positive = Annotated[float, Field(gt=0)]
_MESH_FORMATS = (".obj", ".stl", ".ply", ".glb", ".off")


class BoxSpec(FileModel):
    """A box along the object's axes, centred at its origin."""

    half_extents: tuple[Positive, Positive, Positive]


class CylinderSpec(FileModel):
    """A cylinder along the object's z axis, centred at its origin."""

    radius: Positive
    length: Positive


class SphereSpec(FileModel):
    """A ball centred at the object's origin."""

    radius: Positive


class CapsuleSpec(FileModel):
    """A capsule along the object's z axis, centred at its origin; `length` is that of its straight part."""

    radius: Positive
    length: Positive


class ObjectFile(FileModel):
    """An object file."""

    name: str
    description: str = ""
    mesh: str | None = None
    box: BoxSpec | None = None
    cylinder: CylinderSpec | None = None
    sphere: SphereSpec | None = None
    capsule: CapsuleSpec | None = None
    generator: Literal["scalpel"] | None = None
    mass: Positive | None = None
    centre: Vector3 | None = None
    inertia: tuple[Vector3, Vector3, Vector3] | None = None
    friction: Annotated[float, Field(gt=0, le=10)]
    regions: dict[str, RegionSpec] = {}
    sources: dict[str, str] = {}

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
    if spec.mesh is not None:
        mesh = _read_mesh(resolve_beside(path, spec.mesh, "mesh"), str(path))
    elif spec.box is not None:
        mesh = trimesh.creation.box(extents=2.0 * np.array(spec.box.half_extents))
    elif spec.cylinder is not None:
        mesh = trimesh.creation.cylinder(spec.cylinder.radius, spec.cylinder.length, sections=48)
    elif spec.sphere is not None:
        mesh = trimesh.creation.icosphere(subdivisions=3, radius=spec.sphere.radius)
    else:
        assert spec.capsule is not None
        mesh = trimesh.creation.capsule(spec.capsule.length, spec.capsule.radius, count=[24, 24])
        mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return [(Part(spec.name, mesh, convex_pieces(mesh)), 1.0)]


def _read_mesh(path: Path, source: str) -> trimesh.Trimesh:
    if path.suffix.lower() not in _MESH_FORMATS:
        raise InputError(source, "mesh", f"{path.name!r} must end in one of {', '.join(_MESH_FORMATS)}")
    if not path.is_file():
        raise InputError(source, "mesh", f"there is no file {path.name!r}")
    try:
        mesh = trimesh.load_mesh(path, process=True)
    except (
        ValueError,
        IndexError,
        KeyError,
        TypeError,
        AttributeError,
        OSError,
        UnicodeDecodeError,
    ) as error:
        raise InputError(source, "mesh", f"{path.name!r} can't be read as a mesh: {error}") from None
    if not isinstance(mesh, trimesh.Trimesh) or len(mesh.faces) == 0:
        raise InputError(source, "mesh", f"{path.name!r} holds no triangles")
    if not np.isfinite(mesh.vertices).all():
        raise InputError(source, "mesh", f"{path.name!r} has coordinates that are not finite")
    mesh.merge_vertices()
    if not mesh.is_watertight:
        raise InputError(source, "mesh", f"{path.name!r} is not closed: the surface has open edges")
    if not mesh.is_winding_consistent:
        mesh.fix_normals(multibody=True)
    if mesh.volume < 0:  # inside out: a closed surface can be turned without guessing
        mesh.invert()
    if not mesh.is_winding_consistent or mesh.volume <= 0:
        raise InputError(source, "mesh", f"{path.name!r} encloses no volume")
    return mesh


def _build_inertia(spec: ObjectFile, parts: list[tuple[Part, float]], source: str) -> MassProperties:
    masses = np.array([part.mesh.volume * density for part, density in parts])
    scale = 1.0 if spec.mass is None else spec.mass / masses.sum()
    mass = float(masses.sum() * scale)
    centres = np.array([part.mesh.center_mass for part, _ in parts])
    centre = masses @ centres / masses.sum()
    inertia = np.zeros((3, 3))
    for (part, density), m, c in zip(parts, masses, centres, strict=True):
        d = c - centre
        own = part.mesh.moment_inertia / part.mesh.density * density
        inertia += scale * (own + m * (d @ d * np.eye(3) - np.outer(d, d)))
    if spec.centre is not None:
        d = np.array(spec.centre) - centre
        inertia = inertia + mass * (d @ d * np.eye(3) - np.outer(d, d))
        centre = np.array(spec.centre)
    if spec.inertia is not None:
        inertia = _check_inertia(np.array(spec.inertia), source)
    return MassProperties(mass, centre, inertia)


def _check_inertia(inertia: np.ndarray, source: str) -> np.ndarray:
    moments = np.linalg.eigvalsh(inertia)
    if (
        not np.allclose(inertia, inertia.T, rtol=1e-6)
        or moments[0] <= 0
        or moments[2] > 1.000001 * (moments[0] + moments[1])
    ):
        raise InputError(
            source, "inertia", "must be symmetric, positive, and no moment above the sum of the others"
        )
    return inertia
