"""Units of meshes, and sizes that no hand's object has, most often because of another unit."""

import warnings
from typing import Annotated

import numpy as np
import trimesh
from pydantic import AfterValidator, Field, Strict

from ..arguments import number_or_nan
from ..errors import InputError, InputWarning, UnknownName

__all__ = ["UNITS_M", "Scale", "Unit", "check_size", "metres"]

UNITS_M = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
"""Metres in each unit of length that a mesh may have."""

_SCALES = (1e-9, 1e9)
# Beyond these the arithmetic of the later stages means nothing.
_SMALLEST_M, _LARGEST_M = 1e-3, 200.0
# What a hand holds has a longest side in this range, from a pill or a nut to a broom or a guitar.
_USUAL_M = (5e-3, 2.0)
# And most often in this one: a unit that brings it there was probably meant.
_LIKELY_M = (0.03, 0.5)
# Units that meshes usually have, in words.
_NAMES = {"m": "metres", "cm": "centimetres", "mm": "millimetres", "in": "inches"}


def _check_unit(unit: str) -> str:
    if unit not in UNITS_M:
        raise ValueError(f"must be one of {', '.join(UNITS_M)}")
    return unit


Unit = Annotated[str, AfterValidator(_check_unit)]
"""`units:` of a mesh in a file."""

Scale = Annotated[float, Strict(), Field(ge=_SCALES[0], le=_SCALES[1])]
"""`scale:` of a mesh in a file."""


def metres(scale: float | None, units: str | None) -> float:
    """Metres for each unit of a mesh's coordinates; both together multiply.

    Args:
        scale: a factor on the coordinates, 1 unless given.
        units: a name from `UNITS_M`, metres unless given.

    Raises:
        InputError: no such unit, or a scale that can't be.
    """
    if units is not None and units not in UNITS_M:
        raise UnknownName("object", "units", "unit of length", str(units), UNITS_M)
    # Compared this way round, NaN fails too.
    if scale is not None and not _SCALES[0] <= number_or_nan(scale) <= _SCALES[1]:
        raise InputError("object", "scale", f"must lie in [{_SCALES[0]:g}, {_SCALES[1]:g}], not {scale!r}")
    return (1.0 if scale is None else float(scale)) * UNITS_M[units or "m"]


def check_size(mesh: trimesh.Trimesh, source: str, field: str, *, unit_m: float | None = None) -> None:
    """Warns of a size that no hand's object has, and refuses one that nothing can be computed of.

    Args:
        mesh: in m.
        source: what asked for it, for messages.
        field: where in that.
        unit_m: metres that each unit of a mesh file was taken for; None for shapes that are not from one.

    Raises:
        InputError: smaller or larger than anything; names the unit that was probably meant.
    """
    size = float(np.max(mesh.extents))
    if _USUAL_M[0] <= size <= _USUAL_M[1]:
        return
    said = f"the object is {size:.3g} m long{_meant(size, unit_m)}"
    if not _SMALLEST_M <= size <= _LARGEST_M:
        raise InputError(source, field, f"{said}; {_SMALLEST_M:g} to {_LARGEST_M:g} m is accepted")
    warnings.warn(
        InputWarning(source, field, f"{said}; what hands hold is {_USUAL_M[0]:g} to {_USUAL_M[1]:g} m long"),
        stacklevel=2,
    )


def _meant(size: float, unit_m: float | None) -> str:
    """The units that bring it to the size of what hands hold, in words."""
    raw = size / (1.0 if unit_m is None else unit_m)
    likely = [name for name in _NAMES if _LIKELY_M[0] <= raw * UNITS_M[name] <= _LIKELY_M[1]]
    if unit_m is None:
        return f": were {_NAMES[likely[0]]} meant? Lengths are in metres" if likely else " (in metres)"
    if not likely:
        return ": are its `units` and its `scale` right?"
    names = " or ".join(_NAMES[name] for name in likely)
    says = " or ".join(f"`units: {name}`" for name in likely)
    scaled = "" if unit_m in UNITS_M.values() else " and no `scale`"
    return f": probably {names}; say {says}{scaled} (`--units` on the command line)"
