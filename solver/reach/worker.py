"""What the search for the best grasp with a hand does with a box: statics, and then the hand's reach."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...base.numeric.arrays import Array
from ...objects import Task
from ..contacts import State
from ..proof import BoxRecord
from ..statics import Maps, RegionPoints, StaticsBox, StaticsSetup, StaticsWorker
from .climb import HandClimber
from .hand_reach import HandReach
from .objectives import Objective

__all__ = ["HandPoint", "HandSetup", "HandWorker"]

# Statics is a hundred times as fast as asking what the hand reaches: that is asked thoroughly where statics
# has nearly shown enough, to this share, or where the box is so narrow, and in passing elsewhere, once in so
# many splits: of what those between would refute their parts are refuted later.
_NEARLY, _NARROW, _EVERY = 0.05, 0.125, 4
# Local searches from a box, and boxes of the kinematic search where none lands in it.
_THOROUGHLY, _IN_PASSING = (4, 2000), (1, 100)
_MOST_ALLOWED = 2 * _THOROUGHLY[1]
# So many boxes of the hand are allowed for each box of the tree, at the beginning, and for each box that they
# refuted: where the hand reaches all that is asked, most of the time is left to statics.
_PER_BOX, _AT_FIRST, _PER_REFUTED = 8, 8000, 1000
# With fewer next to nothing is refuted.
_WORTH_ASKING = 50
# A state that costs no more than so many times what is asked for is worth a climb.
_WORTHWHILE = 1.02


@dataclass(frozen=True, eq=False)
class HandPoint:
    """A certified configuration.

    Attributes:
        cost: friction that it needs, or minus what it carries.
        q: independent joints.
        R: rotation (3, 3) of the object in the palm frame.
        p: position (3,) of the object in m.
        params: of patches.
    """

    cost: float
    q: Array
    R: Array
    p: Array
    params: Array

    @property
    def state(self) -> State:
        """The state."""
        return State(self.q, self.R, self.p, self.params)


@dataclass(frozen=True, eq=False, kw_only=True)
class HandSetup(StaticsSetup[HandPoint]):
    """A tree that refutes by statics as another does, or because the hand reaches nothing in a box.

    Attributes:
        regions: what is refuted of the regions alone.
        task: with the hand.
        objective: what configurations cost.
        sign: of the limit as a cost: 1 of friction, -1 of a load.
    """

    regions: StaticsSetup[Any]
    task: Task
    objective: Objective
    sign: float

    @property
    def shared(self) -> tuple[object, ...]:
        """The task, which holds whole meshes."""
        return (self.task,)

    @property
    def fingerprint(self) -> list[Any]:
        """That of the regions, with the hand in the problem's form."""
        return [self.problem.form, *self.regions.fingerprint]

    @property
    def point_kind(self) -> type[HandPoint]:
        """Configurations."""
        return HandPoint

    @property
    def unknown(self) -> float:
        """As of the regions."""
        return self.regions.unknown

    def worker(self) -> "HandWorker":
        """A worker."""
        return HandWorker(self)

    def urgency(self, bound: float) -> float:
        """As of the regions."""
        return self.regions.urgency(bound)

    def allowance(self, spent: int, refuted: int, processed: int) -> int:
        """The more, the more boxes were refuted by the hand."""
        earned = _AT_FIRST + _PER_BOX * processed + _PER_REFUTED * refuted
        return max(0, min(earned - spent, _MOST_ALLOWED))

    def shown(self, bounds: Sequence[float]) -> float:
        """As of the regions."""
        return replace(self.regions, limit=self.limit).shown(bounds)

    def badness(self, point: HandPoint) -> float:
        """What it costs."""
        return point.cost


class HandWorker(StaticsWorker[HandPoint]):
    """Refutes or splits boxes."""

    def __init__(self, setup: HandSetup):
        super().__init__(setup, RegionPoints(setup.problem))
        self._asked = setup
        self._regions = replace(setup.regions, limit=setup.limit).worker()
        self._reach = HandReach(setup.task)
        self._climber = HandClimber(setup.task, setup.problem, setup.objective)
        self._landed: State | None = None

    def refute(self, box: StaticsBox, maps: Maps) -> tuple[StaticsBox, bool, Array]:
        """What statics of the regions shows."""
        return self._regions.refute(box, maps)

    def out_of_reach(self, box: StaticsBox) -> list[BoxRecord] | None:
        """That no configuration has its contacts in the box; None where that isn't shown."""
        self._landed = None
        missing, limit = abs(box.bound - self._asked.limit), abs(self._asked.limit)
        is_close = missing <= _NEARLY * limit or float((box.upper - box.lower).max()) <= _NARROW
        if not is_close and len(box.path) % _EVERY:
            return None
        starts, most = _THOROUGHLY if is_close else _IN_PASSING
        # Patches have one chart, so a box is a part of them whatever its root.
        self._landed = self._reach.land(box.lower, box.upper, starts, int("1" + box.path, 2))
        if self._landed is not None or not self._reach.has_patches:
            return None
        most = min(most, self._allowed - self._hand_boxes)
        if most < _WORTH_ASKING:
            return None
        tree, taken = self._reach.refute(box.lower, box.upper, most)
        self._hand_boxes += taken
        return tree

    def points_within(self, box: StaticsBox) -> list[HandPoint]:
        """A configuration better than what is asked for, where one with contacts in the box leads there."""
        state, goal = self._landed, self._asked.sign * self._asked.limit
        worth = goal + (_WORTHWHILE - 1.0) * abs(goal)
        # Where nothing is known any configuration is worth it.
        if state is None or (goal != 0.0 and self._climber.cost(state, below=worth) >= worth):
            return []
        return self.climbed_from(state)

    def cost(self, state: State) -> float:
        """What a state costs."""
        return self._climber.cost(state)

    def climbed_from(self, state: State, *, at_last: bool = False) -> list[HandPoint]:
        """The configuration to which local search leads from a state, where it is proved."""
        configuration = self._reach.certified(self._climber.climb(state, at_last=at_last)[0])
        if configuration is None:
            return []
        there = configuration.state
        cost = self._climber.cost(there)
        return [HandPoint(cost, there.q, there.R_palm_object, there.p_palm_object, there.params)]
