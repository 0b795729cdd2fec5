"""What an object is: convex pieces, mass, friction and contact regions in the object's own frame."""

from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import trimesh

from ..base.text.plain_text import counted
from ..errors import InputError, UnknownName
from ..geometry import BezierPatch, Hull, MassProperties, Region, combined_mass
from ..geometry.solids import Closeness, Paint

__all__ = ["DEFAULT_RGBA", "ObjectModel", "Part"]

DEFAULT_RGBA = (0.85, 0.55, 0.25, 1.0)
"""Colour of what names none: unlike the greys of hands, which it has to stand out from."""


@dataclass(frozen=True, eq=False, repr=False)
class Part:
    """A named part of an object: a closed surface with the convex pieces that stand for it.

    Attributes:
        name: unique in the object.
        mesh: closed, outward-wound surface in m.
        pieces: convex hulls that together cover the part.
        inertia: mass properties of the part alone, in the object's axes.
        rgba: colour for pictures.
        closeness: how far pieces and surface lie apart; None where it was not measured, as for parts whose
            pieces are made along with their surface.
        paint: what is drawn in place of the surface in one colour; None for that.
    """

    name: str
    mesh: trimesh.Trimesh
    pieces: tuple[Hull, ...]
    inertia: MassProperties
    rgba: tuple[float, float, float, float] = DEFAULT_RGBA
    closeness: Closeness | None = None
    paint: Paint | None = None

    def __repr__(self) -> str:
        pieces = counted(len(self.pieces), "convex piece")
        return f"<Part {self.name}: {len(self.mesh.faces)} triangles, {pieces}>"

    @cached_property
    def inflation(self) -> float:
        """Volume of the convex pieces over that of the surface, less one (overlaps count twice)."""
        pieces = sum(trimesh.Trimesh(p.vertices, p.faces, process=False).volume for p in self.pieces)
        return float(pieces / self.mesh.volume - 1.0)


@dataclass(frozen=True, eq=False, repr=False)
class ObjectModel:
    """An object; all coordinates are in its own frame, in SI units.

    Attributes:
        name: the object's name.
        parts: its parts, rigidly joined.
        friction: Coulomb coefficient against the hand's skin.
        regions: named contact regions on its surface.
        sources: where numbers come from, by field; shown in reports.
        description: a line for people.
        surfaces: named Bezier surfaces, outward normals, that regions may be cut from.
    """

    name: str
    parts: tuple[Part, ...]
    friction: float
    regions: dict[str, Region]
    sources: dict[str, str] = field(default_factory=dict)
    description: str = ""
    surfaces: dict[str, BezierPatch] = field(default_factory=dict)

    def __repr__(self) -> str:
        parts = ", ".join(part.name for part in self.parts)
        return f"<ObjectModel {self.name}: parts {parts}, {len(self.regions)} regions>"

    @cached_property
    def inertia(self) -> MassProperties:
        """Mass properties of the whole object."""
        return combined_mass(part.inertia for part in self.parts)

    def select_parts(self, names: Collection[str]) -> tuple[Part, ...]:
        """The parts of these names, in the object's own order.

        Raises:
            UnknownName: no part has one of the names.
            InputError: no name is given.
        """
        known = [part.name for part in self.parts]
        for name in names:
            if name not in known:
                raise UnknownName(self.name, "parts", f"part of object {self.name}", name, known)
        if not names:
            raise InputError(self.name, "parts", f"name at least one of {', '.join(known)}")
        return tuple(part for part in self.parts if part.name in names)

    @cached_property
    def pieces(self) -> tuple[Hull, ...]:
        """The convex pieces of all parts, in the order of the parts."""
        return tuple(piece for part in self.parts for piece in part.pieces)

    @cached_property
    def mesh(self) -> trimesh.Trimesh:
        """The surfaces of all parts as one mesh."""
        whole = trimesh.util.concatenate([part.mesh for part in self.parts])
        assert isinstance(whole, trimesh.Trimesh)
        return whole

    @cached_property
    def size_m(self) -> float:
        """Diagonal of the bounding box in m."""
        return float(np.linalg.norm(np.ptp(self.mesh.bounds, axis=0)))
