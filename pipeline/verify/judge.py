"""The judgement of one given grasp: what is measured, what is wrong, what it holds, and what lies near it."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...hands import Hand
from ...mjcf import preset_names
from ...objects import ObjectModel
from .balance import Carried, carried_multiples
from .faults import NOTHING, Fault, find_faults
from .measured import HandAtObject, Measured
from .nearby import Nearby, NearbyVerdict, find_nearby, given_configuration, main_touches, task_of
from .reading import friction_to_oppose
from .trials import PresetTrial, holds_in, try_presets

__all__ = ["Judge", "JudgeSettings", "Judged"]

# A finger farther off than this doesn't touch.
_GAP_M = 1e-3


@dataclass(frozen=True)
class JudgeSettings:
    """How much is done for each grasp.

    Attributes:
        presets: hold tests to try; none for no simulation.
        nearby: whether to look for a certified grasp near it.
        prove_s: time for the solver where the local search finds none.
    """

    presets: tuple[str, ...] = field(default_factory=preset_names)
    nearby: bool = True
    prove_s: float = 0.0


@dataclass(frozen=True, eq=False)
class Judged:
    """What is known of a grasp.

    Attributes:
        measured: contacts, depths and joints as given.
        obj: the object in the size of this grasp.
        carried: multiple of the object's weight that the fingers carry that touch, however it is turned.
        closed: the same, were all fingers that are near to touch.
        friction_needed: the least friction at which all that is near the object can press on it without
            moving it away, were it free to turn; infinite where nothing presses against anything.
        off_m: by finger that is near but doesn't touch, how far it is off; whether it should, `faults` says.
        faults: what is wrong, the gravest first.
        trials: by preset, of the grasp as it is given.
        nearby: the certified grasp near it, or why there is none; None where it was not looked for.
        nearby_trials: by preset, of that grasp.
    """

    measured: Measured
    obj: ObjectModel
    carried: float
    closed: float
    friction_needed: float
    off_m: Mapping[str, float]
    faults: tuple[Fault, ...]
    trials: Mapping[str, PresetTrial] = field(default_factory=dict)
    nearby: Nearby | None = None
    nearby_trials: Mapping[str, PresetTrial] = field(default_factory=dict)

    @property
    def is_sound(self) -> bool:
        """Whether nothing is wrong with it as it is given."""
        return not self.faults

    @property
    def fixed_holds(self) -> bool:
        """Whether a certified grasp was found near it that passes the first test that was tried."""
        if self.nearby is None or self.nearby.verdict is not NearbyVerdict.FOUND:
            return False
        return next((trial.held for trial in self.nearby_trials.values()), False)


class Judge:
    """Judges grasps of one hand at one object in its sizes.

    Args:
        hand: the hand.
        settings: how much is done.
    """

    def __init__(self, hand: Hand, settings: JudgeSettings):
        self.hand, self.settings = hand, settings
        self._at: dict[int, tuple[ObjectModel, HandAtObject]] = {}

    def judge(
        self,
        obj: ObjectModel,
        joints: Array,
        T_palm_object: Array,
        name: str,
        *,
        meant: Collection[str] | None = None,
        squeeze: Array | None = None,
        should_stop: Callable[[], bool] = lambda: False,
    ) -> Judged:
        """Judges one grasp.

        Args:
            obj: the object, in the size of this grasp.
            joints: (n_joints,) of all joints, in rad and m.
            T_palm_object: (4, 4) pose of the object in the palm frame.
            name: of the grasp, for the tasks that are made of it.
            meant: links or regions that touch by the file's own word; None where it doesn't say.
            squeeze: (n_joints,) where the file sends the servos to squeeze; None where it doesn't say.
            should_stop: asked between steps.
        """
        at = self._at_object(obj)
        given = at.measure(joints, T_palm_object)
        touching = [touch for touch in given.touches if touch.distance_m <= _GAP_M]
        carried, most = carried_multiples(self.hand, obj, given, touching)
        if carried < NOTHING:
            # Before that is said of the grasp its contacts are looked at as areas, which takes longer.
            touching = at.spread(given, touching)
            carried, most = carried_multiples(self.hand, obj, given, touching)
        closed = carried
        if len(touching) < len(given.touches):
            closed = max(carried, carried_multiples(self.hand, obj, given, given.touches)[0])
        friction_needed = friction_to_oppose(np.array([t.normal for t in given.touches]).reshape(-1, 3))
        off_m = _off(given)
        faults = find_faults(self.hand, obj, given, touching, Carried(carried, most, closed), off_m, meant)
        trials: dict[str, PresetTrial] = {}
        if self.settings.presets:
            trials = self._given_trials(obj, given, name, squeeze, should_stop)
        nearby, nearby_trials = None, dict[str, PresetTrial]()
        if self.settings.nearby:
            presets = self.settings.presets
            nearby = find_nearby(
                self.hand,
                obj,
                given,
                name,
                prove_s=self.settings.prove_s,
                holds=(lambda made: holds_in(made, presets[0])) if presets else (lambda _: True),
                should_stop=should_stop,
            )
            if nearby.grasp is not None and self.settings.presets:
                nearby_trials = try_presets(
                    nearby.grasp.configuration, self.settings.presets, should_stop=should_stop
                )
        return Judged(
            given, obj, carried, closed, friction_needed, off_m, faults, trials, nearby, nearby_trials
        )

    def _at_object(self, obj: ObjectModel) -> HandAtObject:
        if id(obj) not in self._at:
            self._at[id(obj)] = obj, HandAtObject(self.hand, obj)
        return self._at[id(obj)][1]

    def _given_trials(
        self,
        obj: ObjectModel,
        given: Measured,
        name: str,
        squeeze: Array | None,
        should_stop: Callable[[], bool],
    ) -> dict[str, PresetTrial]:
        touches = main_touches(given)
        if len(touches) < 2:
            few = PresetTrial(False, "fewer than two fingers are at the object")
            return dict.fromkeys(self.settings.presets, few)
        try:
            task = task_of(self.hand, obj, given, touches, name)
        except InputError as error:
            unfit = PresetTrial(False, f"no contacts can be laid there: {error.allowed}")
            return dict.fromkeys(self.settings.presets, unfit)
        return try_presets(
            given_configuration(task, given),
            self.settings.presets,
            targets=None if squeeze is None else squeeze[self.hand.independent],
            should_stop=should_stop,
        )


def _off(given: Measured) -> dict[str, float]:
    """How far fingers are off the object that are near and don't touch it."""
    return {
        touch.finger: touch.distance_m
        for touch in given.touches
        if touch.distance_m > _GAP_M and touch.finger != "palm"
    }
