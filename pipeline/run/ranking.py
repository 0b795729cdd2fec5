"""Which grasp of a run is the best, and a run's grasps in that order."""

from bisect import bisect_left

from ..records import MOST_SHOWN, GraspRecord, RunRecord

__all__ = ["in_order", "number", "rank", "with_grasp"]


def number(grasp: GraspRecord) -> int:
    """The grasp's place in the order in which they were found, from 1."""
    return int(grasp.id.removeprefix("g"))


def rank(grasp: GraspRecord) -> tuple[bool, bool, bool, bool, bool, int, float, float, float, int]:
    """Sorts the best first: good, held, not narrowly, reachable, failed narrowly before others that failed.

    Then by directions held, by what a held grasp strains least, by slip and by clearance.
    """
    strain = grasp.hold.strain if grasp.hold and grasp.hold.strain is not None else float("inf")
    held = grasp.hold.held_count if grasp.hold else 0
    slip = grasp.hold.slip if grasp.hold and grasp.hold.slip is not None else float("inf")
    clearance = grasp.clearance.after if grasp.clearance else float("-inf")
    passed = not grasp.is_good, not grasp.is_held, grasp.is_narrow, grasp.is_unreachable
    return *passed, not grasp.is_near_miss, -held, strain, slip, -clearance, number(grasp)


def in_order(record: RunRecord) -> RunRecord:
    """The record with its grasps the best first, those that are not shown without motions."""
    grasps = sorted(record.grasps, key=rank)
    shown, others = grasps[:MOST_SHOWN], grasps[MOST_SHOWN:]
    return _with(record, [*shown, *(grasp.without_motion() for grasp in others)])


def with_grasp(record: RunRecord, grasp: GraspRecord) -> RunRecord:
    """The record, whose grasps are in order, with a grasp in place of that of the same name.

    What this finds is what `in_order` would find. Sorting anew each time would make the cost of a run grow
    with the square of its grasps.
    """
    grasps = [other for other in record.grasps if other.id != grasp.id]
    place = bisect_left(grasps, rank(grasp), key=rank)
    grasps.insert(place, grasp)
    # No other than these two can have left the shown ones, or never have been among them.
    for k in {place, MOST_SHOWN}:
        if MOST_SHOWN <= k < len(grasps):
            grasps[k] = grasps[k].without_motion()
    return _with(record, grasps)


def _with(record: RunRecord, grasps: list[GraspRecord]) -> RunRecord:
    return record.model_copy(update={"grasps": grasps})
