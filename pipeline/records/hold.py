"""The part of a grasp file that the physical test fills in."""

from math import inf
from typing import Literal

from ...base.files.fields import Finite
from ...base.files.file_model import FileModel

__all__ = ["Direction", "FingerFirst", "Hold", "LessSpin", "Limit", "Setting", "Squeeze"]

Setting = bool | int | float | str | None | list[float] | list[tuple[Finite, Finite, Finite]]
"""A setting by its value, as files have it."""


class Direction(FileModel):
    """The hold test in one direction of gravity.

    Attributes:
        gravity: acceleration in the palm frame, in m/s^2.
        held: whether the object stayed within the limits and every finger kept touching.
        outcome: the same in words, with the reason.
        slip: largest displacement of the object; None where the simulation broke down.
        rotation: largest rotation of the object; None where the simulation broke down.
        creep: how fast the slip still changed in the last tenth of a second, in m/s; None as for the others.
        curve: pairs (time, displacement), for drawing.
        rotation_curve: pairs (time, rotation), for drawing.
        motion: rows (time, joints, position and quaternion of the object in the palm frame), for playing
            back: straight lines between them are the motion; see `motion.thinned`.
    """

    gravity: tuple[Finite, Finite, Finite]
    held: bool
    outcome: str = ""
    slip: float | None
    rotation: float | None
    creep: float | None = None
    curve: list[tuple[float, float]] = []
    rotation_curve: list[tuple[float, float]] = []
    motion: list[list[Finite]] = []


class FingerFirst(FileModel):
    """The squeeze with one finger first.

    Attributes:
        finger: name of the finger.
        slip: how far the object then moved; None where the simulation broke down.
        rotation: how far it turned; None as before.
        kept: whether both were within the limits of the squeeze.
    """

    finger: str
    slip: float | None
    rotation: float | None
    kept: bool


class LessSpin(FileModel):
    """The test with less of the friction that resists spin.

    Attributes:
        share: of that friction.
        gravity: acceleration in the palm frame, in m/s^2, in the direction in which the object then came
            closest to the limits.
        slip: its slip there; None where the simulation broke down.
        rotation: how far it turned there, at least; None as before.
        held: whether it was held in every direction that was tried.
    """

    share: float
    gravity: tuple[Finite, Finite, Finite]
    slip: float | None
    rotation: float | None
    held: bool


class Limit(FileModel):
    """What keeps a grasp from carrying its load by plan.

    Attributes:
        load_factor: multiple of the load that forces within cones and planned efforts carry at most.
        wanted: multiple that is planned for.
        servos: independent joints whose servos limit it.
        efforts: multiple of all efforts with which `wanted` would be carried; None where none would do.
        friction: coefficient with which it would be; None where none up to 1.5 would do.
        words: the same in words.
    """

    load_factor: float
    wanted: float
    servos: list[str] = []
    efforts: float | None = None
    friction: float | None = None
    words: str


class Squeeze(FileModel):
    """The joint targets that press the fingers on the object.

    Attributes:
        targets: position targets by independent joint.
        efforts: torques (forces of prismatic joints) of the squeeze by independent joint.
        normal_forces: normal force of the squeeze at each contact, in N.
        contact_forces: force of the squeeze on the object at each contact by plan: along its inward normal
            and along two tangents, in N, and the torque about the normal, in N m.
        path: targets that follow, one place after the other, where the hand turns something.
        load_factor: how many times the object's weight the plan balances.
        slip: how far the squeeze itself moved the object; None where it was not simulated.
        rotation: how far the squeeze itself turned it; None where it was not simulated.
        spin_arms: arm in m at which friction resists spin at each contact.
        yields: how far the pad of each contact yields by plan, in m.
        centres: where on each contact the squeeze presses by plan, off its point along its tangents, in m.
        simulated_forces: normal force on the link of each contact after the squeeze, in N.
        least: share of the squeeze that still holds the object; None where not measured.
        rule: which squeeze of the grasp this is: empty for the usual one, else which other one was chosen as
            the usual one moved the object.
        rated_force: normal force for which the hand's fingertips are rated, in N; None where not known.
    """

    targets: dict[str, float]
    efforts: dict[str, float] = {}
    normal_forces: list[float] = []
    contact_forces: list[tuple[Finite, Finite, Finite, Finite]] = []
    path: list[dict[str, float]] = []
    load_factor: float
    slip: float | None = None
    rotation: float | None = None
    spin_arms: list[float] = []
    yields: list[float] = []
    centres: list[tuple[Finite, Finite]] = []
    simulated_forces: list[float] = []
    rated_force: float | None = None
    least: float | None = None
    rule: str = ""


class Hold(FileModel):
    """The physical test.

    Attributes:
        preset: name of the settings.
        settings: the settings by name.
        kind: what was tested: `lift` against gravity, `turn`, or `press`.
        held: whether the test was passed, in every direction; False where the grasp could not be tried.
        narrow: whether it was held, but not where one finger arrives first or friction resists spin less, or
            its squeeze moved the object; None where that was not tried.
        near_miss: whether it was not held, but would be with limits somewhat wider, lost contacts aside (the
            setting `near_limit`); None where it was held, or not simulated.
        strain: how much of what is thought safe a grasp takes that is held, 1 and more being beyond it: the
            largest of what the squeeze moves, what comes of less spin friction and of each finger first, and
            how little the contact that presses least does, each as a share of its limit; None where that was
            not tried.
        fingers: the squeeze with each finger first, for lifts that held.
        less_spin: the test with less spin friction, for lifts that held; None where that was not tried.
        margin: largest load up to which it passed, in multiples of the test's: gravity, the friction of the
            hinge, or the force of a press; None where not measured.
        settings_agree: whether other settings say the same; None where they were not tried.
        agreement: the verdict by each other setting.
        agreement_directions: gravity in m/s^2 in the directions in which these were tried, of a lift; empty
            for all. Where the margin is known, they are those that give way first.
        creep: fastest creep over the directions in m/s; None where the simulation broke down.
        creep_rotation: the same of the rotation in rad/s.
        at_rest: whether both stay within the budget that the settings state.
        probability: share of trials with noise that passed; None where there were none.
        trials: number of those trials.
        directions: results by direction of gravity.
        squeeze: how the hand pressed; None where no squeeze was found.
        reason: why the grasp could not be tried.
        limit: of a grasp that is not held, what keeps it from carrying its load by plan; None where the plan
            carries it.
    """

    preset: str
    settings: dict[str, Setting] = {}
    kind: Literal["lift", "turn", "press"] = "lift"
    held: bool
    narrow: bool | None = None
    near_miss: bool | None = None
    strain: float | None = None
    fingers: list[FingerFirst] = []
    less_spin: LessSpin | None = None
    margin: float | None = None
    settings_agree: bool | None = None
    agreement: dict[str, bool] = {}
    agreement_directions: list[tuple[Finite, Finite, Finite]] = []
    creep: float | None = None
    creep_rotation: float | None = None
    at_rest: bool | None = None
    probability: float | None = None
    trials: int = 0
    directions: list[Direction] = []
    squeeze: Squeeze | None = None
    reason: str = ""
    limit: Limit | None = None

    @property
    def leans_on(self) -> list[FingerFirst]:
        """The fingers that must not arrive first, the worst first."""
        lost = [finger for finger in self.fingers if not finger.kept]
        return sorted(lost, key=lambda f: (-_size(f.rotation), -_size(f.slip)))

    @property
    def held_count(self) -> int:
        """Number of directions that held."""
        return sum(direction.held for direction in self.directions)

    @property
    def slip(self) -> float | None:
        """Largest slip over the directions, None where there is no figure."""
        return max((d.slip for d in self.directions if d.slip is not None), default=None)

    @property
    def rotation(self) -> float | None:
        """Largest rotation over the directions, None where there is no figure."""
        return max((d.rotation for d in self.directions if d.rotation is not None), default=None)


def _size(value: float | None) -> float:
    """A measure, or where the simulation broke down, more than any."""
    return inf if value is None else value
