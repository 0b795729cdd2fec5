"""Which joints of a hand move one finger, and what that finger is called."""

from itertools import takewhile

import numpy as np
from numpy.typing import NDArray

from .hand import Hand

__all__ = ["finger_joints"]


def finger_joints(hand: Hand) -> dict[str, NDArray[np.int64]]:
    """The independent joints of each finger, as indices into a reduced joint vector, by the finger's name.

    A finger is a branch of links on the palm. Branches that one joint moves, as it does both jaws of a
    gripper, are one finger. Its name is what the names of its moving links have in common, or that of its
    last link.
    """
    branches = _branches(hand)
    moved = [_moved(hand, branches, j) for j in range(len(hand.independent))]
    groups: list[set[int]] = []
    for branch_set in moved:
        joined = [group for group in groups if group & branch_set]
        groups = [group for group in groups if not group & branch_set]
        groups.append(branch_set.union(*joined))
    found: dict[str, NDArray[np.int64]] = {}
    for group in sorted(groups, key=min):
        joints = [j for j, branch_set in enumerate(moved) if branch_set <= group]
        links = [i for i, branch in enumerate(branches) if branch in group and hand.tree.moves[i].any()]
        name = _name([hand.links[i].name for i in links])
        while name in found:
            name += "_"
        found[name] = np.array(joints, dtype=np.int64)
    return found


def _branches(hand: Hand) -> list[int]:
    """For each link, the link next to the palm on its way there; -1 for the palm."""
    branches = [-1]
    for i, link in enumerate(hand.links[1:], start=1):
        branches.append(i if link.parent == 0 else branches[link.parent])
    return branches


def _moved(hand: Hand, branches: list[int], joint: int) -> set[int]:
    """The branches that an independent joint moves, by its own axis or by those coupled to it."""
    axes = hand.coupling_matrix[:, joint] != 0.0
    links = np.flatnonzero(hand.tree.moves[:, axes].any(axis=1))
    return {branches[i] for i in links}


def _name(links: list[str]) -> str:
    same = takewhile(lambda letters: len(set(letters)) == 1, zip(*links, strict=False))
    common = "".join(letters[0] for letters in same)
    return common.rstrip("_-./0123456789 ") or links[-1]
