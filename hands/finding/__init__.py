"""Contact regions of a hand found from its links and how they move: tips, pads, sides and the palm."""

from .cast import surface_points
from .find import find_regions

__all__ = ["find_regions", "surface_points"]
