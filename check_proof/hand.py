"""That a hand reaches nothing in parts of an object's regions: what a log of statics may say of its leaves.

The hand's contacts are the system of a log of configurations, and some of its columns are the parameters of
the object's patches. With those narrowed to the part, a tree of boxes must empty it.
"""

from fractions import Fraction
from typing import Any

from .log_replay import box_name
from .reading import Rejected, indices, items
from .replay import Replay
from .system import LoggedSystem

__all__ = ["HandSystem"]


class HandSystem:
    """The contacts of a hand.

    Args:
        data: what the log's form says of it.
        n_contacts: how many contacts there are.
        is_patch: whether the region of each is one patch.

    Raises:
        Rejected: the data are no such system.
    """

    def __init__(self, data: Any, is_patch: list[bool]):
        if not isinstance(data, dict) or set(data) != {"system", "columns"}:
            raise Rejected("the hand is missing")
        self._system = LoggedSystem(data["system"])
        self._columns = [
            None if pair is None else indices(pair, self._system.n, 2).tolist()
            for pair in items(data["columns"], len(is_patch))
        ]
        if any(pair is not None and not patch for pair, patch in zip(self._columns, is_patch, strict=True)):
            raise Rejected("the hand's columns are of a region that is no patch")

    def check(self, name: str, sides: tuple[tuple[Fraction, Fraction], ...], records: Any) -> int:
        """Shows that no contacts lie in a box of the tree; the number of steps.

        Args:
            name: of the box.
            sides: of the box.
            records: path, steps and split of each box of the tree that shows it.

        Raises:
            Rejected: it is not shown.
        """
        box = self._system.box.copy()
        for i, columns in enumerate(self._columns):
            for column, (low, high) in zip(columns or [], sides[2 * i : 2 * i + 2], strict=False):
                box.lower[column] = max(box.lower[column], float(low))  # floats of the log, or 0 and 1
                box.upper[column] = min(box.upper[column], float(high))
        replay = Replay.of_box(self._system, box)
        for record in items(records):
            path, steps, cut = items(record, 3)
            replay.take({"box": path, "steps": steps} | ({} if cut is None else {"split": cut}))
        if not replay.is_done:
            raise Rejected(f"box {box_name(name)}: the hand is not shown to reach nothing in it")
        return replay.steps
