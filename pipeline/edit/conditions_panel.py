"""Controls of the editor's page for what a task asks besides its contacts: limits, test and support."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...objects import LiftTest, PhysicalTest, PressTest, sphere
from .conditions import SIDES, support_on, turn_about
from .draft import Draft

__all__ = ["ConditionsPanel"]

_AS_OPENED, _NOTHING = "as opened", "nothing"
_LIFT, _LIFT_ALL_ROUND, _PRESS = "lift, gravity in 6 directions", "lift, gravity in 26 directions", "press"
_TURN = "turn"
_FIRST_FORCE_N, _MOST_FORCE_N = 5.0, 50.0
_FIRST_TORQUE_NM, _MOST_TORQUE_NM = 0.05, 2.0
_FIRST_ANGLE_DEG, _MOST_ANGLE_DEG = 15.0, 90.0


class ConditionsPanel:
    """The controls; each turns into a change of the draft.

    Args:
        gui: of viser's server.
        draft: what is edited.
        doing: makes a callback of a change that says what came of it.
    """

    def __init__(self, gui: Any, draft: Draft, doing: Callable[[Callable[[], str | None]], Any]):
        self._draft = draft
        self._opened = draft.test, draft.support
        with gui.add_folder("Conditions", expand_by_default=False):
            self._joint = gui.add_dropdown("joint", list(draft.hand.independent_names))
            self._limits = gui.add_multi_slider("limits", 0.0, 1.0, 0.01, (0.0, 1.0))
            tests = [_LIFT, _LIFT_ALL_ROUND, _PRESS, _TURN]
            is_new = draft.test == LiftTest()
            self._test = gui.add_dropdown("test", tests if is_new else [_AS_OPENED, *tests])
            self._force = gui.add_slider("force/N", 1.0, _MOST_FORCE_N, 0.5, _FIRST_FORCE_N)
            self._axis = gui.add_dropdown("turns about", list(SIDES), initial_value="+z")
            self._torque = gui.add_slider("friction/N m", 0.01, _MOST_TORQUE_NM, 0.01, _FIRST_TORQUE_NM)
            self._angle = gui.add_slider("turn/deg", 1.0, _MOST_ANGLE_DEG, 1.0, _FIRST_ANGLE_DEG)
            supports = [_NOTHING, *SIDES]
            self._support = gui.add_dropdown(
                "stands on", supports if draft.support is None else [_AS_OPENED, *supports]
            )
        self._show_limits()
        self._joint.on_update(doing(self._show_limits))
        self._limits.on_update(doing(self._limit))
        self._test.on_update(doing(self._choose_test))
        for control in (self._force, self._axis, self._torque, self._angle):
            control.on_update(doing(self._choose_test))
        self._support.on_update(doing(self._choose_support))

    @property
    def _number(self) -> int:
        return self._draft.hand.independent_names.index(self._joint.value)

    @property
    def _unit(self) -> tuple[float, str]:
        """How many of the shown units are in one of the joint's own (rad or m), and their name."""
        joint = self._draft.hand.axes[self._draft.hand.independent[self._number]]
        return (float(np.rad2deg(1.0)), "deg") if joint.kind == "revolute" else (1e3, "mm")

    def _show_limits(self) -> None:
        """Shows the limits of the chosen joint, within the hand's own."""
        factor, unit = self._unit
        own = factor * self._draft.hand.limits[self._number]
        self._limits.label = f"limits/{unit}"
        # Ends of the track first, for a value outside is refused.
        self._limits.min, self._limits.max = min(self._limits.min, own[0]), max(self._limits.max, own[1])
        self._limits.value = tuple((factor * self._draft.limits[self._number]).tolist())
        self._limits.min, self._limits.max = float(own[0]), float(own[1])
        self._limits.step = float(max(own[1] - own[0], 1e-6) / 200.0)

    def _limit(self) -> str | None:
        factor, unit = self._unit
        before = factor * self._draft.limits[self._number]
        lower, upper = (float(end) for end in self._limits.value)
        if np.abs(before - (lower, upper)).max() < 1e-9:
            return None  # the page itself has shown them
        self._draft.limit(self._joint.value, lower / factor, upper / factor)
        return f"{self._joint.value} keeps to {lower:.4g} .. {upper:.4g} {unit}."

    def _choose_test(self) -> str:
        return f"Tested by: {self._draft.choose_test(self._chosen_test())}."

    def _chosen_test(self) -> PhysicalTest:
        match self._test.value:
            case chosen if chosen == _LIFT:
                return LiftTest()
            case chosen if chosen == _LIFT_ALL_ROUND:
                return LiftTest(directions=sphere())
            case chosen if chosen == _PRESS:
                return PressTest((), float(self._force.value))
            case chosen if chosen == _TURN:
                torque_Nm, angle_deg = float(self._torque.value), float(self._angle.value)
                return turn_about(self._draft.object, self._axis.value, torque_Nm, angle_deg)
        return self._opened[0]

    def _choose_support(self) -> str:
        side = self._support.value
        if side == _NOTHING:
            self._draft.choose_support(None)
            return "The object stands on nothing."
        opened = side == _AS_OPENED
        self._draft.choose_support(self._opened[1] if opened else support_on(self._draft.object.mesh, side))
        return (
            "The object stands as in the task opened." if opened else f"The object stands on its {side} side."
        )
