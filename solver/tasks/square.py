"""All solutions of a task where they are isolated: as many equations as inputs, with the object fixed, say.

The definitions of the task's system are put into its equations, exactly; what is left falls into parts that
share no input, such as the fingers on a fixed object. Each part is isolated as any polynomial system is, and
solutions of the task are all combinations of theirs.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from math import prod

import numpy as np

from ...base.machine.work_clock import WorkClock
from ...base.numeric.arrays import Array
from ..enclosure import StraightLineProgram
from ..interval import Interval
from ..polynomial import ExactPolynomial, PolynomialSystem, equations_in_inputs
from ..search import Verdict
from ..systems import SolutionBox, solve_system

__all__ = ["SquareSolutions", "independent_parts", "is_square", "solve_square"]

# Combinations that are listed at most; three fingers have some dozens.
_MOST_COMBINATIONS = 10_000


@dataclass(frozen=True, eq=False)
class SquareSolutions:
    """All solutions of a square system.

    Attributes:
        verdict: COMPLETE: each solution lies in exactly one of the boxes, each of which holds exactly one.
            INFEASIBLE: proved that there is none. UNDECIDED: neither.
        boxes: (lower (n,), upper (n,)) of the system's variables, of which the inputs' entries count.
        n_undecided: boxes, of parts or of their combinations, of which nothing is known.
        processed: boxes processed.
        depth: splits above the deepest box of any part.
    """

    verdict: Verdict
    boxes: tuple[Interval, ...]
    n_undecided: int = 0
    processed: int = 0
    depth: int = 0


def is_square(system: PolynomialSystem) -> bool:
    """Whether every part of the system has as many equations as inputs, all polynomials in these."""
    return (
        system.dimension == 0
        and system.is_algebraic
        and all(len(rows) == len(inputs) for rows, inputs in independent_parts(system))
    )


def independent_parts(system: PolynomialSystem) -> list[tuple[list[ExactPolynomial], list[int]]]:
    """Equations in the inputs alone, and the inputs, of each part; parts share no input."""
    equations = equations_in_inputs(system)
    parts: list[tuple[list[ExactPolynomial], set[int]]] = [([], {i}) for i in system.inputs.tolist()]
    for equation in equations:
        used = {v for monomial in equation for v, _ in monomial}
        touched = [part for part in parts if part[1] & used]
        parts = [part for part in parts if not part[1] & used]
        rows = [row for part in touched for row in part[0]]
        parts.append(([*rows, equation], set().union(*(part[1] for part in touched))))
    return [(rows, sorted(inputs)) for rows, inputs in parts]


def solve_square(
    system: PolynomialSystem,
    *,
    budget_s: float,
    workers: int = 1,
    should_stop: Callable[[], bool] | None = None,
) -> SquareSolutions:
    """All solutions of a square system within its initial box and inequalities; see `solve_system`."""
    clock = WorkClock()
    found: list[list[tuple[list[int], SolutionBox]]] = []
    undecided = processed = depth = 0
    for rows, inputs in independent_parts(system):
        numbers = {variable: k for k, variable in enumerate(inputs)}
        renamed = [
            ExactPolynomial({tuple((numbers[v], e) for v, e in monomial): c for monomial, c in row.items()})
            for row in rows
        ]
        part = solve_system(
            renamed, system.lower[inputs], system.upper[inputs],
            budget_s=max(budget_s - clock.seconds, 0.0), workers=workers, should_stop=should_stop,
        )  # fmt: skip
        processed += part.boxes
        depth = max(depth, part.progress.depth)
        if part.verdict is Verdict.INFEASIBLE:
            return SquareSolutions(part.verdict, (), processed=processed, depth=depth)
        undecided += len(part.remaining)
        found.append([(inputs, box) for box in part.solutions])
    verdict, boxes, undecided = _combined(system, found, undecided)
    return SquareSolutions(verdict, boxes, n_undecided=undecided, processed=processed, depth=depth)


def _combined(
    system: PolynomialSystem, found: list[list[tuple[list[int], SolutionBox]]], undecided: int
) -> tuple[Verdict, tuple[Interval, ...], int]:
    """The verdict, the combinations of the parts' solutions, and how many boxes are undecided."""
    if prod(len(part) for part in found) > _MOST_COMBINATIONS:
        return Verdict.UNDECIDED, (), undecided + 1
    test = _InequalityTest(system)
    boxes = []
    for choice in product(*found):
        lower, upper = system.lower.copy(), system.upper.copy()
        for inputs, box in choice:
            lower[inputs], upper[inputs] = box.lower, box.upper
        keeps = test.holds(lower, upper)
        if keeps:
            boxes.append((lower, upper))
        undecided += keeps is None
    if undecided:
        return Verdict.UNDECIDED, tuple(boxes), undecided
    return Verdict.COMPLETE if boxes else Verdict.INFEASIBLE, tuple(boxes), 0


class _InequalityTest:
    """Tells on which side of the inequalities a small box lies."""

    def __init__(self, system: PolynomialSystem):
        self._holds = StraightLineProgram(system)
        self._fails = StraightLineProgram(
            replace(system, inequalities=tuple(-p for p in system.inequalities))
        )

    def holds(self, lower: Array, upper: Array) -> bool | None:
        """True where every point keeps all inequalities, False where every point breaks one, else None."""
        if np.all(self._holds.enclose(lower, upper).slack_lower >= 0.0):
            return True
        return False if np.any(self._fails.enclose(lower, upper).slack_lower > 0.0) else None
