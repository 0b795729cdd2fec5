"""Everything a hold test assumes, in one value that travels with its result."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, radians
from typing import Literal, TypeAlias

import numpy as np

from ..arguments import check_number, check_whole_number
from ..errors import InputError, UnknownName
from ..objects import SIX, ObjectModel

__all__ = ["Direction", "HoldSettings", "spin_arm_of_patch"]

Direction: TypeAlias = tuple[float, float, float]
# Directions this close to their middle count as one way.
_MUCH_THE_SAME_RAD = radians(45.0)
# Directions may be rounded to so many digits that their lengths are off by this.
_UNIT_TOLERANCE = 1e-3
# What a pad makes of 25 N on a flat face.
_USUAL_PATCH_M = 0.005
_ABOVE_ZERO = (
    "close_s",
    "squeeze_s",
    "settle_s",
    "hold_s",
    "turn_s",
    "sample_s",
    "slip_limit_m",
    "firm_limit_m",
    "creep_budget_m_s",
    "creep_budget_rad_s",
    "margin_cap",
    "planned_load",
    "timestep_s",
    "impratio",
)
_ABOVE_ZERO_OR_NONE = (
    "rest_s",
    "patch_radius_m",
    "friction",
    "object_mass_kg",
    "rotation_limit_rad",
    "penetration_limit_m",
    "gap_limit_m",
)
_CHOICES: Mapping[str, tuple[str, ...]] = {
    "slip_of": ("contact", "centre"),
    "must_touch": ("all", "any", "none"),
    "solver": ("Newton", "CG", "PGS"),
}
_SHARES = ("firm_spin", "firm_share", "margin_resolution", "planned_effort", "planned_friction")


@dataclass(frozen=True)
class HoldSettings:
    """Assumptions of a hold test; the defaults are the preset `holdfast`.

    Values that can't be used raise an `InputError`.

    Attributes:
        preset: name of this set of values.
        friction: Coulomb coefficient between hand and object; None takes the object's.
        object_mass_kg: mass that the object is given, its density scaled evenly; None keeps its own.
        patch_radius_m: radius a of the patch in which every contact touches, which resists a torque of
            (2/3) friction a per newton about the contact normal (uniform pressure); None takes the patch
            that the hand's pads make under the planned force on what is curved as the two bodies are there
            (`hands.Pad`): as much as a = 5 mm at 25 N on a flat face, 2.4 mm at 2 N on a rod of radius 9 mm.
            Others assume more: 5 mm of friction per newton in MuJoCo's defaults, 20 mm in DexGraspBench.
        soft_pads: whether links of the task's contacts yield as the hand's pads do under the planned force,
            and the squeeze makes up for it; else they are as stiff as `contact_solref` makes them, whatever
            the hand's skin.
        fingers_first: whether a lift that holds must also stand it when one finger makes its squeeze first,
            to be more than held narrowly. It costs a squeeze a finger, and finds nearly all grasps that hold
            here and let the object go in the squeeze with other contacts; it also names some that would not.
        firm_limit_m: a lift that holds is held narrowly where the squeeze itself moves what is watched on the
            object by so much or more, by the same reasoning: softer contacts let it move farther.
        firm_spin: and so it is where it gives way with this share of the friction that resists spin, which
            nobody knows well: it comes from the patches that pads make. 1 leaves that out.
        firm_share: and so it is where the load moves the object by such a share of a limit or more, for on
            softer contacts it moves farther, or where a squeeze that was chosen among others moves it by such
            a share of `firm_limit_m`; and a press where what is asked for is such a share of the force that
            it reached. 1 leaves that out.
        near_limit: a grasp that fails is a near miss where it would pass with limits so many times as wide,
            and as small a part of the angle or force that is asked for, lost contacts aside; 1 for never.
        gravity: size of the load in m/s^2.
        directions: unit vectors in the palm frame along which gravity acts, one test each.
        hand_weight: whether the hand's links have weight too. False stands for a controller that compensates
            it, so that the servos work for the object alone (DexGraspBench loads the object alone, too).
        close_s: time in which the fingers close from the pregrasp to the grasp; the object, free already,
            rests in something viscous meanwhile, as a table or a hand would keep it.
        squeeze_s: time in which the servos' targets move from the grasp to the squeeze, without gravity, or
            with gravity growing to its full size along `resting_direction`.
        settle_s: time at rest after that, gravity as it is; a lift's ends early as `rest_s` has it.
        hold_s: time under gravity, per direction, or of a press.
        turn_s: time in which a turn is made.
        rest_s: gravity in a direction, and a lift's time to settle, end early once the object has moved in so
            much time by no more than the budget of creep allows, every contact touching; None for never.
        sample_s: distance in time of the recorded samples.
        slip_limit_m: the object is held while what is watched stays this close to where the squeeze left it,
            in the palm frame. Sag of the fingers counts as slip.
        slip_of: what is watched: the object's points of `contact`, or its `centre` of mass alone.
        rotation_limit_rad: and while it has turned by less than this; None for no limit. The squeeze, too,
            must not move the object by more than these two limits.
        must_touch: which contacts of the task must carry force in the end: `all`, `any` or `none`.
        penetration_limit_m: in the grasp, the hand must not sink deeper into the object; None for no limit.
        gap_limit_m: in the grasp, the bodies that should touch must be as close; None for no limit.
        creep_budget_m_s: an object at rest may creep so fast; reported beside the verdict, no part of it.
        creep_budget_rad_s: and turn so fast.
        margin_cap: multiple of the load at which the search for the margin ends.
        margin_resolution: how far the last load that is held and the first that is not may lie apart, as a
            share of the latter.
        planned_load: the squeeze is planned for this many times the weight: gravity sets in at once, and the
            object swings before it rests.
        planned_force_N: every contact presses with at least this normal force, where the load and efforts
            allow: a contact with less soon lets go, and no hand presses as gently as statics would have it.
        planned_effort: the squeeze is planned within this share of every servo's largest effort.
        planned_friction: and with this share of the friction, where that carries the planned load: contacts
            roll as the fingers yield, so that forces on the edge of a cone leave it.
        timestep_s: step of the simulation, at most half the time constant of `contact_solref`: beyond that
            MuJoCo makes contacts softer than they are asked to be, and other grasps hold.
        impratio: MuJoCo's ratio of frictional to normal constraint impedance; above 1 slows creep.
        noslip_iterations: MuJoCo's extra passes against creep. 5 are enough for a straight pinch; pinches
            that lean on the edges of their friction cones turned by up to 1 deg/s with 5, and by less than
            0.02 deg/s with 20. Without them they turn by up to 0.5 deg/s at `impratio` 1000.
        solver: MuJoCo's solver of the contact problem.
        contact_solref: time constant in s and damping ratio of contacts. With 5 ms, fingers that pinch the
            scalpel with 30 N sink in by 0.4 mm; with MuJoCo's 20 ms it would be several millimetres.
        contact_solimp: impedance of contacts, as MuJoCo's `solimp`.
    """

    preset: str = "holdfast"
    friction: float | None = None
    object_mass_kg: float | None = None
    patch_radius_m: float | None = None
    soft_pads: bool = True
    fingers_first: bool = True
    firm_limit_m: float = 0.0015
    firm_spin: float = 0.7
    firm_share: float = 0.667
    near_limit: float = 1.5
    gravity: float = 9.81
    directions: tuple[Direction, ...] = SIX
    hand_weight: bool = False
    close_s: float = 0.25
    squeeze_s: float = 0.5
    settle_s: float = 0.5
    hold_s: float = 1.0
    turn_s: float = 2.0
    rest_s: float | None = 0.1
    sample_s: float = 0.02
    slip_limit_m: float = 0.005
    slip_of: Literal["contact", "centre"] = "contact"
    rotation_limit_rad: float | None = radians(10.0)
    must_touch: Literal["all", "any", "none"] = "all"
    penetration_limit_m: float | None = None
    gap_limit_m: float | None = None
    creep_budget_m_s: float = 1e-4
    creep_budget_rad_s: float = radians(0.1)
    margin_cap: float = 8.0
    margin_resolution: float = 0.05
    planned_load: float = 1.5
    planned_force_N: float = 2.0
    planned_effort: float = 0.9
    planned_friction: float = 0.7
    timestep_s: float = 0.0025
    impratio: float = 10.0
    noslip_iterations: int = 20
    solver: Literal["Newton", "CG", "PGS"] = "Newton"
    contact_solref: tuple[float, float] = (0.005, 1.0)
    contact_solimp: tuple[float, float, float, float, float] = (0.95, 0.99, 0.001, 0.5, 2.0)

    def __post_init__(self) -> None:
        for name in _ABOVE_ZERO:
            check_number(f"HoldSettings.{name}", getattr(self, name), above=0.0)
        for name in _ABOVE_ZERO_OR_NONE:
            if getattr(self, name) is not None:
                check_number(f"HoldSettings.{name}", getattr(self, name), above=0.0)
        for name in _SHARES:
            share = check_number(f"HoldSettings.{name}", getattr(self, name), above=0.0)
            if share > 1.0:
                raise InputError(f"HoldSettings.{name}", "", f"must be at most 1, not {share:g}")
        check_number("HoldSettings.near_limit", self.near_limit, least=1.0)
        check_number("HoldSettings.gravity", self.gravity, least=0.0)
        check_number("HoldSettings.planned_force_N", self.planned_force_N, least=0.0)
        check_whole_number("HoldSettings.noslip_iterations", self.noslip_iterations, least=0)
        for name, known in _CHOICES.items():
            if getattr(self, name) not in known:
                raise UnknownName(
                    f"HoldSettings.{name}", "", name.replace("_", " "), str(getattr(self, name)), known
                )
        _check_directions(self.directions)
        for name, count in (("contact_solref", 2), ("contact_solimp", 5)):
            _check_numbers(f"HoldSettings.{name}", getattr(self, name), count)

    @property
    def resting_direction(self) -> Direction:
        """Direction of gravity during the squeeze: zero, or the middle of directions that are much the same.

        An object that gravity always pushes one way, such as a pot on the palm, may rest in the hand and need
        not be squeezed from all sides; where gravity may come from any side, the squeeze is made without it.
        """
        given = np.array(self.directions)
        middle = given.mean(axis=0)
        length = float(np.linalg.norm(middle))
        if length == 0.0 or (given @ middle).min() < cos(_MUCH_THE_SAME_RAD) * length:
            return 0.0, 0.0, 0.0
        x, y, z = (middle / length).tolist()
        return x, y, z

    def sliding_friction(self, obj: ObjectModel) -> float:
        """Coulomb coefficient between the hand and `obj`."""
        return obj.friction if self.friction is None else self.friction

    def planned_frictions(self, obj: ObjectModel) -> tuple[float, ...]:
        """Coefficients to plan with: the first that carries the planned load is the best."""
        share = self.planned_friction
        shares = dict.fromkeys((share, 0.5 * (share + 1.0), 1.0))
        return tuple(share * self.sliding_friction(obj) for share in shares)

    def torsional_friction(self, obj: ObjectModel, arm_m: float | None = None) -> float:
        """Largest torque about the normal per normal force, in m.

        Args:
            obj: what is touched.
            arm_m: mean distance from the normal at which the pad rubs (`Pad.spin_arm_m`); None for that of
                `patch_radius_m`, or where pads decide, of 5 mm: for what asks before contacts are known.
        """
        if arm_m is None:
            arm_m = spin_arm_of_patch(_USUAL_PATCH_M if self.patch_radius_m is None else self.patch_radius_m)
        return self.sliding_friction(obj) * arm_m


def spin_arm_of_patch(radius_m: float) -> float:
    """Mean distance from the normal at which a round patch rubs, by the area."""
    return 2.0 / 3.0 * radius_m


def _check_directions(directions: Sequence[Direction]) -> None:
    if not isinstance(directions, tuple) or not directions:
        raise InputError("HoldSettings.directions", "", "must be a tuple of at least one unit vector")
    for i, direction in enumerate(directions):
        name = f"HoldSettings.directions[{i}]"
        _check_numbers(name, direction, 3)
        if abs(float(np.linalg.norm(direction)) - 1.0) > _UNIT_TOLERANCE:
            raise InputError(name, "", f"must be a unit vector, not {direction}")


def _check_numbers(name: str, values: Sequence[float], count: int) -> None:
    if not isinstance(values, tuple) or len(values) != count:
        raise InputError(name, "", f"must be a tuple of {count} numbers")
    for i, value in enumerate(values):
        check_number(f"{name}[{i}]", value)
