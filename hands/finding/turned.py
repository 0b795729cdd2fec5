"""Hinges that bend a finger the other way than the rest of the hand bends: their axes are turned round."""

import warnings
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputWarning
from ..hand import Hand
from ..kinematics import forward_kinematics
from .fingers import Finger

__all__ = ["warn_of_turned_hinges"]

# A hinge bends one way where its range is on one side of zero by so much of it, and no narrower than this.
_ASKEW, _LEAST_RAD = 0.5, np.radians(20.0)
# Cosines of directions about which two hinges bend against each other.
_AGAINST = -0.9
# So many other fingers bend alike where one is taken for turned round: of fewer it may be what opposes them.
_FEWEST_ALIKE = 3


class _Bend(NamedTuple):
    """A hinge that bends one way: its name, and about which direction (3,) in the palm frame."""

    joint: str
    about: Array


def warn_of_turned_hinges(hand: Hand, fingers: list[Finger], names: list[str], source: str) -> None:
    """Warns of hinges of a finger that bend against each other, or of all of them against other fingers.

    What most fingers do is how the hand is built; and a thumb may bend against all others.

    Args:
        hand: the hand.
        fingers: its fingers.
        names: of the fingers.
        source: the file, for the message.
    """
    bends = {name: _bends(hand, finger) for name, finger in zip(names, fingers, strict=True)}
    jointed = [name for name, own in bends.items() if len(own) > 1]
    askew = [name for name in jointed if any(_oppose(a, b) for a, b in pairwise(bends[name]))]
    if 2 * len(askew) < len(jointed):
        for name in askew:
            rest = [bend for other in bends if other not in (name, "thumb") for bend in bends[other]]
            _warn(_worst(bends[name], rest), "the rest of its finger", source)
    for name, own in bends.items():
        others = [bends[other][0] for other in bends if other not in (name, "thumb") and bends[other]]
        is_alone = len(others) >= _FEWEST_ALIKE and own and all(_oppose(own[0], other) for other in others)
        if is_alone and name not in (*askew, "thumb"):
            _warn(own[0], "all other fingers", source)


def _warn(bend: _Bend, others: str, source: str) -> None:
    said = f"bends the other way than {others}: is its axis turned round, or are its limits?"
    warnings.warn(InputWarning(source, f"joint {bend.joint}", said), stacklevel=3)


def _worst(own: list[_Bend], rest: list[_Bend]) -> _Bend:
    """Of the hinges of a finger the one that bends against most of the others, its own finger's first."""
    return min(
        own, key=lambda bend: (sum(_sense(bend, o) for o in own), sum(_sense(bend, other) for other in rest))
    )


def _sense(a: _Bend, b: _Bend) -> int:
    """1 where two hinges bend alike, -1 where they bend against each other, else 0."""
    cosine = float(a.about @ b.about)
    return int(np.sign(cosine)) if abs(cosine) > -_AGAINST else 0


def _oppose(a: _Bend, b: _Bend) -> bool:
    return _sense(a, b) < 0


def _bends(hand: Hand, finger: Finger) -> list[_Bend]:
    """The hinges of a finger that bend one way, from the palm on."""
    T = forward_kinematics(hand, hand.expand(np.clip(0.0, *hand.limits.T)))
    found, link = list[_Bend](), finger.last
    while link > 0:
        for axis in reversed(hand.links[link].axes):
            middle, width = axis.lower + axis.upper, axis.upper - axis.lower
            if axis.kind == "revolute" and width >= _LEAST_RAD and abs(middle) > _ASKEW * width:
                found.append(_Bend(axis.name, np.sign(middle) * (T[link][:3, :3] @ axis.direction)))
        link = hand.links[link].parent
    return found[::-1]
