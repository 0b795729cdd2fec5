"""The lift: squeeze without gravity, then gravity in each direction, and see whether the object stays.

What is simulated: MuJoCo, with elliptic friction cones, soft-finger contacts (`condim` 4), `impratio` and the
no-slip solver. MuJoCo's contacts never stick: they creep. For a pinched 100 g box at friction 0.6 that is
4.7 mm/s with MuJoCo's defaults, 0.19 mm/s with elliptic cones and impratio 10, and below 1 um/s with no-slip
passes on top, so that a slip of 5 mm means that the grasp really gives way. What is at rest stays at
rest: a direction, and the time in which a squeeze settles, end as soon as the object has come to rest.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...objects import LiftTest
from ...solver import Configuration
from ..model import Burden, Grasp, compiled_model, payload
from ..settings import Direction, HoldSettings
from .checks import trial_settings
from .contact_loss import kept_contacts
from .motion import CREEPS_ON, LOOK_EVERY, SWINGS, SWINGS_OF_TRIAL, Motion, MotionWatch
from .outcome import Outcome
from .placement import Placement
from .result import DirectionResult, HoldResult, Squeezed, UsualSqueeze
from .simulation import Simulation
from .squeezing import Squeezing

__all__ = ["Lift", "lift_outcome", "shared_lift", "started_lift"]

# Once an object has gone this many times too far, it won't come back and the rest of the time is spared.
_LOST = 4.0
# Where the verdict alone counts, it is looked for once in so many samples, and said after so many at the
# earliest.
_LOOK_FOR_VERDICT, _FIRST_VERDICT = 2, 8
# Where MuJoCo's coefficients of geoms and of pairs of geoms have the one against spin.
_SPIN, _PAIR_SPIN = 1, 2


class Lift:
    """A grasp in MuJoCo, from the pregrasp on; `squeeze` comes first, then any number of `hold`.

    Fingers close once, and the usual squeeze is made once, however often it is asked for: tests of the same
    grasp may share a lift, and find the same bits as with one of their own.

    Args:
        grasp: the grasp.
        settings: what to assume.
        placement: where the object is; None for where the grasp has it.
        burden: what its mass is; None for as planned.
        usual: the squeeze as another lift has made it that was given the same; None makes it.
        closed: the hand closed on the object, of a lift that differs in its numerical settings alone, or, as
            `closed_freely`, in its squeeze; None closes it.
    """

    def __init__(
        self,
        grasp: Grasp,
        settings: HoldSettings,
        placement: Placement | None = None,
        burden: Burden | None = None,
        *,
        usual: UsualSqueeze | None = None,
        closed: Array | None = None,
    ):
        self._grasp = grasp
        self._settings = settings
        configuration = grasp.configuration
        model = compiled_model(configuration.task, settings, grasp.squeeze.pads, burden=burden)
        self._simulation = Simulation(model, configuration, settings)
        self._watch = MotionWatch(settings, _watched_points(configuration, settings))
        self._penetration_m = self._simulation.penetration_m()
        self._squeezing = Squeezing(
            grasp, settings, self._simulation, self._watch, placement, usual=usual, closed=closed
        )
        self._squeezed = Squeezed(self._simulation.full_state(), self._squeezing.start_pose)

    @property
    def simulation(self) -> Simulation:
        """Where it happens."""
        return self._simulation

    @property
    def squeezing(self) -> Squeezing:
        """How squeezes are made."""
        return self._squeezing

    def squeeze(
        self,
        *,
        first: NDArray[np.bool_] | None = None,
        supported: bool = False,
        for_verdict: bool = False,
    ) -> None:
        """Closes the fingers, moves the servos' targets to the squeeze, and lets the hand come to rest.

        Args:
            first: which joints (n_independent,) go to their targets in the first half of the time, the others
                in the second; None lets all go together.
            supported: whether gravity, where it acts in the squeeze, grows in that second half alone:
                something else carries the object until then.
            for_verdict: whether nothing but verdicts is asked for after a squeeze with all together: it then
                ends, too, once it is plain where the object stays.

        A squeeze in which some joints go first ends, for it is a trial, as soon as it is plain whether the
        object stays in its place; on the way, too, once it is so far off that it is lost.
        """
        if first is None:
            self._squeezed = self._squeezing.usual(until_known=for_verdict).squeezed
        else:
            self._squeezed = self._squeezing.one_first(first, supported=supported)

    def squeezes_firmly(self, share: float = 1.0) -> bool:
        """Whether the grasp fits and its squeeze, with all joints together, hardly moves the object.

        The squeeze is then the last one; else it ends once that is plain.

        Args:
            share: of how far a firm squeeze may move it, for one that has to leave room.
        """
        made = self._squeezing.usual_if_firm()
        if made is None:
            return False
        self._squeezed = made.squeezed
        result = self.result([])
        return result.held and result.squeezed_within(share)

    def squeeze_partly(self, share: float) -> None:
        """The usual squeeze up to a share of its way, where the servos' targets stop.

        What is passed on the way is known from the usual squeeze. Gravity, where it acts in the squeeze, then
        goes on to grow.

        Args:
            share: of the way from the grasp to the squeeze, in (0, 1].
        """
        self._squeezed = self._squeezing.partly(share)

    @property
    def squeezed(self) -> Squeezed:
        """Where the last squeeze has left hand and object."""
        return self._squeezed

    def go_back(self, squeezed: Squeezed) -> None:
        """Makes an earlier squeeze of this lift the last one again."""
        self._squeezed = squeezed

    @contextmanager
    def less_spin(self, share: float) -> Iterator[None]:
        """While it lasts, contacts resist spin with a share of their usual friction; the squeeze stays."""
        model = self._simulation.model
        frictions = model.geom_friction[:, _SPIN], model.pair_friction[:, _PAIR_SPIN]
        usual = [friction.copy() for friction in frictions]
        for friction in frictions:
            friction *= share
        try:
            yield
        finally:
            for friction, before in zip(frictions, usual, strict=True):
                friction[:] = before

    def hold(self, direction: Direction, load: float = 1.0, *, while_held: bool = False) -> DirectionResult:
        """Lets `load` times gravity act along `direction`, starting from the squeezed state.

        Args:
            direction: of gravity, in the palm frame.
            load: how many times gravity.
            while_held: whether to end at the limits, not where the object is lost: the verdict is the same.
        """
        settings, simulation = self._settings, self._simulation
        simulation.restore(self._squeezed.state)
        warnings = simulation.warnings()
        simulation.model.opt.gravity[:] = load * settings.gravity * np.array(direction)
        stride, times = simulation.steps(settings.sample_s), 1.0 if while_held else _LOST
        qpos = [simulation.data.qpos.copy()]
        for k in range(1, round(settings.hold_s / settings.sample_s) + 1):
            simulation.step(stride)
            qpos.append(simulation.data.qpos.copy())
            is_lost = k % LOOK_EVERY == 0 and self._watch.is_lost(self._moved(qpos[-1]), times)
            if is_lost or self._is_at_rest(qpos):
                break
        return self._judged(direction, np.array(qpos), simulation.warnings() == warnings, while_held)

    def holds(self, direction: Direction, load: float = 1.0) -> bool:
        """What `hold` says of being held, and nothing else: it ends as soon as that is known."""
        return self.holds_at(direction, load)[0]

    def holds_at(self, direction: Direction, load: float = 1.0) -> tuple[bool, float, float]:
        """`holds`, with the slip in m and the rotation in rad once that is known."""
        if not self._squeezed.is_stable:
            return False, np.nan, np.nan
        settings, simulation = self._settings, self._simulation
        simulation.restore(self._squeezed.state)
        warnings = simulation.warnings()
        simulation.model.opt.gravity[:] = load * settings.gravity * np.array(direction)
        stride = simulation.steps(settings.sample_s)
        poses, moved = [self._simulation.floating_pose()], Motion(0.0, 0.0)
        samples, forces = round(settings.hold_s / settings.sample_s), np.zeros(0)
        for k in range(1, samples + 1):
            simulation.step(stride)
            poses.append(self._simulation.floating_pose())
            moved = self._moved(poses[-1])
            if self._watch.is_lost(moved):
                return False, *moved
            if k % _LOOK_FOR_VERDICT == 0 and k >= _FIRST_VERDICT - _LOOK_FOR_VERDICT:
                lately = self._watch.lately(poses, SWINGS_OF_TRIAL)
                if lately is None:
                    continue
                before, forces = forces, simulation.normal_forces_of_last_step()
                if k < _FIRST_VERDICT:
                    continue
                looks = CREEPS_ON * (samples - k) / _LOOK_FOR_VERDICT
                touch = bool((forces > 0.0).all())
                keep = bool((forces + looks * np.minimum(forces - before, 0.0) > 0.0).all())
                left_s = (samples - k) * settings.sample_s
                rests = touch and self._watch.is_slow(lately)
                if rests or (keep and self._watch.will_stay(moved, lately, left_s)):
                    return simulation.warnings() == warnings, *moved
        if simulation.warnings() != warnings:
            return False, *moved
        return lift_outcome(settings, 0.0, 0.0, self._kept_contacts()) is Outcome.HELD, *moved

    def keeps_place(self) -> bool:
        """Whether the grasp fits and the squeeze has left the object in its place, as `result` has it."""
        return self.result([]).held

    def result(self, directions: list[DirectionResult]) -> HoldResult:
        """The whole result, once every direction is done."""
        self._simulation.restore(self._squeezed.state)
        # Forces depend on gravity, which a direction has left as it was there.
        self._simulation.model.opt.gravity[:] = self._squeezing.resting_gravity
        moved = self._watch.motion(self._simulation.floating_pose(), self._squeezing.start_pose)
        squeezed_qpos = self._simulation.data.qpos.copy()
        return HoldResult(
            settings=self._settings,
            squeeze_slip_m=moved.slip_m,
            squeeze_rotation_rad=moved.rotation_rad,
            squeezed_qpos=squeezed_qpos,
            squeezed_normals_N=self._simulation.normal_forces(),
            directions=tuple(directions),
            penetration_m=self._penetration_m,
            gap_m=self._grasp.gap_m,
            usual=self._squeezing.made,
        )

    def squeezed_elsewhere(self, qpos: Array, qvel: Array) -> None:
        """Takes where another engine has left the usual squeeze for the last one.

        Args:
            qpos: positions (nq,), all finite.
            qvel: velocities (nv,).
        """
        self._squeezed = self._squeezing.elsewhere(qpos, qvel)

    def held_elsewhere(
        self, direction: Direction, path: Array, qvel: Array, load: float = 1.0
    ) -> DirectionResult:
        """What `hold` says of a motion that another engine has made, from the squeezed state on.

        Contacts that carry no force where it ended have the time to come back here.

        Args:
            direction: of gravity, in the palm frame.
            path: (k, nq) positions of the samples, the squeezed state's first.
            qvel: (nv,) velocities at the last of them.
            load: how many times gravity.
        """
        simulation = self._simulation
        simulation.restore(self._squeezed.state)
        simulation.model.opt.gravity[:] = load * self._settings.gravity * np.array(direction)
        is_finite = bool(np.isfinite(path).all() and np.isfinite(qvel).all())
        if is_finite:
            simulation.take(path[-1], qvel, self._grasp.squeeze.targets)
        return self._judged(direction, path, is_finite, False)

    def has_ended(self, path: Array) -> bool:
        """Whether a motion (k, nq) since the squeeze is at rest or lost, whatever touches."""
        watch, lately = self._watch, self._watch.lately(path, SWINGS)
        is_lost = watch.is_lost(self._moved(path[-1]), _LOST)
        return is_lost or (lately is not None and watch.is_slow(lately))

    def has_settled(self, path: Array) -> bool:
        """Whether the object has come to rest in the hand after a squeeze, by samples (k, nq)."""
        lately = self._watch.lately(path, SWINGS)
        return lately is not None and self._watch.is_slow(lately)

    def _judged(
        self, direction: Direction, path: Array, is_stable: bool, while_held: bool
    ) -> DirectionResult:
        """How a direction has ended, the simulation being where its path (k, nq) ends."""
        settings, simulation = self._settings, self._simulation
        slip, rotation = self._watch.curves(path, self._squeezed.pose)
        farthest = Motion(float(slip.max()), float(rotation.max()))
        is_known = while_held and not self._watch.is_within(farthest)
        warnings = simulation.warnings()
        touching = self._kept_contacts(wait=not is_known)
        is_stable = is_stable and self._squeezed.is_stable and simulation.warnings() == warnings
        is_stable = is_stable and bool(np.isfinite(path).all())
        outcome = Outcome.UNSTABLE
        if is_stable:
            outcome = lift_outcome(settings, *farthest, touching)
        return DirectionResult(
            gravity=direction,
            outcome=outcome,
            slip_m=farthest.slip_m,
            rotation_rad=farthest.rotation_rad,
            touching=touching,
            times_s=settings.timestep_s
            * simulation.steps(settings.sample_s)
            * np.arange(len(slip), dtype=float),
            slip_curve_m=slip,
            rotation_curve_rad=rotation,
            qpos=path,
        )

    def _kept_contacts(self, *, wait: bool = True) -> tuple[bool, ...]:
        return kept_contacts(self._simulation, wait=wait and self._settings.must_touch != "none")

    def _moved(self, qpos: Array) -> Motion:
        """The object's motion since the squeeze."""
        return self._watch.motion(qpos, self._squeezed.pose)

    def _is_at_rest(self, qpos: list[Array]) -> bool:
        """Whether the object has moved within the budget of creep in the last `rest_s`, all touching."""
        lately = self._watch.lately(qpos, SWINGS)
        return lately is not None and self._watch.is_slow(lately) and self._simulation.all_touch()


def _watched_points(configuration: Configuration, settings: HoldSettings) -> Array:
    """Points (n, 3) of the object, in its frame, whose displacement is the slip."""
    if settings.slip_of == "centre":
        return payload(configuration.task, settings).inertia.centre[None]
    R, p = configuration.state.R_palm_object, configuration.state.p_palm_object
    return np.array([R.T @ (point.p_object - p) for point in configuration.contact_points])


def lift_outcome(
    settings: HoldSettings, slip_m: float, rotation_rad: float, touching: tuple[bool, ...]
) -> Outcome:
    """How a lift has ended in which the simulation did not break down.

    Args:
        settings: limits, and which contacts must touch.
        slip_m: largest slip.
        rotation_rad: largest rotation of the object.
        touching: whether each contact of the task still carries force.
    """
    if slip_m >= settings.slip_limit_m:
        return Outcome.SLIPPED
    if settings.rotation_limit_rad is not None and rotation_rad >= settings.rotation_limit_rad:
        return Outcome.ROTATED
    kept = {"all": all(touching), "any": any(touching), "none": True}[settings.must_touch]
    return Outcome.HELD if kept else Outcome.LET_GO


def started_lift(grasp: Grasp, settings: HoldSettings, lift: Lift | None = None) -> Lift:
    """The lift that a test goes on with, its usual squeeze made: the one that is given, or a new one."""
    lift = lift or Lift(grasp, settings)
    lift.squeeze()
    return lift


def shared_lift(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    usual: UsualSqueeze | None = None,
    other: Lift | None = None,
) -> Lift | None:
    """A lift to hand to tests of this grasp with these settings; None where the task is no lift.

    The fingers then close once, and the usual squeeze is made once. What tests find is the same to the bit.

    Args:
        grasp: the grasp.
        settings: of the tests; None takes what the squeeze was planned for.
        usual: the squeeze, where a test of this grasp with these settings has made it; None makes it.
        other: of the same configuration and approach with these settings and another squeeze. Where its hand
            closes freely, it is not closed anew.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return None
    return Lift(grasp, settings, usual=usual, closed=None if other is None else other.squeezing.closed_freely)
