"""What keeps a grasp from carrying its load by plan, and what would have to change.

Cones and balance are homogeneous: twice the forces carry twice the load. So where forces balance any load at
all, what ends the largest one is the servos, those whose rows of the linear program have multipliers (or the
normal force that a task allows); the efforts that would carry more follow by proportion. Where they balance
none, it is friction, or where the contacts are. How much friction would do is found by bisection.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...base.numeric.arrays import Array
from ...objects import TurnTest
from ...solver import Configuration
from ..directions import kind_of_test
from ..model import Squeeze, checked_settings
from ..settings import HoldSettings
from .linear_program import Optimum, largest_last
from .load_program import load_program
from .pads import contact_pads
from .statics import grasp_statics

__all__ = ["LoadLimit", "load_limit"]

_CONE_SUBDIVISIONS = 2
# Less of the load than this is none; multipliers below this share of the largest count as rounding.
_NOTHING, _SHARE = 1e-3, 1e-3
_ENOUGH = 1.0 - 1e-5
# Friction is not looked for beyond this, and to within this.
_MOST_FRICTION, _RESOLUTION = 1.5, 0.02
_LOAD = {"lift": "the weight", "turn": "the hinge's friction", "press": "the force"}


@dataclass(frozen=True)
class LoadLimit:
    """The largest load of a grasp by plan, with all of its friction.

    Attributes:
        kind: of the test.
        load_factor: multiple of the load that forces within cones and planned efforts carry.
        wanted: multiple that is planned for, above it.
        friction: coefficient that it is carried with.
        servos: independent joints whose servos limit it; none where forces balance no load at all.
        efforts: multiple of all efforts with which `wanted` would be carried; None where none would do.
        enough_friction: coefficient with which it would be carried; None where none up to 1.5 would do.
    """

    kind: str
    load_factor: float
    wanted: float
    friction: float
    servos: tuple[str, ...]
    efforts: float | None
    enough_friction: float | None

    def __str__(self) -> str:
        load = _LOAD[self.kind]
        if self.servos:
            limit = f"carries at most {self.load_factor:.2f} times {load}: servos of {_listed(self.servos)}"
        elif self.load_factor >= _NOTHING:
            limit = f"carries at most {self.load_factor:.2f} times {load}: the largest normal force"
        else:
            limit = f"forces within friction {self.friction:.2g} don't balance {load}"
        return f"{limit}; {self._remedy()}"

    def _remedy(self) -> str:
        changes = []
        if self.enough_friction is not None:
            changes.append(f"friction {self.enough_friction:.2f} (now {self.friction:.2g})")
        if self.efforts is not None:
            changes.append(f"efforts {self.efforts:.2g} times as large")
        wanted = f"carry {self.wanted:.2g} times it"
        return f"{' or '.join(changes)} would {wanted}" if changes else f"to {wanted}, it takes other regions"


def load_limit(
    configuration: Configuration, *, settings: HoldSettings | None = None, squeeze: Squeeze | None = None
) -> LoadLimit | None:
    """What keeps a squeeze from carrying the planned load; None where one does.

    Args:
        configuration: the grasp.
        settings: of the hold test.
        squeeze: its plan, whose arms of spin friction count; None takes those under a usual force.
    """
    settings = checked_settings(settings)
    task = configuration.task
    wanted = settings.planned_load if not isinstance(task.test, TurnTest) else 1.0
    friction = settings.sliding_friction(task.object)
    planned = squeeze is not None and squeeze.load_factor > 0.0
    arms_m = squeeze.spin_arms_m if squeeze is not None and planned else None
    program = _Program(configuration, settings, arms_m)
    found = program.largest(friction, wanted)
    load_factor = 0.0 if found is None else max(0.0, -found.value)
    if load_factor >= wanted * _ENOUGH:
        return None
    return LoadLimit(
        kind=kind_of_test(task),
        load_factor=load_factor,
        wanted=wanted,
        friction=friction,
        servos=_limiting(configuration, found) if found is not None and load_factor >= _NOTHING else (),
        efforts=wanted / load_factor if load_factor >= _NOTHING else None,
        enough_friction=program.enough_friction(friction, wanted),
    )


class _Program:
    """The program of the largest load of a grasp, with any friction.

    Args:
        configuration: the grasp.
        settings: of the test.
        spin_arms_m: arms (n,) of spin friction; None for those under a usual force.
    """

    def __init__(self, configuration: Configuration, settings: HoldSettings, spin_arms_m: Array | None):
        pads = contact_pads(configuration, settings)
        self._configuration, self._settings = configuration, settings
        self._spin_arms_m = pads.spin_arms_m() if spin_arms_m is None else spin_arms_m
        self._statics = grasp_statics(configuration, settings, pads.force_points())

    def largest(self, friction: float, most: float) -> Optimum | None:
        """The largest load up to `most`, negated; None where the program is not solved."""
        program = load_program(
            self._statics,
            self._configuration.task,
            self._configuration.state,
            replace(self._settings, friction=friction),
            subdivisions=_CONE_SUBDIVISIONS,
            spin_arms_m=self._spin_arms_m,
        )
        return largest_last(program.rows.A_eq, program.rows.A_ub, program.rows.b_ub, most)

    def enough_friction(self, low: float, wanted: float) -> float | None:
        """The least friction above `low` that carries a load, to within 0.02; None for none up to 1.5."""

        def carries(friction: float) -> bool:
            found = self.largest(friction, wanted)
            return found is not None and -found.value >= wanted * _ENOUGH

        high = max(_MOST_FRICTION, low)
        if not carries(high):
            return None
        while high - low > _RESOLUTION:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if carries(middle) else (middle, high)
        return high


def _limiting(configuration: Configuration, optimum: Optimum) -> tuple[str, ...]:
    """Names of the joints whose limits of effort have multipliers, the largest first."""
    names = configuration.task.hand.independent_names
    n = len(names)
    # Rows that are at most 1 come last, state by state: efforts up, efforts down, then normal forces.
    per_state = 2 * n
    if configuration.task.max_normal_force_N is not None:
        per_state += len(configuration.task.contacts)
    limits = np.abs(optimum.upper[len(optimum.upper) % per_state :]).reshape(-1, per_state)
    weights = limits[:, :n].sum(axis=0) + limits[:, n : 2 * n].sum(axis=0)
    order = np.argsort(-weights, kind="stable")
    return tuple(names[i] for i in order if weights[i] > _SHARE * max(float(limits.max()), 1e-12))


def _listed(names: tuple[str, ...], most: int = 3) -> str:
    """Names in words, the first few."""
    shown = list(names[:most])
    more = len(names) - len(shown)
    if more:
        return f"{', '.join(shown)} and {more} more"
    return " and ".join([", ".join(shown[:-1]), shown[-1]]) if len(shown) > 1 else shown[0]
