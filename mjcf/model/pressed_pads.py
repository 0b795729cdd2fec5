"""The pads at the contacts of a squeeze, as a model needs them."""

from dataclasses import dataclass

from ...base.numeric.arrays import Array

__all__ = ["PressedPads"]


@dataclass(frozen=True, eq=False)
class PressedPads:
    """What the planned forces make of the pads.

    Attributes:
        normals_N: planned normal force (n,) at each contact of the task.
        yields_m: how far each pad yields (n,) under it; 0 where contacts aren't soft.
        spin_arms_m: arm (n,) at which friction resists spin there.
    """

    normals_N: Array
    yields_m: Array
    spin_arms_m: Array
