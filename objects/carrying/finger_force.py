"""How hard a finger can press, as far as the hand alone says."""

from dataclasses import dataclass
from functools import lru_cache
from math import inf

import numpy as np

from ...base.numeric.arrays import Array
from ...hands import Hand, HandRegion, jacobian_from_axes, joint_axes

__all__ = ["ANY_POSTURE", "Fingertip", "usual_fingertip", "usual_force_N"]

# Force behind a spin arm where nothing limits it: arms grow with its fourth root only.
_PRESSED_N = 30.0
_POSTURES, _SEED = 64, 0
# Share of the postures in which a finger presses less hard. Near its straight or folded ends a finger presses
# without any effort, at any force; this leaves those out.
_SHARE = 0.9

ANY_POSTURE = 0.5
"""Share of the postures with less force where a hand has the choice between contacts: that in the middle."""


@dataclass(frozen=True)
class Fingertip:
    """What a finger does where it is not known yet which one it is.

    Attributes:
        force_N: largest normal force.
        spin_arm_m: arm at which friction resists spin about the normal.
    """

    force_N: float
    spin_arm_m: float


def usual_fingertip(hand: Hand) -> Fingertip:
    """The middle one of a hand's fingertips, or of its regions, by force; its arm is that on a flat face."""
    moved = [region for region in hand.regions.values() if hand.tree.moves[region.link].any()]
    tips = [region for region in moved if region.name.endswith("/tip")] or moved
    force = float(np.median([usual_force_N(hand, region) for region in tips])) if tips else inf
    pressed = min(force, _PRESSED_N)
    return Fingertip(force, float(hand.pad.spin_arm_m(np.array([pressed]), np.zeros((1, 2)))[0]))


@lru_cache(maxsize=256)
def usual_force_N(hand: Hand, region: HandRegion, share: float = _SHARE) -> float:
    """Normal force in N that a hand presses with at a region; infinite where no joint moves its link.

    What the servos bring about along the normal in the best postures but for a tenth, of those drawn evenly
    from the joints' limits; never less than what the hand's fingertips are rated for. A palm is pressed by
    what the fingers do.

    Args:
        hand: the hand.
        region: one of its regions.
        share: of the postures in which it presses less hard.
    """
    if not hand.tree.moves[region.link].any():
        return inf
    point, normal = region.region.middle()
    rng = np.random.default_rng(_SEED)
    lower, upper = hand.limits.T
    forces = [
        _force_N(hand, region.link, point, normal, q)
        for q in rng.uniform(lower, upper, size=(_POSTURES, len(lower)))
    ]
    return max(float(np.quantile(forces, share)), hand.rated_force_N or 0.0)


def _force_N(hand: Hand, link: int, point: Array, normal: Array, q: Array) -> float:
    Ts, origins, directions = joint_axes(hand, hand.expand(q))
    T = Ts[link]
    J_p, _ = jacobian_from_axes(hand, origins, directions, link, T[:3, :3] @ point + T[:3, 3])
    efforts = np.abs(hand.coupling_matrix.T @ J_p.T @ (T[:3, :3] @ normal))
    servos = [hand.axes[i].actuator for i in hand.independent]
    largest = np.array([inf if servo is None else servo.effort for servo in servos])
    return float((largest / np.maximum(efforts, 1e-9)).min())
