"""What a hold test found out."""

from dataclasses import dataclass
from math import degrees, inf, nan

import numpy as np

from ...base.numeric.arrays import Array
from ...base.text.notebook import html_table
from ...base.text.significant import significant
from ..directions import TestKind
from ..settings import Direction, HoldSettings
from .outcome import Outcome
from .strain import strain
from .words import passed_word

__all__ = ["DirectionResult", "HoldResult", "Squeezed", "UsualSqueeze"]

# Time at the end of a test over which creep is measured, after the swing that gravity begins with.
_CREEP_S = 0.1
# Ends that no wider limit would have changed.
_NEVER_NEAR = (Outcome.OVERLOADED, Outcome.UNSTABLE)


@dataclass(frozen=True, eq=False, repr=False)
class DirectionResult:
    """One direction of gravity, or the one trial of a test that has no directions (see `HoldResult.kind`).

    Attributes:
        gravity: direction of gravity in the palm frame, a unit vector; zero where there is no gravity.
        outcome: how it ended.
        slip_m: in a lift, largest displacement of what is watched on the object since the squeeze, in the
            palm frame; in the other tests, largest way of a contact's point on the hand's skin.
        rotation_rad: in a lift, largest rotation of the object, in the palm frame; in a turn, the angle by
            which the parts have turned.
        touching: whether each contact of the task still carried force at the end.
        times_s: (k,) times of the samples since gravity set in.
        slip_curve_m: (k,) displacement at those times.
        rotation_curve_rad: (k,) rotation at those times.
        qpos: (k, n_joints + 7) joints and pose of the object at those times, for pictures.
    """

    gravity: Direction
    outcome: Outcome
    slip_m: float
    rotation_rad: float
    touching: tuple[bool, ...]
    times_s: Array
    slip_curve_m: Array
    rotation_curve_rad: Array
    qpos: Array

    def __str__(self) -> str:
        towards = ", ".join(f"{significant(part, 3)}" for part in self.gravity)
        where = f"gravity along ({towards}): " if any(self.gravity) else ""
        return f"{where}{self.outcome.value}, {_motion(self.slip_m, self.rotation_rad)}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    @property
    def held(self) -> bool:
        """Whether the object was held in this direction."""
        return self.outcome is Outcome.HELD

    @property
    def creep_m_s(self) -> float:
        """How fast the slip still grew or shrank in the last tenth of a second, in m/s."""
        return self._rate(self.slip_curve_m)

    @property
    def creep_rad_s(self) -> float:
        """How fast the object still turned in the last tenth of a second, in rad/s."""
        return self._rate(self.rotation_curve_rad)

    def _rate(self, curve: Array) -> float:
        first = int(np.searchsorted(self.times_s, self.times_s[-1] - _CREEP_S - 1e-9))
        seconds = self.times_s[-1] - self.times_s[first]
        return float(abs(curve[-1] - curve[first]) / seconds) if seconds > 0.0 else float("nan")


@dataclass(frozen=True, eq=False)
class Squeezed:
    """Where a squeeze has left hand and object.

    Attributes:
        state: all that the future depends on.
        pose: of the object (7,) in the palm frame.
        is_stable: whether the simulation has not broken down on the way there.
    """

    state: Array
    pose: Array
    is_stable: bool = True


@dataclass(frozen=True, eq=False)
class UsualSqueeze:
    """The usual squeeze of a grasp, for other lifts of it to go on from.

    Attributes:
        closed: the state in which the hand is closed on the object.
        way: states from there to the squeeze, evenly apart.
        squeezed: where it has led.
    """

    closed: Array
    way: tuple[Array, ...]
    squeezed: Squeezed


@dataclass(frozen=True, eq=False, repr=False)
class HoldResult:
    """A physical test.

    Attributes:
        settings: what was assumed.
        squeeze_slip_m: how far the squeeze alone moved what is watched on the object.
        squeeze_rotation_rad: how far the squeeze alone turned it.
        squeezed_qpos: (n_joints + 7,) joints and pose of the object at the end of the squeeze.
        squeezed_normals_N: (n,) normal force between the object and the link of each contact then.
        directions: one result per direction of gravity, in the order of the settings; one for other tests.
            A lift that was to end where it fails first has them up to there, none where the squeeze failed.
        kind: what was tested: `lift`, `turn` or `press`.
        penetration_m: how deep the hand sinks into the object in the grasp itself, by MuJoCo's measure.
        gap_m: largest distance between a link and the part of the object that it should touch in the grasp.
        pressed_N: in a press, the least normal force from the squeeze to the end, of the contacts that are
            named; None in other tests.
        reached: in a turn or a press, the share reached of the angle or force asked for; None in a lift.
        usual: of a lift, the squeeze itself, for others to go on from; None where another engine made it.
    """

    settings: HoldSettings
    squeeze_slip_m: float
    squeeze_rotation_rad: float
    squeezed_qpos: Array
    squeezed_normals_N: Array
    directions: tuple[DirectionResult, ...]
    kind: TestKind = "lift"
    penetration_m: float = 0.0
    gap_m: float = 0.0
    pressed_N: float | None = None
    reached: float | None = None
    usual: UsualSqueeze | None = None

    def __str__(self) -> str:
        word = passed_word(self.kind)
        return self._measured() if self.held else f"not {word}: {self._reason()}; {self._measured()}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    def _repr_html_(self) -> str:
        rows = [
            (
                ", ".join(f"{significant(part, 3)}" for part in entry.gravity),
                entry.outcome.value,
                1e3 * entry.slip_m,
                degrees(entry.rotation_rad),
                f"{sum(entry.touching)} of {len(entry.touching)}",
            )
            for entry in self.directions
        ]
        head = ("gravity", "outcome", "slip (mm)", "turn (deg)", "contacts that touch")
        return html_table(str(self), head, rows)

    def _measured(self) -> str:
        """What was measured, in the words of the kind of test."""
        slip = f"slip {1e3 * self.slip_m:.2f} mm"
        if self.kind == "turn":
            return f"turned by {degrees(self.rotation_rad):.2f} deg, {slip}"
        if self.pressed_N is not None:
            return f"pressed with {significant(self.pressed_N, 3)} N, {slip}"
        if not self.directions:
            squeezed = _motion(self.squeeze_slip_m, self.squeeze_rotation_rad)
            return f"no direction tried, in the squeeze {squeezed}"
        count = sum(direction.held for direction in self.directions)
        tried = " tried" if len(self.directions) < len(self.settings.directions) else ""
        where = f"held in {count} of {len(self.directions)} directions{tried}"
        return f"{where}, {_motion(self.slip_m, self.rotation_rad)}"

    def _reason(self) -> str:
        """Why the test is not passed, in a few words: the first reason that applies."""
        if not self.fits:
            return "the hand sinks into the object or leaves gaps"
        if any(direction.outcome is Outcome.UNSTABLE for direction in self.directions):
            return Outcome.UNSTABLE.value
        if not self.kept_place:
            return "the squeeze moved the object too far"
        return next(direction.outcome.value for direction in self.directions if not direction.held)

    @property
    def fits(self) -> bool:
        """Whether the grasp is as free of penetration and gaps as the settings ask."""
        settings = self.settings
        limits = ((self.penetration_m, settings.penetration_limit_m), (self.gap_m, settings.gap_limit_m))
        return all(limit is None or value <= limit for value, limit in limits)

    @property
    def kept_place(self) -> bool:
        """Whether the squeeze left the object where the grasp has it, within the limits of slip and rotation.

        Where contacts lie outside their friction cones, a squeeze may slide the object into another grasp,
        which then holds: that says nothing about the one tested.
        """
        settings = self.settings
        is_near = self.squeeze_slip_m < settings.slip_limit_m
        limit = settings.rotation_limit_rad
        return is_near and (limit is None or self.squeeze_rotation_rad < limit)

    @property
    def is_firm(self) -> bool:
        """Whether the squeeze hardly moved the object, and the load left room to the limits.

        What moves here moves farther on softer contacts. Of a press it is whether it presses well harder than
        it is asked to.
        """
        if self.kind == "press":
            return self.load_strain < self.settings.firm_share
        has_room = self.kind != "lift" or self.load_strain < self.settings.firm_share
        return has_room and self.squeezed_within(1.0)

    def squeezed_within(self, share: float) -> bool:
        """Whether the squeeze moved the object by less than a share of what a firm one may."""
        return self.squeeze_slip_m < share * self.settings.firm_limit_m

    @property
    def load_strain(self) -> float:
        """The largest share of a limit that the load of a lift takes; 0 where none was tried.

        Of a press, the force asked for over the one that was reached.
        """
        if self.reached is not None and self.kind == "press":
            return 1.0 / self.reached if self.reached > 0.0 else inf
        return max(
            (strain(one.slip_m, one.rotation_rad, self.settings) for one in self.directions), default=0.0
        )

    @property
    def held(self) -> bool:
        """Whether the grasp fits, the object kept its place in the squeeze, and every direction was held."""
        return self.fits and self.kept_place and all(direction.held for direction in self.directions)

    @property
    def is_near_miss(self) -> bool:
        """Whether a whole test that was not passed came near: see `HoldSettings.near_limit`.

        Where motion stays near its limits, whether a contact is lost or an angle just reached hangs on what
        nobody knows well, such as how pads yield; another simulator holds some of these grasps.
        """
        times = self.settings.near_limit
        squeezed = strain(self.squeeze_slip_m, self.squeeze_rotation_rad, self.settings)
        came = (self.reached is None or self.reached * times > 1.0) and all(
            map(self._is_near, self.directions)
        )
        fails = times > 1.0 and not self.held and self.fits and bool(self.directions)
        return fails and squeezed < times and came

    def _is_near(self, direction: DirectionResult) -> bool:
        # What a turn has turned by has no limit.
        turned = direction.rotation_rad if self.kind == "lift" else 0.0
        near = strain(direction.slip_m, turned, self.settings) < self.settings.near_limit
        return near and any(direction.touching) and direction.outcome not in _NEVER_NEAR

    @property
    def is_finite(self) -> bool:
        """Whether the squeeze left everything in a place: the simulation did not break down in it."""
        return bool(np.isfinite(self.squeezed_qpos).all() and np.isfinite(self.squeezed_normals_N).all())

    @property
    def slip_m(self) -> float:
        """Largest slip over all directions, NaN where none was tried."""
        return max((direction.slip_m for direction in self.directions), default=nan)

    @property
    def rotation_rad(self) -> float:
        """Largest rotation over all directions, NaN where none was tried."""
        return max((direction.rotation_rad for direction in self.directions), default=nan)

    @property
    def creep_m_s(self) -> float:
        """Fastest creep over all directions, NaN where none was tried, in m/s."""
        return max((direction.creep_m_s for direction in self.directions), default=nan)

    @property
    def creep_rad_s(self) -> float:
        """Fastest turning creep over all directions, NaN where none was tried, in rad/s."""
        return max((direction.creep_rad_s for direction in self.directions), default=nan)

    @property
    def is_at_rest(self) -> bool:
        """Whether what still moves in the end stays within the budget of creep."""
        settings = self.settings
        slow = self.creep_m_s <= settings.creep_budget_m_s
        return slow and self.creep_rad_s <= settings.creep_budget_rad_s


def _motion(slip_m: float, rotation_rad: float) -> str:
    return f"slip {1e3 * slip_m:.2f} mm, turn {degrees(rotation_rad):.2f} deg"
