"""An object heavier or less balanced than it was planned for, in a compiled model."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...arguments import check_number
from ...base.numeric.arrays import Array
from ...errors import InputError
from .object import OBJECT_BODY

__all__ = ["Burden", "set_burden"]


def _nowhere() -> Array:
    return np.zeros(3)


@dataclass(frozen=True, eq=False)
class Burden:
    """What the object is by mass, against what it was planned to be.

    Attributes:
        mass_factor: times its mass, evenly.
        com_offset_m: displacement (3,) of its centre of mass, in its own frame; its moments of inertia about
            the centre stay.
    """

    mass_factor: float = 1.0
    com_offset_m: Array = field(default_factory=_nowhere)

    def __post_init__(self) -> None:
        check_number("Burden.mass_factor", self.mass_factor, above=0.0)
        offset = np.array(self.com_offset_m, dtype=float)
        if offset.shape != (3,) or not np.isfinite(offset).all():
            raise InputError("Burden.com_offset_m", "", "must be three numbers in m")
        object.__setattr__(self, "com_offset_m", offset)


def set_burden(model: Any, burden: Burden) -> None:
    """Gives the object of a model, which nobody else uses, another mass and centre of mass."""
    import mujoco  # late, as in `hold.simulation`

    body = model.body(OBJECT_BODY).id
    model.body_mass[body] *= burden.mass_factor
    model.body_inertia[body] *= burden.mass_factor
    model.body_ipos[body] += burden.com_offset_m
    mujoco.mj_setConst(model, mujoco.MjData(model))  # what is derived from masses
