"""Between approaches and their written form."""

from pathlib import Path

import numpy as np

from ...errors import InputError
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


def to_approach(record: ApproachRecord, hand: Hand, source: str | Path) -> Approach:
    """The approach that a file describes; whether it is clear is taken on trust.

    Raises:
        InputError: a waypoint that is none of this hand, or none at all.
    """
    names = hand.independent_names
    if not record.waypoints:
        raise InputError(source, "approach.waypoints", "must hold at least one place")
    for i, place in enumerate(record.waypoints):
        if place.keys() != set(names):
            raise InputError(
                source,
                f"approach.waypoints.{i}",
                f"must give the {len(names)} independent joints of {hand.name}",
            )
    waypoints = np.array([[place[name] for name in names] for place in record.waypoints])
    return Approach(record.reachable, record.opening, waypoints, record.blocking)
