"""Regions of an object as they stand in files: any region, or a piece cut from one of its named surfaces."""

from collections.abc import Mapping
from typing import Annotated, ClassVar

from pydantic import Field, Strict, model_validator

from ..errors import UnknownName
from ..geometry import BezierPatch, Patch, Region, RegionSpec, build_region, check_regular

__all__ = ["ObjectRegionSpec", "build_object_region"]

Parameter = Annotated[float, Strict(), Field(ge=0, le=1)]
# A narrower cut is a slip, and no hand is placed as exactly.
_NARROWEST = 1e-3


class ObjectRegionSpec(RegionSpec):
    """A region of an object: `surface` with the ranges `u` and `v` of its parameters, or as on a hand."""

    KINDS: ClassVar[tuple[str, ...]] = ("bezier", "cap", "surface", "point")

    surface: str | None = None
    u: tuple[Parameter, Parameter] | None = None
    v: tuple[Parameter, Parameter] | None = None

    @model_validator(mode="after")
    def _cut(self) -> "ObjectRegionSpec":
        if self.surface is None and (self.u is not None or self.v is not None):
            raise ValueError("u and v are ranges of the parameters of a surface, which is not named")
        for name in ("u", "v"):
            given = getattr(self, name)
            if given is not None and given[1] - given[0] < _NARROWEST:
                raise ValueError(f"{name} must be a range [low, high] in [0, 1] at least {_NARROWEST:g} wide")
        return self


def build_object_region(
    spec: ObjectRegionSpec, surfaces: Mapping[str, BezierPatch], source: str, field: str
) -> Region:
    """Builds a region; one of a surface is cut out by de Casteljau's rule, so it is the same polynomial.

    Raises:
        InputError: as for any region; a surface that the object does not have; a cut through a pole.
    """
    if spec.surface is None:
        return build_region(spec, source, field)
    if spec.surface not in surfaces:
        raise UnknownName(source, f"{field}.surface", "surface of this object", spec.surface, surfaces)
    cut = surfaces[spec.surface].restrict(spec.u or (0.0, 1.0), spec.v or (0.0, 1.0))
    return Patch(check_regular(cut, source, field), spec.off_surface)
