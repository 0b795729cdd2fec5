"""The links of each finger of a hand."""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from ....base.numeric.arrays import Indices
from ....hands import Hand, finger_joints

__all__ = ["finger_links"]


@lru_cache(maxsize=8)
def finger_links(hand: Hand) -> Mapping[str, Indices]:
    """Indices of the links that carry shapes, by the finger that they are part of.

    A finger is a branch of links on the palm, even where one joint moves several, as it does both jaws of a
    gripper.
    """
    branch = [-1] * len(hand.links)
    for i, link in enumerate(hand.links[1:], start=1):
        branch[i] = i if link.parent == 0 else branch[link.parent]
    fingers: dict[str, Indices] = {}
    for root in sorted(set(branch) - {-1}):
        links = [i for i, b in enumerate(branch) if b == root and hand.links[i].shapes]
        if links:
            name = _name(hand, links)
            fingers[hand.links[root].name if name in fingers else name] = np.array(links, dtype=np.int64)
    return fingers


def _name(hand: Hand, links: list[int]) -> str:
    """What the hand's regions call the finger of these links, or else its joints."""
    for name, region in hand.regions.items():
        if region.link in links and "/" in name:
            return name.split("/")[0]
    for name, joints in finger_joints(hand).items():
        if hand.tree.moves[links][:, hand.independent[joints]].any():
            return name
    return hand.links[links[0]].name
