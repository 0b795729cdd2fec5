"""Boxes that are narrowed in place."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..base.numeric.arrays import Array

__all__ = ["Box"]


@dataclass(eq=False)
class Box:
    """A box lower <= x <= upper (n,)."""

    lower: Array
    upper: Array

    def narrow(self, columns: Any, lower: Array, upper: Array) -> None:
        """Cuts columns, which may repeat, to what is known of them; a bound that is NaN says nothing."""
        np.fmax.at(self.lower, columns, lower)
        np.fmin.at(self.upper, columns, upper)

    @property
    def is_empty(self) -> bool:
        """Whether some side ends before it begins."""
        return bool((self.lower > self.upper).any())

    def copy(self) -> "Box":
        """Another box with the same sides."""
        return Box(self.lower.copy(), self.upper.copy())
