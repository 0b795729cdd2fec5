"""A squeeze: where the servos' targets go, and what that is planned to carry."""

from dataclasses import dataclass, field

import numpy as np

from ...base.numeric.arrays import Array
from ...base.text.significant import significant
from ..settings import HoldSettings
from .pressed_pads import PressedPads

__all__ = ["Squeeze"]

_ARRAYS = (
    "targets",
    "efforts",
    "preload",
    "loaded",
    "spin_arms_m",
    "yields_m",
    "centres_m",
    "loaded_centres_m",
    "path",
)


def _nowhere() -> Array:
    return np.zeros((0, 0))


@dataclass(frozen=True, eq=False, repr=False)
class Squeeze:
    """A squeeze, and what it is planned to carry.

    Attributes:
        targets: servo targets (n_independent,) in rad or m.
        efforts: efforts (n_independent,) of the squeeze alone in N m or N, where the pads have yielded.
        preload: contact vector (n, 4) of the squeeze alone, as in `statics`.
        loaded: contact vectors (n_loads, n, 4) that carry `load_factor` times the load: one a direction of
            gravity, one a state of a turn, or the squeeze itself in a press.
        load_factor: how many times the load (the weight; the friction of the hinge; the force of a press) it
            carries by the rigid-body plan, at most the planned one. Below 1 it is the best there is; rolling
            contacts often make it hold all the same. It is 0 where contacts must roll first.
        settings: what it was planned for.
        spin_arms_m: (n,) arm at which friction resists spin at each contact, under the squeeze alone.
        yields_m: (n,) how far the pad of each contact yields under it.
        centres_m: (n, 2) where on each contact the squeeze presses, off its point along the tangents of
            `Statics.frames`, in m: 0 but where contacts are wide, and everywhere where it is not given.
        loaded_centres_m: (n_loads, n, 2) the same under load.
        path: servo targets (k, n_independent) that follow, where the hand turns something.
        rule: which of a grasp's squeezes this is: empty for the usual one, else as in `alternatives`.
    """

    targets: Array
    efforts: Array
    preload: Array
    loaded: Array
    load_factor: float
    settings: HoldSettings
    spin_arms_m: Array
    yields_m: Array
    centres_m: Array = field(default_factory=_nowhere)
    loaded_centres_m: Array = field(default_factory=_nowhere)
    path: Array = field(default_factory=_nowhere)
    rule: str = ""

    def __post_init__(self) -> None:
        for name, vectors in (("centres_m", self.preload), ("loaded_centres_m", self.loaded)):
            if getattr(self, name).size == 0:
                object.__setattr__(self, name, np.zeros((*vectors.shape[:-1], 2)))
        for name in _ARRAYS:
            array = np.array(getattr(self, name), dtype=float)
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def __str__(self) -> str:
        total_N = float(self.preload[:, 0].sum())
        squeeze = f"squeeze of {len(self.preload)} contacts with {significant(total_N, 3)} N in all"
        if self.load_factor == 0.0:
            return f"{squeeze}, without a plan that carries the load"
        return f"{squeeze}, planned for {significant(self.load_factor, 3)} times the load"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    @property
    def pads(self) -> PressedPads:
        """What the squeeze makes of the pads."""
        return PressedPads(self.preload[:, 0], self.yields_m, self.spin_arms_m)
