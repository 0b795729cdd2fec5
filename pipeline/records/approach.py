"""Between approaches and their written form."""

import numpy as np

from ...hands import Hand
from ...retraction import Approach
from .grasp import Approach as ApproachRecord

__all__ = ["approach_record", "to_approach"]


def approach_record(approach: Approach, hand: Hand) -> ApproachRecord:
    """The written form of an approach."""
    names = hand.independent_names
    return ApproachRecord(
        reachable=approach.reachable,
        opening=approach.opening_m,
        blocking=approach.blocking,
        waypoints=[dict(zip(names, q.tolist(), strict=True)) for q in approach.waypoints],
    )


def to_approach(record: ApproachRecord, hand: Hand) -> Approach:
    """The approach that this process or another one has just written; it is taken on trust."""
    waypoints = np.array([[place[name] for name in hand.independent_names] for place in record.waypoints])
    return Approach(record.reachable, record.opening, waypoints, record.blocking)
