"""The area over which two surfaces are pressed to each other around a contact, in outward-rounded arithmetic.

How large it is, is a model of the pad and not proved (docs/proved.md, "Wide contacts"). With n the true
normal, K the relative curvature of both surfaces seen in the tangent plane, d an offset in that plane, and y
what the pad yields under a usual force, the area is

    |K d| <= t,   d . K d <= 2 y,   k |d|^2 <= 2 y,   |d| <= L:

the place where the surfaces are nearest gets there while one turns by t, half of what the test allows; they
are no farther apart there than the pad yields; no surface counts as flatter than k; and L is the pad's depth.
"""

from dataclasses import dataclass
from math import pi

import numpy as np

from ..geometry import Cap, Patch, Region
from ..hands import FLATTEST_PER_M, SHARPEST_PER_M, Pad
from ..mjcf import HoldSettings
from ..mjcf.squeeze import TURN_SHARE, USUAL_N
from ..objects import Task
from ..solver import region_params
from ..solver.interval import Balls
from .true_contacts import TrueContacts, TruePlaces, true_contacts
from .true_patches import patch_curvature

__all__ = ["ContactArea", "ContactAreas", "length"]

# More than a few roundings up or down.
_ROUNDED = 1e-14


@dataclass(frozen=True, eq=False)
class ContactArea:
    """The area of one contact.

    Attributes:
        K: relative curvature (3, 3) in 1/m in the palm frame; along the normal it is zero.
        turn_rad: by how much the surfaces may turn against each other, at least.
        yield_m: how far the pad yields, at least.
        depth_m: of the pad.
    """

    K: Balls
    turn_rad: float
    yield_m: float
    depth_m: float

    def share(self, d: Balls) -> float:
        """Below the factor by which an offset d (3,) in the tangent plane may be longer."""
        tilt = self.K @ d
        sag_m = max(float((d * tilt).sum().upper), 1e-300)
        length_m = length(d)
        shares = (
            self.turn_rad / max(length(tilt), 1e-300),
            float(np.sqrt(2.0 * self.yield_m / sag_m)),
            float(np.sqrt(2.0 * self.yield_m / FLATTEST_PER_M)) / length_m,
            self.depth_m / length_m,
        )
        return min(shares) * (1.0 - _ROUNDED)


class ContactAreas:
    """The contacts of a task over all places that they may have, and their areas, each worked out once.

    Attributes:
        task: the task.
        settings: of the hold test.
        at: hand and object.
        contacts: of the task.
    """

    def __init__(self, task: Task, settings: HoldSettings, at: TruePlaces):
        self.task, self.settings, self.at = task, settings, at
        self.contacts = true_contacts(task, at)
        self._found: dict[int, ContactArea] = {}

    def __getitem__(self, i: int) -> ContactArea:
        """The area of contact i."""
        if i not in self._found:
            self._found[i] = self._area(i)
        return self._found[i]

    def _area(self, i: int) -> ContactArea:
        limit, pad = self.settings.rotation_limit_rad, self.task.hand.pad
        K = _curvature(self.task, i, self.at, self.contacts)
        turn_rad = TURN_SHARE * (pi if limit is None else limit) * (1.0 - _ROUNDED)
        return ContactArea(K, turn_rad, _least_yield_m(pad, K), pad.thickness_m)


def length(v: Balls) -> float:
    """Above the length of a vector (3,)."""
    return float(np.sqrt((v.most * v.most).sum()) * (1.0 + _ROUNDED))


def _least_yield_m(pad: Pad, K: Balls) -> float:
    """Below how far the pad yields under a usual force where the relative curvature is K (3, 3)."""
    # The eigenvalues but for zero: half +- root, with root^2 = K : K / 2 - half^2.
    half = K[[0, 1, 2], [0, 1, 2]].sum() * 0.5
    square = (K * K).sum() * 0.5 - half * half
    least, most = np.sqrt(np.maximum([float(square.lower), float(square.upper)], 0.0)).tolist()
    lower = float(half.lower)
    ks = [lower - most * (1.0 + _ROUNDED), lower + least * (1.0 - _ROUNDED)]
    slack = _ROUNDED * (abs(lower) + most)
    k1, k2 = np.clip([k - slack for k in ks], FLATTEST_PER_M, SHARPEST_PER_M).tolist()
    per_m2 = USUAL_N * pad.thickness_m / (pi * pad.modulus_Pa)
    return float(np.sqrt(per_m2 * np.sqrt(k1 * k2))) * (1.0 - _ROUNDED)


def _curvature(task: Task, i: int, at: TruePlaces, contacts: TrueContacts) -> Balls:
    contact, params = task.contacts[i], region_params(task)[i]
    K = Balls.exact(np.zeros((3, 3)))
    for region, R, where in (
        (contact.hand.region, at.links.rotations[contact.hand.link], params[0]),
        (contact.object.region, at.R, params[1]),
    ):
        K = K + R @ _in_body(region, at.params[where]) @ R.T
    n = contacts.inward[i]
    across = np.eye(3) - n[:, None] * n[None, :]
    return across @ K @ across


def _in_body(region: Region, params: Balls) -> Balls:
    """The curvature (3, 3) of a region, as `geometry.region_curvature` has it."""
    match region:
        case Cap():
            return Balls.exact(np.eye(3)) / region.radius
        case Patch():
            return patch_curvature(region.patch.control_points, params)
    return Balls.exact(np.zeros((3, 3)))
