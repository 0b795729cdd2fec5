"""The squeeze of a lift: the fingers close on the object, then servos' targets go to where they press.

Fingers close once, and the usual squeeze, with all joints together, is made once. Others go on from what is
known of it: weaker ones, and those with one finger first.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ..model import OBJECT_BODY, Grasp
from ..settings import HoldSettings
from .motion import LOOK_EVERY, SWINGS, SWINGS_OF_TRIAL, MotionWatch
from .placement import Placement, placed
from .result import Squeezed, UsualSqueeze
from .simulation import Simulation

__all__ = ["Squeezing"]

# An object that has gone so many times too far with one finger ahead won't come back; nor from so many times
# once all press.
_PUSHED_OFF, _LOST_IN_THE_END = 6.0, 2.0
# A squeeze that moves the object so many times as far as a firm one may is not firm in the end.
_NOT_FIRM = 1.5
# Of so many steps of the usual squeeze one is kept, for weaker ones to go on from.
_KEPT_EVERY = 8
# What holds the object while the fingers close brings it to rest within this time.
_VISCOUS_S = 0.01


class Squeezing:
    """Makes squeezes of a grasp in a simulation; each begins with the hand closed on the object.

    Args:
        grasp: the grasp.
        settings: what to assume.
        simulation: where it happens, things being where the grasp has them.
        watch: what is watched of the object.
        placement: where the object is; None for where the grasp has it.
        usual: the squeeze as another simulation has made it that was given the same; None makes it.
        closed: the hand closed on the object, as another simulation that may share it has found it; None
            closes it.

    Attributes:
        simulation: where it happens.
        start_pose: (7,) of the object in the palm frame before the hand closes.
    """

    def __init__(
        self,
        grasp: Grasp,
        settings: HoldSettings,
        simulation: Simulation,
        watch: MotionWatch,
        placement: Placement | None,
        *,
        usual: UsualSqueeze | None,
        closed: Array | None,
    ):
        self._grasp, self._settings, self._watch = grasp, settings, watch
        self.simulation = simulation
        self.start_pose = placed(grasp.configuration, simulation.floating_pose(), placement)
        self._usual = usual
        self._closed = closed if usual is None else usual.closed
        self._closed_freely = False
        # Whether the fingers close, and since how many warnings a squeeze is under way.
        self._closes, self._warnings = usual is None or usual.squeezed.is_stable, 0

    @property
    def resting_gravity(self) -> Array:
        """Gravity (3,) at the end of a squeeze."""
        return self._settings.gravity * np.array(self._settings.resting_direction)

    @property
    def viscous_damping(self) -> Array:
        """What (6,) dampens the object's motion while the fingers close."""
        obj = self.simulation.model.body(OBJECT_BODY)
        return np.concatenate([np.full(3, obj.mass[0]), np.full(3, obj.inertia.max())]) / _VISCOUS_S

    @property
    def closed(self) -> Array:
        """The state of all in which the hand is closed on the object."""
        if self._closed is None:
            before = self.simulation.warnings()
            self._closed_freely = self._close()
            self._closes = self.simulation.warnings() == before
            self._closed = self.simulation.full_state()
        return self._closed

    @property
    def closed_freely(self) -> Array | None:
        """`closed`, where the hand touches nothing on the way: what contacts are like didn't count then."""
        closed = self.closed
        return closed if self._closed_freely else None

    @property
    def made(self) -> UsualSqueeze | None:
        """The usual squeeze, once it was made."""
        return self._usual

    def usual(self, *, until_known: bool = False) -> UsualSqueeze:
        """The squeeze with all joints together, made once.

        Args:
            until_known: whether nothing but verdicts is asked for after it: it then ends, too, once it is
                plain where the object stays.
        """
        if self._usual is None:
            self._usual = self._made(until_known=until_known)
            assert self._usual is not None  # nothing ends it
        return self._usual

    def usual_if_firm(self) -> UsualSqueeze | None:
        """The same; None where it moves the object farther than a firm one ever does: it ends there."""
        if self._usual is None:
            self._usual = self._made(until_known=False, until=self._is_hardly_firm)
        return self._usual

    def one_first(self, first: NDArray[np.bool_], *, supported: bool) -> Squeezed:
        """A squeeze in which some joints go first; it ends as soon as it is plain whether the object stays.

        Args:
            first: which joints (n_independent,) go to their targets in the first half of the time, the others
                in the second.
            supported: whether gravity, where it acts in the squeeze, grows in that second half alone:
                something else carries the object until then.
        """
        simulation, half_s, resting = self.simulation, 0.5 * self._settings.squeeze_s, self.resting_gravity
        q, targets = self._begin_squeeze()
        between = np.where(first, targets, q)
        at_half = 0.0 * resting if supported else 0.5 * resting
        simulation.drive(q, between, half_s, gravity=at_half, until=self._is_pushed_off)
        if not self._is_pushed_off():
            simulation.drive(between, targets, half_s, gravity=resting, until=self._is_pushed_off)
        if not self._is_pushed_off(_LOST_IN_THE_END):
            self._settle(until_known=True)
        return self._here()

    def partly(self, share: float) -> Squeezed:
        """The usual squeeze up to a share of its way, where the servos' targets stop.

        What is passed on the way is known from the usual squeeze. Gravity, where it acts in the squeeze, then
        goes on to grow.

        Args:
            share: of the way from the grasp to the squeeze, in (0, 1].
        """
        usual = self.usual()
        if share == 1.0:
            return usual.squeezed
        simulation, settings, resting = self.simulation, self._settings, self.resting_gravity
        q, squeeze = self._grasp.configuration.state.q, self._grasp.squeeze
        steps = simulation.steps(settings.squeeze_s)
        kept = int(share * steps) // _KEPT_EVERY
        done = kept * _KEPT_EVERY / steps
        start, end = (q + part * (squeeze.targets - q) for part in (done, share))
        simulation.restore(usual.way[kept])
        self._watch_from(is_stable=usual.squeezed.is_stable)
        simulation.model.opt.gravity[:] = done * resting
        simulation.drive(start, end, (share - done) * settings.squeeze_s, gravity=share * resting)
        if resting.any():
            simulation.drive(end, end, (1.0 - share) * settings.squeeze_s, gravity=resting)
        self._settle(until_known=False)
        return self._here()

    def elsewhere(self, qpos: Array, qvel: Array) -> Squeezed:
        """Where another engine has left the usual squeeze.

        Args:
            qpos: positions (nq,), all finite.
            qvel: velocities (nv,).
        """
        simulation = self.simulation
        simulation.begin(self._grasp.configuration.state.q, self.start_pose)
        simulation.take(qpos, qvel, self._grasp.squeeze.targets)
        simulation.model.opt.gravity[:] = self.resting_gravity
        return Squeezed(simulation.full_state(), simulation.floating_pose())

    def _made(self, *, until_known: bool, until: Callable[[], bool] | None = None) -> UsualSqueeze | None:
        """The squeeze with all joints together; None where `until` has ended it."""
        q, targets = self._begin_squeeze()
        way = self.simulation.drive(
            q,
            targets,
            self._settings.squeeze_s,
            gravity=self.resting_gravity,
            keep_every=_KEPT_EVERY,
            until=until,
        )
        if until is not None and until():
            return None
        self._settle(until_known=until_known, until=until)
        if until is not None and until():
            return None
        return UsualSqueeze(self.closed, tuple(way), self._here())

    def _begin_squeeze(self) -> tuple[Array, Array]:
        """Puts all where the hand is closed, without gravity; servos' targets there and then."""
        self.simulation.restore(self.closed)
        self.simulation.model.opt.gravity[:] = 0.0
        self._watch_from(is_stable=self._closes)
        return self._grasp.configuration.state.q, self._grasp.squeeze.targets

    def _close(self) -> bool:
        """From the pregrasp to the grasp, the object held as by something viscous; see `Simulation.close`."""
        simulation = self.simulation
        of_object = slice(simulation.model.nv - 6, None)
        simulation.model.dof_damping[of_object] = self.viscous_damping
        is_free = simulation.close(self._grasp.approach.waypoints, self.start_pose)
        simulation.model.dof_damping[of_object] = 0.0
        return is_free

    def _settle(self, *, until_known: bool, until: Callable[[], bool] | None = None) -> None:
        """Everything left as it is for `settle_s`, or until the object has come to rest in the hand.

        Args:
            until_known: whether to end as soon as it is plain where within its limits the object stays.
            until: asked every few samples; where it says so, the rest is left out.
        """
        simulation, settings = self.simulation, self._settings
        stride, left = simulation.steps(settings.sample_s), simulation.steps(settings.settle_s)
        poses = [self.simulation.floating_pose()]
        while left > 0:
            simulation.step(min(stride, left))
            left -= stride
            poses.append(self.simulation.floating_pose())
            if until_known or (len(poses) - 1) % LOOK_EVERY == 0:
                if until is not None and until():
                    break
                lately = self._watch.lately(poses, SWINGS_OF_TRIAL if until_known else SWINGS)
                if lately is None:
                    continue
                moved = self._watch.motion(poses[-1], self.start_pose)
                if until_known and self._watch.keeps_to_its_side(moved, lately, left * settings.timestep_s):
                    break
                if self._watch.is_slow(lately) and self.simulation.all_touch():
                    break

    def _is_pushed_off(self, times: float = _PUSHED_OFF) -> bool:
        """Whether a squeeze that may end early has moved the object so far that it won't come back."""
        moved = self._watch.motion(self.simulation.floating_pose(), self.start_pose)
        return self._settings.rest_s is not None and self._watch.is_lost(moved, times)

    def _is_hardly_firm(self) -> bool:
        """Whether a squeeze that may end early has moved the object farther than a firm one ever does."""
        moved = self._watch.motion(self.simulation.floating_pose(), self.start_pose)
        most_m = _NOT_FIRM * self._settings.firm_limit_m
        return self._settings.rest_s is not None and not moved.slip_m < most_m

    def _watch_from(self, *, is_stable: bool) -> None:
        """A squeeze goes on from here; whether the simulation has not broken down on the way."""
        self._warnings = self.simulation.warnings() if is_stable else -1

    def _here(self) -> Squeezed:
        """Where a squeeze has just ended."""
        is_stable = self.simulation.warnings() == self._warnings
        return Squeezed(self.simulation.full_state(), self.simulation.floating_pose(), is_stable)
