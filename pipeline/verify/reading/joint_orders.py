"""The orders in which files list joints without naming them."""

import re
from collections.abc import Callable, Sequence

import numpy as np

from ....base.numeric.arrays import Indices
from ....hands import Hand, finger_joints

__all__ = ["HAND_ORDER", "are_a_pair", "joint_orders"]

HAND_ORDER = "hand"
"""The name of the order in which the hand itself has its joints."""

# Files of hands with so many joints may have those of a wrist ahead of them, so many.
_WRIST, _MANY = 2, 8


def joint_orders(hand: Hand, count: int) -> dict[str, Indices]:
    """The joints that arrays of so many values may stand for, by the name of the order; no two alike.

    Each is an array (k,) of indices into the hand's joint vector: what value i of the file belongs to, -1 for
    a value that belongs to none, as those of a wrist that the hand lacks.

    The orders are those in use: that of the model, fingers with the thumb first or last or in reverse, each
    finger from its tip, names in alphabetical order or by their numbers, and the joints next to the palm
    first, as simulators have them that number link by link or level by level.
    """
    every = list(range(len(hand.axes)))
    independent = hand.independent.tolist()
    if count == len(independent):
        chosen, missing = independent, 0
    elif count == len(every) or (0 < count - len(every) <= _WRIST and len(every) >= _MANY):
        chosen, missing = every, count - len(every)
    elif count == 1 and len(independent) == 2 and are_a_pair(hand, *independent):
        return {HAND_ORDER: np.array(independent[:1], dtype=np.int64)}
    else:
        return {}
    found: dict[str, Indices] = {}
    for name, order in _orders(hand).items():
        joints = np.array([-1] * missing + [j for j in order if j in set(chosen)], dtype=np.int64)
        if not any(np.array_equal(joints, other) for other in found.values()):
            found[name] = joints
    return found


def are_a_pair(hand: Hand, j: int, k: int) -> bool:
    """Whether two joints slide alike, as the jaws of a gripper do which models often give a joint each."""
    a, b = hand.axes[j], hand.axes[k]
    return a.kind == b.kind == "prismatic" and (a.lower, a.upper) == (b.lower, b.upper)


def _orders(hand: Hand) -> dict[str, list[int]]:
    """Orders of all joints."""
    own = list(range(len(hand.axes)))
    names = hand.joint_names
    groups = _by_finger(hand)
    thumb = _thumb(hand, groups)
    others = [group for k, group in enumerate(groups) if k != thumb]
    orders = {HAND_ORDER: own}
    if thumb is not None:
        orders["thumb_first"] = _joined([groups[thumb], *others])
        orders["thumb_last"] = _joined([*others, groups[thumb]])
        orders["thumb_first_reversed"] = _joined([groups[thumb], *others[::-1]])
        orders["thumb_last_reversed"] = _joined([*others[::-1], groups[thumb]])
    orders["fingers_reversed"] = _joined(groups[::-1])
    orders["from_tips"] = _joined([group[::-1] for group in groups])
    orders["alphabetical"] = _sorted(own, lambda j: names[j])
    orders["numbered"] = _sorted(own, lambda j: [int(n) for n in re.findall(r"\d+", names[j])])
    depth = _depths(hand)
    orders["by_level"] = _sorted(own, lambda j: depth[j])
    orders["by_name_of_finger"] = _joined(sorted(groups, key=lambda group: names[group[0]]))
    return orders


def _joined(groups: Sequence[Sequence[int]]) -> list[int]:
    return [j for group in groups for j in group]


def _sorted(joints: list[int], key: Callable[[int], object]) -> list[int]:
    return sorted(joints, key=key)  # type: ignore[arg-type]


def _by_finger(hand: Hand) -> list[list[int]]:
    """All joints by the finger that they move, coupled ones with the joint that drives them."""
    groups = []
    for independent in finger_joints(hand).values():
        driven = np.abs(hand.coupling_matrix[:, independent]).sum(axis=1) > 0.0
        groups.append(np.flatnonzero(driven).tolist())
    return sorted(groups)


def _thumb(hand: Hand, groups: list[list[int]]) -> int | None:
    """Which of the fingers is the thumb, by the names of regions, links and joints."""
    links = {region.link for name, region in hand.regions.items() if name.startswith("thumb/")}
    for k, group in enumerate(groups):
        moved = {int(i) for i in np.flatnonzero(hand.tree.moves[:, group].any(axis=1))}
        if links & moved or any("thumb" in hand.joint_names[j].lower() for j in group):
            return k
    return None


def _depths(hand: Hand) -> list[int]:
    """How many joints lie between each one and the palm."""
    depths = []
    above: list[int] = []
    for link in hand.links:
        depth = above[link.parent] if link.parent >= 0 else 0
        for _ in link.axes:
            depths.append(depth)
            depth += 1
        above.append(depth)
    return depths
