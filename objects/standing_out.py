"""How far the convex pieces of a part stand out of its true surface at the place of a contact."""

from ..geometry import ConvexSurface, Region
from ..geometry.solids import SurfaceDistance
from .object_model import Part

__all__ = ["standing_out"]

# Less than this is what distances are rounded by.
_LEAST_M = 1e-6


def standing_out(part: Part, region: Region) -> float:
    """How far, in m, a part's pieces stand out of its surface all over a region; never more than is stated.

    A body that touches the surface there sinks into the pieces by as much. The least of the depths counts
    that places of the region, brought onto the surface, have under the pieces: where these lie on the surface
    anywhere in the region, a contact can touch in earnest there, and has no need of an allowance.

    Args:
        part: the part that carries the region; 0 where its closeness was not measured.
        region: in the object's frame; 0 where it is meant to lie off the surface.
    """
    if part.closeness is None or part.closeness.outside_m <= 0.0 or region.off_surface:
        return 0.0
    places = SurfaceDistance(part.mesh).nearest(region.spread()[0])
    depths_m = -ConvexSurface(part.pieces).signed_distances(places)
    least_m = min(float(depths_m.min()), part.closeness.outside_m)
    return least_m if least_m >= _LEAST_M else 0.0
