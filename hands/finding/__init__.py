"""Contact regions of a hand found from its links and how they move: tips, pads, sides and the palm."""

from .cast import surface_points
from .find import find_regions
from .fit import Frame, fit_cap, fit_patch, fit_point

__all__ = ["Frame", "find_regions", "fit_cap", "fit_patch", "fit_point", "surface_points"]
