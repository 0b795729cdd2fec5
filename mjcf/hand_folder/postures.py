"""Postures of a hand for keyframes: open, pinch, power."""

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from ...base.numeric.arrays import Array
from ...geometry import Cap
from ...hands import Hand, HandRegion, forward_kinematics
from ...retraction import overlapping_links
from ..model import hand_mjcf

__all__ = ["Pinch", "SelfContact", "leaf_links", "open_posture", "pinch", "power_posture"]

# A joint whose limit on one side of zero is this much nearer than on the other bends one way.
_ONE_SIDED = 2.0
# Share of the way to the far limit in a power posture.
_POWER_SHARE = 0.7
_PINCH_GAP_M = 0.02
# Opposed pads and small motions in a pinch, against a distance of this size.
_LENGTH_M = 0.01
_EASE = 0.05
_SPREADING = 1.0
_EASING = 0.05
_MOST_EASINGS = 100


def leaf_links(hand: Hand) -> tuple[int, ...]:
    """Links that carry no other link: the last ones of the fingers."""
    parents = {link.parent for link in hand.links}
    return tuple(i for i, link in enumerate(hand.links) if i not in parents and link.parent >= 0)


def open_posture(hand: Hand) -> Array:
    """Independent joints (n_independent,) at zero, or at the limit next to it."""
    return np.clip(0.0, *hand.limits.T)


def power_posture(hand: Hand) -> Array:
    """Joints that bend one way go towards their far limit as long as no links meet; the others stay open."""
    start, way = open_posture(hand), _bending(hand)
    touching = SelfContact(hand)
    share = np.full(len(start), _POWER_SHARE)
    for _ in range(_MOST_EASINGS):
        pairs = touching.pairs(start + share * way)
        if not pairs:
            break
        # Whatever moves one of two links that meet, but not both, opens a little.
        moves = hand.tree.moves
        for a, b in pairs:
            apart = (moves[a] ^ moves[b]) @ np.abs(hand.coupling_matrix) > 0.0
            share[apart] = np.maximum(0.0, share[apart] - _EASING)
    return start + share * way


def _bending(hand: Hand) -> Array:
    """Way (n_independent,) from open to the far limit of the joints that bend one way, 0 for the others."""
    start = open_posture(hand)
    lower, upper = hand.limits.T
    below, above = start - lower, upper - start
    return np.where(above > _ONE_SIDED * below, above, np.where(below > _ONE_SIDED * above, -below, 0.0))


class SelfContact:
    """Which links of a hand meet in a posture, by MuJoCo's measure; links side by side are left out."""

    def __init__(self, hand: Hand):
        import mujoco  # late, as in `simulation`

        self._mujoco: Any = mujoco
        self._hand = hand
        self._left_out = overlapping_links(hand)
        self._model = mujoco.MjModel.from_xml_string(hand_mjcf(hand))
        self._data = mujoco.MjData(self._model)

    def pairs(self, q: Array) -> set[tuple[int, int]]:
        """Pairs (a, b), a < b, of links that sink into each other at independent joints `q`."""
        self._data.qpos[:] = self._hand.expand(q)
        self._mujoco.mj_forward(self._model, self._data)
        found = set()
        for contact in self._data.contact[: self._data.ncon]:
            # Bodies are numbered after the world, in the order of the links.
            a, b = sorted(int(self._model.geom_bodyid[geom]) - 1 for geom in contact.geom)
            if contact.dist < 0.0 and (a, b) not in self._left_out:
                found.add((a, b))
        return found


@dataclass(frozen=True, eq=False)
class Pinch:
    """Two pads that face each other.

    Attributes:
        q: independent joints (n_independent,).
        centre: middle (3,) between the pads, in the palm frame in m.
    """

    q: Array
    centre: Array


def pinch(hand: Hand) -> Pinch | None:
    """The posture in which two pads face each other at some 20 mm, with the least motion.

    Pads are the regions of last links that are caps; None where no two can face each other without links that
    meet.
    """
    pads = [_pad(hand, i) for i in leaf_links(hand)]
    found = [_try_pinch(hand, a, b) for a, b in combinations([pad for pad in pads if pad], 2)]
    touching = SelfContact(hand)
    good = [entry for entry in found if entry is not None and not touching.pairs(entry[1].q)]
    return min(good, key=lambda entry: entry[0])[1] if good else None


def _pad(hand: Hand, link: int) -> HandRegion | None:
    own = [r for r in hand.regions.values() if r.link == link and isinstance(r.region, Cap)]
    return min(own, key=lambda region: region.name, default=None)


def _try_pinch(hand: Hand, a: HandRegion, b: HandRegion) -> tuple[float, Pinch] | None:
    """Cost and posture, or None where the two don't come to face each other."""
    start, lower, upper = open_posture(hand), *hand.limits.T
    # Spreading is dear: it brings fingers together.
    ease = np.where(_bending(hand) == 0.0, _SPREADING, _EASE)

    def places(q: Array) -> tuple[Array, Array, Array, Array]:
        Ts = forward_kinematics(hand, hand.expand(q))
        (p1, n1), (p2, n2) = (_point_and_normal(pad, Ts[pad.link]) for pad in (a, b))
        return p1, n1, p2, n2

    def misfit(q: Array) -> Array:
        p1, n1, p2, n2 = places(q)
        return np.concatenate([(p2 - p1 - _PINCH_GAP_M * n1) / _LENGTH_M, n1 + n2])

    def residuals(q: Array) -> Array:
        return np.concatenate([misfit(q), ease * (q - start)])

    free = upper - lower > 1e-9
    bounds = lower - 1e-9 * ~free, upper + 1e-9 * ~free
    found = least_squares(residuals, np.clip(start, *bounds), bounds=bounds)
    if np.linalg.norm(misfit(found.x)) > 0.5:
        return None
    q = np.clip(found.x, lower, upper)
    p1, _, p2, _ = places(q)
    return float(found.cost), Pinch(q, 0.5 * (p1 + p2))


def _point_and_normal(pad: HandRegion, T: Array) -> tuple[Array, Array]:
    cap = pad.region
    assert isinstance(cap, Cap)
    normal = T[:3, :3] @ cap.axis
    return T[:3, :3] @ cap.centre + T[:3, 3] + cap.radius * normal, normal
