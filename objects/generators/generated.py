"""The shape of an object with its mass, however it was made."""

from dataclasses import dataclass, field

from ...geometry import BezierPatch
from ..object_model import Part

__all__ = ["GeneratedShape"]


@dataclass(frozen=True, eq=False)
class GeneratedShape:
    """The shape of an object.

    Attributes:
        parts: its parts with their mass.
        surfaces: named Bezier surfaces, outward normal p_u x p_v, that regions of its file may be cut from.
        sources: where it comes from and what was done to it, for people.
    """

    parts: tuple[Part, ...]
    surfaces: dict[str, BezierPatch] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
