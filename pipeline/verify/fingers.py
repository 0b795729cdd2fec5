"""The links of each finger of a hand."""

import numpy as np

from ...arrays import Indices
from ...hands import Hand, finger_joints

__all__ = ["finger_links"]


def finger_links(hand: Hand) -> dict[str, Indices]:
    """Indices of the links that carry shapes, by the finger that they are part of.

    A finger is a branch of links on the palm, even where one joint moves several, as it does both jaws of a
    gripper.
    """
    branch = [-1] * len(hand.links)
    for i, link in enumerate(hand.links[1:], start=1):
        branch[i] = i if link.parent == 0 else branch[link.parent]
    names = _names(hand)
    fingers = {}
    for root in sorted(set(branch) - {-1}):
        links = [i for i, b in enumerate(branch) if b == root and hand.links[i].shapes]
        if links:
            name = next((names[i] for i in links if i in names), hand.links[root].name)
            name = name if name not in fingers else hand.links[root].name
            fingers[name] = np.array(links, dtype=np.int64)
    return fingers


def _names(hand: Hand) -> dict[int, str]:
    """What the hand's regions call the finger of a link, and else its joints."""
    found: dict[int, str] = {}
    for finger, joints in finger_joints(hand).items():
        moved = np.flatnonzero(hand.tree.moves[:, hand.independent[joints]].any(axis=1))
        found |= {int(i): finger for i in moved}
    for name, region in hand.regions.items():
        if region.link > 0 and "/" in name:
            found[region.link] = name.split("/")[0]
    return found
