"""The soft pads of a hand: how far they yield under a force, and how well they resist being spun.

A pad is a layer of half the link's thickness on something rigid, each column of it a spring of its own (the
elastic foundation: Johnson, Contact Mechanics, 1985, section 4.3; hydroelastic contact has this pressure).
Where two surfaces with relative principal curvatures k1 and k2 approach each other by d, the pressure E d / L
in the middle falls off as 1 - (x / a)^2 - (y / b)^2 over a patch with the half axes a = sqrt(2 d / k1) and
b = sqrt(2 d / k2), which makes a force of pi E d^2 / (L sqrt(k1 k2)).
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ellipe

from ..arguments import check_number
from ..base.numeric.arrays import Array

__all__ = ["FLATTEST_PER_M", "SHARPEST_PER_M", "Pad"]

FLATTEST_PER_M, SHARPEST_PER_M = 20.0, 1000.0
"""In 1/m: nothing is flatter to a pad, nor sharper, whatever a region says."""
# Mean distance from the middle, weighted with the pressure, by the radius of a round patch.
_MEAN_ARM = 8.0 / 15.0


@dataclass(frozen=True)
class Pad:
    """The skin of a hand.

    Attributes:
        modulus_Pa: elastic modulus E; that of silicone rubber of Shore 60 A, as fingertips have it, where
            nothing else is known.
        thickness_m: depth L of the soft layer, half the thickness of a link that is soft all through.

    Raises:
        InputError: a value that is not above zero.
    """

    modulus_Pa: float = 3.5e6
    thickness_m: float = 0.013

    def __post_init__(self) -> None:
        check_number("Pad.modulus_Pa", self.modulus_Pa, above=0.0)
        check_number("Pad.thickness_m", self.thickness_m, above=0.0)

    def yield_m(self, force_N: Array, curvatures: Array) -> Array:
        """How far pads yield (n,) under normal forces (n,).

        Args:
            force_N: normal forces (n,); those below zero count as none.
            curvatures: relative principal curvatures (n, 2) in 1/m, of both surfaces together.
        """
        k1, k2 = self._bounded(curvatures)
        force = np.maximum(force_N, 0.0)
        return np.sqrt(force * self.thickness_m * np.sqrt(k1 * k2) / (np.pi * self.modulus_Pa))

    def patch_m(self, force_N: Array, curvatures: Array, edges_m: Array | None = None) -> Array:
        """Half axes (n, 2) of the patches, at most as long as the pad is thick: beyond, a link turns away.

        Args:
            force_N: see `yield_m`.
            curvatures: see `yield_m`.
            edges_m: (n, 2, 2) where the pad ends along the first and the second principal direction, either
                way; a patch that is cut off counts with its mean half axis. None for pads without an end.
        """
        yields = self.yield_m(force_N, curvatures)
        axes = np.sqrt(2.0 * yields[:, None] / np.stack(self._bounded(curvatures), axis=1))
        axes = np.minimum(axes, self.thickness_m)
        return axes if edges_m is None else np.minimum(axes[:, :, None], edges_m).mean(axis=2)

    def spin_arm_m(self, force_N: Array, curvatures: Array, edges_m: Array | None = None) -> Array:
        """Torque (n,) about the normal that friction resists, per newton of normal force and of friction.

        Args:
            force_N: see `yield_m`.
            curvatures: see `yield_m`.
            edges_m: see `patch_m`.
        """
        axes = np.sort(self.patch_m(force_N, curvatures, edges_m), axis=1)
        short, long = axes[:, 0], np.maximum(axes[:, 1], 1e-12)
        # The mean radius of an ellipse over all directions is its circumference over 2 pi.
        return _MEAN_ARM * 2.0 / np.pi * long * ellipe(1.0 - (short / long) ** 2)

    @property
    def largest_arm_m(self) -> float:
        """What `spin_arm_m` can't exceed."""
        return _MEAN_ARM * self.thickness_m

    @staticmethod
    def _bounded(curvatures: Array) -> tuple[Array, Array]:
        k = np.clip(curvatures, FLATTEST_PER_M, SHARPEST_PER_M)
        return k[:, 0], k[:, 1]
