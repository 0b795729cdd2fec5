"""Walks through a log's tree of boxes and empties them, or says which one it can't."""

from typing import Any

import numpy as np

from ..base.numeric.arrays import Array
from .box import Box
from .log_replay import LogReplay, box_name
from .propagation import propagate, sticks_out
from .reading import Rejected, indices, items, numbers
from .relaxation import Inequalities, Planes, bound, relax
from .system import LoggedSystem

__all__ = ["Replay"]

# A box may stick out by this share from where the log says that propagation takes it: rounding differs.
_SLACK = 1e-4
# Sides of boxes that may be open at once.
_MOST_OPEN_NUMBERS = 20_000_000


class Replay(LogReplay):
    """Walks through the tree of boxes; what has been split or emptied is no longer open."""

    def __init__(self) -> None:
        super().__init__()
        self._open: dict[str, Box] = {}

    @classmethod
    def of_box(cls, system: LoggedSystem, box: Box) -> "Replay":
        """A replay of the tree below a box of a system, whose records `take` takes."""
        replay = cls()
        replay._system = system
        replay._open[""] = box
        return replay

    @property
    def is_done(self) -> bool:
        """Whether nothing is left open."""
        return not self._open

    def take(self, record: dict[str, Any]) -> None:
        """One box.

        Raises:
            Rejected: it is not open, or not shown to be empty.
        """
        self._take(record)

    def _begin(self, form: Any, expected: Any) -> None:
        if hasattr(self, "_system"):
            raise Rejected("a second system")
        if expected is not None and form != expected:
            raise Rejected("the log's system is not that of the task")
        self._system = LoggedSystem(form)
        self._open[""] = self._system.box

    def _finish(self, end: Any, digest: str) -> None:
        if not hasattr(self, "_system"):
            raise Rejected("the system is missing")
        if self._open:
            raise Rejected(
                f"{len(self._open)} boxes are left open, the first is {box_name(next(iter(self._open)))}"
            )
        if end != {"boxes": self.boxes, "steps": self.steps, "sha256": digest}:
            raise Rejected("the log was changed after it was written: its checksum or its counts differ")

    def _take(self, record: dict[str, Any]) -> None:
        """One box: its steps, and then either a split into two or nothing left."""
        path = record.get("box")
        if not isinstance(path, str) or path not in self._open:
            raise Rejected("a record is of a box that is not open")
        box = self._open.pop(path)
        try:
            self._narrow(box, items(record.get("steps")))
            if "split" in record:
                self._split(path, box, record["split"])
            elif not box.is_empty:
                propagate(self._system, box)
                if not box.is_empty:
                    raise Rejected("is not shown to be empty")
        except Rejected as reason:
            raise Rejected(f"box {box_name(path)}: {reason}") from None
        self.boxes += 1

    def _split(self, path: str, box: Box, cut: Any) -> None:
        """The halves x_k <= value and x_k >= value, which together are the whole for any value."""
        k, value = items(cut, 2)
        k, value = int(indices([k], self._system.n)[0]), float(numbers([value])[0])
        if len(self._open) * self._system.n > _MOST_OPEN_NUMBERS:
            raise Rejected("more boxes are open than fit into memory")
        left, right = box, box.copy()
        left.upper[k] = min(left.upper[k], value)
        right.lower[k] = max(right.lower[k], value)
        self._open[path + "0"], self._open[path + "1"] = left, right

    def _narrow(self, box: Box, steps: list[Any]) -> None:
        """Each step is either where the relaxation is taken, or multipliers of its rows."""
        rows: Inequalities | None = None
        for step in steps:
            self.steps += 1
            if not items(step):
                raise Rejected("a step is empty")
            kind, *content = step
            if kind == "over":
                rows = self._relax(box, content)
                continue
            if rows is None:
                raise Rejected("multipliers without a relaxation")
            if kind == "bound":
                column, end, at, values = items(content, 4)
                if end not in ("lower", "upper"):
                    raise Rejected("a bound is neither lower nor upper")
                j = int(indices([column], self._system.n)[0])
                sign = 1.0 if end == "lower" else -1.0
                proved = sign * bound(rows, _duals(rows, at, values), j, sign, box)
                side = box.lower if end == "lower" else box.upper
                side[j] = max(side[j], proved) if end == "lower" else min(side[j], proved)
            elif kind == "ray":
                at, values = items(content, 2)
                if not self._is_refuted(rows, _duals(rows, at, values), box):
                    raise Rejected("a ray does not show what it should")
                box.lower[:], box.upper[:] = np.inf, -np.inf
            else:
                raise Rejected("an unknown kind of step")

    def _is_refuted(self, rows: Inequalities, ray: Array, box: Box) -> bool:
        """Whether multipliers of the rows show that the box is empty.

        Propagation stopped where the factors were as narrow as the log says; the others may be wider than
        they were for the solver, and have to be narrowed first.
        """
        if bound(rows, ray, None, 0.0, box) > 0.0:
            return True
        propagate(self._system, box)
        return box.is_empty or bound(rows, ray, None, 0.0, box) > 0.0

    def _relax(self, box: Box, content: list[Any]) -> Inequalities:
        """The relaxation over the log's box of factors, which propagation must reach but for rounding."""
        f = self._system.factors
        *sides, planes = items(content, 3)
        lower, upper = (numbers(side, len(f)) for side in sides)
        target = box.copy()
        target.lower[f], target.upper[f] = lower, upper
        propagate(self._system, box, target)
        room = _SLACK * (1.0 + max(np.abs(lower).max(initial=0.0), np.abs(upper).max(initial=0.0)))
        if not box.is_empty and not sticks_out(self._system, box, target) <= room:
            raise Rejected("propagation does not give the box that the log says")
        # The rows are valid where the box lies within what they were made for.
        target.lower, target.upper = np.minimum(target.lower, box.lower), np.maximum(target.upper, box.upper)
        return relax(self._system, target, self._planes(planes))

    def _planes(self, data: Any) -> Planes:
        """Planes `[function, slope, slope]`."""
        planes = [items(plane, 3) for plane in items(data)]
        slopes = [numbers(plane[1:], 2) for plane in planes]
        return Planes(
            indices([plane[0] for plane in planes], self._system.n_functions),
            *np.array(slopes, dtype=np.float64).reshape(-1, 2).T,
        )


def _duals(rows: Inequalities, at: Any, values: Any) -> Array:
    """Multipliers of all rows, from the numbers of some and their values."""
    duals = np.zeros(len(rows.lower))
    where = indices(at, len(duals))
    duals[where] = numbers(values, len(where))
    return duals
