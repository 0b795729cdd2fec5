"""Where an object may be touched: its named regions, and patches fitted all over its surface."""

from dataclasses import dataclass

import numpy as np
import trimesh

from ...arrays import Array
from ...errors import InputError
from ...geometry import BezierPatch, Cap, Patch, PointRegion, Region
from ...objects import ObjectModel, fit_patch

__all__ = ["Site", "middle", "sites"]

_SAMPLES = 96
# Radius of the fitted patches: a fingertip's, or less on a small object.
_RADIUS_M = 0.008
_SHARE_OF_SIZE = 0.1
# A patch that is further off the surface, or leans more, would put the finger beside it.
_LARGEST_ERROR_M = 3e-4
_LARGEST_LEAN_RAD = np.radians(15.0)
# Control points are rounded to this many digits of a metre, so that a file says just what was tried.
_DIGITS = 7


@dataclass(frozen=True, eq=False)
class Site:
    """A place where the object may be touched, in its own frame.

    Attributes:
        name: of a region that the object has; empty for a fitted patch.
        region: the region.
        point: (3,) its middle, in m.
        normal: (3,) unit outward normal there.
    """

    name: str
    region: Region
    point: Array
    normal: Array


def sites(obj: ObjectModel, seed: int = 0) -> list[Site]:
    """The object's own regions first, then patches spread over its surface wherever one fits."""
    own = [Site(name, region, *middle(region)) for name, region in obj.regions.items()]
    radius = min(_RADIUS_M, _SHARE_OF_SIZE * obj.size_m)
    points, _ = trimesh.sample.sample_surface_even(obj.mesh, _SAMPLES, seed=seed)
    fitted = [_fit(obj.mesh, point, radius) for point in np.asarray(points)]
    return own + [site for site in fitted if site is not None]


def _fit(mesh: trimesh.Trimesh, point: Array, radius_m: float) -> Site | None:
    """A patch around a point; None near edges and where the surface is too rough."""
    try:
        fit = fit_patch(mesh, point, radius_m)
    except InputError:
        return None
    if fit.max_m > _LARGEST_ERROR_M or fit.normal_rad > _LARGEST_LEAN_RAD:
        return None
    region = Patch(BezierPatch(np.round(fit.patch.control_points, _DIGITS)))
    return Site("", region, *middle(region))


def middle(region: Region) -> tuple[Array, Array]:
    """Point (3,) in m and unit outward normal (3,) in the middle of a region."""
    match region:
        case Patch():
            return region.patch.evaluate(0.5, 0.5), region.patch.unit_normal(0.5, 0.5)
        case Cap():
            return region.centre + region.radius * region.axis, region.axis
        case PointRegion():
            return region.point, region.normal
