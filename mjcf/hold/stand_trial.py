"""Turns and presses: the object stands, the hand closes, squeezes, and goes on as its plan says.

Passed means: no contact of the task slides on the hand's skin by more than the limit of slip, every contact
still touches in the end (see `contact_loss`), no servo is at its limit, and

- in a turn, the parts have turned by the angle that is asked for;
- in a press, the contacts that are named press with the force that is asked for, from the squeeze to the end.

Sliding is the way of a contact's point relative to both bodies, summed over time: rolling is no sliding.

The load of a turn is the friction of its hinge, that of a press the force that is asked for.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf, nan
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...objects import PressTest, TurnTest
from ..model import Grasp, compiled_model, grasp_qpos
from ..settings import HoldSettings
from .contact_loss import kept_contacts
from .outcome import Outcome
from .placement import Placement, placed
from .result import DirectionResult, HoldResult
from .simulation import Simulation

__all__ = ["StandTrial"]

# A servo that gives this share of its largest effort is at its limit.
_AT_LIMIT = 0.999
# As long as a hinge needs less than this share of its friction, that holds it, with more of it as well.
_HOLDS_HINGE = 0.9


@dataclass(eq=False)
class _Track:
    """What is recorded while a test runs, sample by sample."""

    times_s: list[float] = field(default_factory=list)
    slid_m: list[Array] = field(default_factory=list)  # (n_contacts,) since the beginning
    angles_rad: list[float] = field(default_factory=list)
    normals_N: list[Array] = field(default_factory=list)
    efforts: list[float] = field(default_factory=list)  # largest share of a servo's limit
    qpos: list[Array] = field(default_factory=list)

    def up_to(self, count: int) -> "_Track":
        """The first samples."""
        return _Track(*(list[Any](samples[:count]) for samples in vars(self).values()))


class StandTrial:
    """A grasp in MuJoCo, of a task whose test is a turn or a press.

    Fingers close once. The same goes for what comes before the friction of a turn's hinge gives way: it holds
    the hinge alike, however large it is, so other loads go on from there.

    Args:
        grasp: the grasp, with the path of its turn.
        settings: what to assume.
        placement: where the object is; None for where the grasp has it. The stand is off with it.
        load: how many times the task's load to test with; the servos' targets stay as planned.
        closed: the hand closed on the object, as `closed` of a trial of this grasp and placement, whatever
            its numerical settings; None closes it.
    """

    def __init__(
        self,
        grasp: Grasp,
        settings: HoldSettings,
        placement: Placement | None = None,
        *,
        load: float = 1.0,
        closed: Array | None = None,
    ):
        self._grasp, self._settings = grasp, settings
        test = grasp.configuration.task.test
        assert isinstance(test, (TurnTest, PressTest))
        self._test = test
        model = compiled_model(grasp.configuration.task, settings, grasp.squeeze.pads)
        # Of the hinge, in Nm.
        self._friction = float(model.dof_frictionloss[-1]) if isinstance(test, TurnTest) else 0.0
        self._load = load
        self._simulation = Simulation(model, grasp.configuration, settings)
        self._start = placed(grasp.configuration, grasp_qpos(grasp.configuration)[-7:], placement)
        limits = self._simulation.model.actuator_forcerange
        self._limits = limits[:, 1].copy()
        self._penetration_m = self._simulation.penetration_m()
        self._closed = closed
        # Whether the simulation does not break down as the fingers close.
        self._closes = True
        self._track = _Track()
        # Where loads may go on: the state at each sample, and how much friction the hinge had needed by then.
        self._marks: list[tuple[Array, float]] = []
        # How many legs the way has to where the squeeze is over; the legs themselves.
        self._squeezed = self._legs_in(settings.squeeze_s) + self._legs_in(settings.settle_s)
        self._legs = tuple(self._way())
        # Whether to end where the test can't be passed any more.
        self._until_failed = False

    @property
    def simulation(self) -> Simulation:
        """Where it happens."""
        return self._simulation

    @property
    def closed(self) -> Array:
        """The state of all in which the hand is closed on the object, for other trials to begin in."""
        simulation = self._simulation
        if self._closed is None:
            before = simulation.warnings()
            simulation.close(self._grasp.approach.waypoints, self._start)
            self._closes = simulation.warnings() == before
            self._closed = simulation.full_state()
        return self._closed

    def holds(self, load: float | None = None) -> bool:
        """What `run` says of being held, and nothing else: it ends as soon as the test can't be passed.

        Args:
            load: of the test from now on; None leaves it as it is.
        """
        self._load = self._load if load is None else load
        self._until_failed = True
        return self.run().held

    def run(self) -> HoldResult:
        """The whole test."""
        simulation = self._simulation
        closed = self.closed
        if isinstance(self._test, TurnTest):
            simulation.model.dof_frictionloss[-1] = self._load * self._friction
        done = max((k for k in range(len(self._marks)) if self._is_common(k)), default=0)
        simulation.begin(self._grasp.configuration.state.q, self._start)
        simulation.restore(self._marks[done][0] if done else closed)
        self._track = self._track.up_to(done + 1) if done else _Track()
        self._marks = self._marks[: done + 1] if done else [(closed, 0.0)]
        if not done:
            simulation.forward()
            self._sample(0.0)
        warnings = simulation.warnings()
        for start, end, seconds in self._legs[done:]:
            if self._until_failed and self._has_failed():
                break
            simulation.drive(start, end, seconds)
            self._sample(seconds)
            self._mark()
        stable = self._closes and simulation.warnings() == warnings
        stable = stable and bool(np.isfinite(self._track.qpos[-1]).all())
        return self._result(min(self._squeezed, len(self._track.times_s) - 1), stable)

    def _mark(self) -> None:
        """Notes where loads of a turn may go on, as long as the friction of its hinge has not given way."""
        if not isinstance(self._test, TurnTest) or len(self._marks) < len(self._track.times_s) - 1:
            return
        needed = max(self._marks[-1][1], self._simulation.hinge_friction())
        if needed < _HOLDS_HINGE * self._load * self._friction:
            self._marks.append((self._simulation.full_state(), needed))

    def _is_common(self, mark: int) -> bool:
        return self._marks[mark][1] < _HOLDS_HINGE * self._load * self._friction

    def _legs_in(self, seconds: float) -> int:
        return max(1, round(seconds / self._settings.sample_s))

    def _way(self) -> Iterator[tuple[Array, Array, float]]:
        """The servos' targets sample by sample: where they are and where they go to, in so many seconds.

        First the squeeze and a rest; then along the path and a rest in a turn, in a press a rest alone.
        """
        settings, squeeze = self._settings, self._grasp.squeeze
        at = self._grasp.configuration.state.q
        stages = [(squeeze.targets, settings.squeeze_s), (squeeze.targets, settings.settle_s)]
        stages += [(targets, settings.turn_s / len(squeeze.path)) for targets in squeeze.path]
        stages.append((stages[-1][0], settings.settle_s if len(squeeze.path) else settings.hold_s))
        for end, seconds in stages:
            count = self._legs_in(seconds)
            for k in range(count):
                here, there = (at + (end - at) * share for share in (k / count, (k + 1) / count))
                yield here, there, seconds / count
            at = end

    def _has_failed(self) -> bool:
        """Whether what has been seen leaves no way to pass: slip only grows, the least force only falls."""
        track, test = self._track, self._test
        # Until the sample in which the squeeze is over, slip counts from the beginning.
        is_squeezed = len(track.times_s) > self._squeezed
        before = track.slid_m[self._squeezed] if is_squeezed else 0.0
        if (track.slid_m[-1] - before).max() >= self._settings.slip_limit_m or track.efforts[-1] >= _AT_LIMIT:
            return True
        if not is_squeezed or isinstance(test, TurnTest):
            return False
        return self._pressed_N(test, self._squeezed) < self._load * test.force_N

    def _sample(self, seconds: float) -> None:
        simulation, track = self._simulation, self._track
        normals, speeds = simulation.contact_speeds()
        before = track.slid_m[-1] if track.slid_m else np.zeros(len(normals))
        track.times_s.append((track.times_s[-1] if track.times_s else 0.0) + seconds)
        track.slid_m.append(before + speeds * seconds)
        track.normals_N.append(normals)
        track.efforts.append(float((np.abs(simulation.data.actuator_force) / self._limits).max()))
        track.angles_rad.append(float(simulation.data.qpos[-1]) if isinstance(self._test, TurnTest) else 0.0)
        joints = simulation.data.qpos[: len(self._grasp.configuration.joint_vector)]
        track.qpos.append(np.concatenate([joints, simulation.object_pose()]))

    def _result(self, squeezed: int, stable: bool) -> HoldResult:
        track = self._track
        slid = np.array(track.slid_m)
        since = (slid[squeezed:] - slid[squeezed]).max(axis=1)
        angles = np.array(track.angles_rad)
        touching = kept_contacts(self._simulation, wait=not (self._until_failed and self._has_failed()))
        entry = DirectionResult(
            gravity=(0.0, 0.0, 0.0),
            outcome=self._outcome(float(since[-1]) if stable else nan, squeezed, touching),
            slip_m=float(since[-1]),
            rotation_rad=float(angles[-1]),
            touching=touching,
            times_s=np.array(track.times_s[squeezed:]) - track.times_s[squeezed],
            slip_curve_m=since,
            rotation_curve_rad=angles[squeezed:],
            qpos=np.array(track.qpos[squeezed:]),
        )
        return HoldResult(
            settings=self._settings,
            squeeze_slip_m=float(slid[squeezed].max()),
            squeeze_rotation_rad=0.0,
            squeezed_qpos=track.qpos[squeezed],
            squeezed_normals_N=track.normals_N[squeezed],
            directions=(entry,),
            kind="turn" if isinstance(self._test, TurnTest) else "press",
            penetration_m=self._penetration_m,
            gap_m=self._grasp.gap_m,
            pressed_N=self._pressed_N(self._test, squeezed) if isinstance(self._test, PressTest) else None,
            reached=self._reached(float(angles[-1]), squeezed),
        )

    def _outcome(self, slip_m: float, squeezed: int, touching: tuple[bool, ...]) -> Outcome:
        track, test = self._track, self._test
        if not np.isfinite(slip_m):
            return Outcome.UNSTABLE
        if slip_m >= self._settings.slip_limit_m:
            return Outcome.SLIPPED
        if not all(touching):
            return Outcome.LET_GO
        if max(track.efforts) >= _AT_LIMIT:
            return Outcome.OVERLOADED
        if isinstance(test, TurnTest):
            return Outcome.HELD if track.angles_rad[-1] >= test.angle_rad else Outcome.SHORT
        asked_N = self._load * test.force_N
        return Outcome.HELD if self._pressed_N(test, squeezed) >= asked_N else Outcome.WEAK

    def _reached(self, angle_rad: float, squeezed: int) -> float:
        """Share of the angle or force asked for."""
        if isinstance(self._test, TurnTest):
            return angle_rad / self._test.angle_rad
        asked_N = self._load * self._test.force_N
        return self._pressed_N(self._test, squeezed) / asked_N if asked_N > 0.0 else inf

    def _pressed_N(self, test: PressTest, squeezed: int) -> float:
        """Least normal force since the squeeze of the contacts that must press."""
        return float(np.array(self._track.normals_N[squeezed:])[:, list(test.contacts)].min())
