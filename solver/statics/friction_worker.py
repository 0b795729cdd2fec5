"""What a tree for friction does with a box: up to which coefficient no forces at its points balance."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from .climb import BalancedPoint, Climber
from .power import refuted_friction
from .separation import SEPARATED, separate
from .worker import TWIST_SIZE, Maps, StaticsBox, StaticsSetup, StaticsWorker

__all__ = ["FrictionSetup", "FrictionWorker"]

# Share of a contact's weight in the nearest point that counts for splitting it though it has none.
_LEAST_WEIGHT = 0.1


@dataclass(frozen=True, eq=False, kw_only=True)
class FrictionSetup(StaticsSetup[BalancedPoint]):
    """A tree that refutes balance.

    Attributes:
        limit: coefficient at which boxes are refuted, and not looked at beyond.
        steps: where that fails, bisections for a lower one at which a box is refuted.
    """

    steps: int

    @property
    def fingerprint(self) -> list[Any]:
        """Form, steps and order."""
        return [self.problem.form, self.steps, self.order.value]

    @property
    def point_kind(self) -> type[BalancedPoint]:
        """Points that balance."""
        return BalancedPoint

    @property
    def unknown(self) -> float:
        """No friction."""
        return 0.0

    def worker(self) -> "FrictionWorker":
        """A worker."""
        return FrictionWorker(self)

    def urgency(self, bound: float) -> float:
        """Boxes of which less is refuted come first."""
        return bound

    def shown(self, bounds: Sequence[float]) -> float:
        """The friction up to which all is refuted."""
        # A box's bound is refuted below it.
        bound = min(bounds, default=np.inf)
        return float(min(max(0.0, np.nextafter(bound, -np.inf)), self.limit))

    def badness(self, point: BalancedPoint) -> float:
        """The friction that it needs."""
        return point.friction


class FrictionWorker(StaticsWorker[BalancedPoint]):
    """Refutes or splits boxes for friction.

    Attributes:
        setup: as given.
        climber: local search.
    """

    def __init__(self, setup: FrictionSetup):
        self.setup, self.climber = setup, Climber(setup.problem)
        super().__init__(setup, self.climber)

    def refute(self, box: StaticsBox, maps: Maps) -> tuple[StaticsBox, bool, Array]:
        """Raises the bound to the limit by a twist for it, or by others as far as they go."""
        problem, n = self.setup.problem, self.setup.problem.n_contacts
        arms, reaches = problem.arms[maps.owner], problem.reaches[maps.owner]
        bound, twist, goal = box.bound, box.twist, self.setup.limit
        if twist is not None:
            bound = max(bound, refuted_friction(maps.low, maps.high, arms, reaches, twist))

        def refute(friction: float) -> Array:
            """Raises the bound by a twist for this friction, if any; how much contacts count (n,)."""
            nonlocal bound, twist
            status, y, wrenches = separate(maps.middle, arms, reaches, maps.owner, friction, n)
            if status == SEPARATED:
                whole = np.rint(y / np.abs(y).max() * TWIST_SIZE)
                proved = refuted_friction(maps.low, maps.high, arms, reaches, whole)
                if proved > bound:
                    bound, twist = proved, whole
            return np.asarray(np.linalg.norm(wrenches[:, :3], axis=1))

        weights = refute(goal) if bound <= goal else np.zeros(n)
        above = goal
        for _ in range(self.setup.steps if bound <= goal else 0):
            friction = 0.5 * (bound + above)
            before = bound
            weights = refute(friction)
            above = friction if bound == before else max(above, bound)
        # The widest side, by what its contact counts for.
        counts = np.repeat(weights / max(weights.max(), 1e-12) + _LEAST_WEIGHT, 2) * self._extents(box)
        return replace(box, bound=bound, twist=twist), bound > goal, counts

    def points_within(self, box: StaticsBox) -> list[BalancedPoint]:
        """A point that needs no more friction than the limit, where the middle of the box leads to one."""
        middle = 0.5 * (box.lower + box.upper)
        if self.climber.needed_at(box.root, middle) > self.setup.limit:
            return []
        return [self.climber.climb(box.root, middle)]
