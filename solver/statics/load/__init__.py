"""How large a load contacts of limited normal force carry at most, whichever way gravity acts."""

from .best import BestLoad, best_load
from .problem import largest_force_N, load_form, why_no_load

__all__ = ["BestLoad", "best_load", "largest_force_N", "load_form", "why_no_load"]
