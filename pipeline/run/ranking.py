"""Which grasp of a run is the best."""

from ..records import GraspRecord

__all__ = ["number", "rank"]


def number(grasp: GraspRecord) -> int:
    """The grasp's place in the order in which they were found, from 1."""
    return int(grasp.id.removeprefix("g"))


def rank(grasp: GraspRecord) -> tuple[bool, bool, bool, bool, int, float, float, int]:
    """Sorts the best first: good, held, not narrowly, reachable, then by directions, slip and clearance."""
    held = grasp.hold.held_count if grasp.hold else 0
    slip = grasp.hold.slip if grasp.hold and grasp.hold.slip is not None else float("inf")
    clearance = grasp.clearance.after if grasp.clearance else float("-inf")
    passed = not grasp.is_good, not grasp.is_held, grasp.is_narrow, grasp.is_unreachable
    return *passed, -held, slip, -clearance, number(grasp)
