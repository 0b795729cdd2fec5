"""How far an object yields in a squeezed grasp: what servos and pads give way, and what the squeeze adds."""

from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array
from ...mjcf import HoldSettings, Squeeze
from ...mjcf.squeeze import Statics, grasp_statics
from ...solver import Configuration

__all__ = ["Yielding", "contact_compliance", "yielding"]

_STANDARD_GRAVITY = 9.81
# A pad gives way sideways by this much more than along its normal, as rubber does.
_SIDEWAYS = 1.5
# Least force and yield of a pad, so that each has a stiffness.
_LEAST_N, _LEAST_M = 0.1, 1e-5


class Yielding(NamedTuple):
    """How far an object yields.

    Attributes:
        sag_m: displacement of the centre of mass under the weight, in the weakest direction.
        turn_rad: turn under the weight at an arm of 10 mm, about the weakest axis.
        buckling: turn that the squeeze's own forces add to a turn, as a share of it; above 1 the object would
            turn by itself if no contact rolled.
    """

    sag_m: float
    turn_rad: float
    buckling: float


def yielding(configuration: Configuration, squeeze: Squeeze, settings: HoldSettings) -> Yielding:
    """The object's compliance C = (G c^-1 G^T)^-1, with c that of servos and pads at the contacts."""
    statics = grasp_statics(configuration, settings)
    count = statics.n_contacts
    normal = np.maximum(squeeze.preload[:, 0], 0.0)
    stiffness = statics.G @ np.linalg.solve(contact_compliance(statics, squeeze), statics.G.T)
    compliance = np.linalg.pinv(stiffness, hermitian=True)
    sag, turn = (float(np.linalg.eigvalsh(block).max()) for block in (compliance[:3, :3], compliance[3:, 3:]))
    weight = _STANDARD_GRAVITY * statics.mass
    points: Array = statics.points[:count]
    lever = float(normal @ np.linalg.norm(points - points.mean(axis=0), axis=1))
    return Yielding(weight * max(sag, 0.0), 0.01 * weight * max(turn, 0.0), lever * max(turn, 0.0))


def contact_compliance(statics: Statics, squeeze: Squeeze) -> Array:
    """How far contacts give way (4 n, 4 n) in m (or rad) by their forces in N (or N m): servos and pads."""
    normal = np.maximum(squeeze.preload[:, 0], 0.0)
    pads = np.maximum(squeeze.yields_m, _LEAST_M) / np.maximum(normal, _LEAST_N)
    arms = np.maximum(squeeze.spin_arms_m, _LEAST_M)
    own = np.column_stack([pads, _SIDEWAYS * pads, _SIDEWAYS * pads, _SIDEWAYS * pads / arms**2])
    servos: Array = statics.T.T @ (statics.T / statics.stiffness[:, None])
    return servos + np.diag(own.ravel())
