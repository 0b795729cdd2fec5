"""What a run writes and reads back: the JSON form of grasps and runs.

Every number is in SI units (m, rad, kg, s, N); quaternions are w, x, y, z; poses and contacts are in the palm
frame. A file that is read back counts as untrusted: unknown fields, NaN and impossible values are errors.
"""

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field

from ...fields import Finite, Vector3
from ...files import FileModel, parse, read_json

__all__ = [
    "Approach",
    "Clearance",
    "Contact",
    "Direction",
    "GraspFile",
    "GraspRecord",
    "Hold",
    "ObjectPose",
    "Round",
    "RunRecord",
    "Setting",
    "Solution",
    "Solve",
    "Squeeze",
    "read_grasp",
    "read_run",
    "to_json",
]

# Ids name files, so they must be plain.
Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$")]


def _is_unit(quaternion: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    if abs(float(np.linalg.norm(quaternion)) - 1.0) > 1e-6:
        raise ValueError("must be a unit quaternion (w, x, y, z)")
    return quaternion


Quaternion = Annotated[tuple[float, float, float, float], AfterValidator(_is_unit)]


Setting = bool | int | float | str | None | list[float] | list[tuple[Finite, Finite, Finite]]


class ObjectPose(FileModel):
    """Pose of the object in the palm frame."""

    position: Vector3
    quaternion: Quaternion


class Contact(FileModel):
    """One contact.

    Attributes:
        hand: region of the hand.
        object: region of the object.
        point: point of the object that touches.
        normal: unit outward normal of the object there.
        gap: distance between the points of hand and object that should touch.
        normal_angle: angle between the hand's normal and the reverse of the object's.
    """

    hand: str
    object: str
    point: Vector3
    normal: Vector3
    gap: float
    normal_angle: float


class Clearance(FileModel):
    """How deep bodies sink into each other.

    Attributes:
        before: smallest signed distance between bodies that should not touch; negative where one sinks in.
        after: the same after retraction.
        status: `clear` as it came to retraction, `retracted` into clearance, or `failed`.
        worst_pair: the two bodies nearest to each other after, or those that block retraction.
        reason: why retraction failed.
        margin: distance that was asked for between bodies that should not touch.
        route: how retraction got there: `unmoved`, `slid` out along the contacts, the same from a place
            `near` by, or found `anew`; None where it failed.
        moved: how far from where it started, the largest of joints (rad), turn (rad) and shift over 0.1 m.
        differing: pairs on whose distance MuJoCo differs from FCL by more than 1e-6 m and a thousandth.
    """

    before: float
    after: float
    status: Literal["clear", "retracted", "failed"]
    worst_pair: tuple[str, str] | None
    reason: str = ""
    margin: float = 0.0
    route: Literal["unmoved", "slid", "near", "anew"] | None = None
    moved: float | None = None
    differing: list[tuple[str, str]] = []


class Approach(FileModel):
    """How the fingers get to the grasp, hand and object being in place; the physical test follows it.

    Attributes:
        reachable: whether the grasp is clear and a pregrasp was found from which the fingers close without
            touching anything else; proved for the whole way, not for samples of it.
        opening: by how much every finger's contact point is off the object in the pregrasp, along its normal.
        blocking: the two bodies that keep the fingers from opening further, if bodies do.
        waypoints: positions of the independent joints from the pregrasp to the grasp; straight lines between.
    """

    reachable: bool
    opening: float
    blocking: tuple[str, str] | None = None
    waypoints: list[dict[str, float]]


class Direction(FileModel):
    """The hold test in one direction of gravity.

    Attributes:
        gravity: acceleration in the palm frame, in m/s^2.
        held: whether the object stayed within the limits and every finger kept touching.
        outcome: the same in words, with the reason.
        slip: largest displacement of the object; None where the simulation broke down.
        rotation: largest rotation of the object; None where the simulation broke down.
        creep: how fast the slip still changed in the last half second, in m/s; None as for the others.
        curve: pairs (time, displacement), for drawing.
    """

    gravity: tuple[Finite, Finite, Finite]
    held: bool
    outcome: str = ""
    slip: float | None
    rotation: float | None
    creep: float | None = None
    curve: list[tuple[float, float]] = []


class Squeeze(FileModel):
    """The joint targets that press the fingers on the object.

    Attributes:
        targets: position targets by independent joint.
        efforts: torques (forces of prismatic joints) of the squeeze by independent joint.
        normal_forces: normal force of the squeeze at each contact, in N.
        load_factor: how many times the object's weight the plan balances.
        slip: how far the squeeze itself moved the object; None where it was not simulated.
        rotation: how far the squeeze itself turned it; None where it was not simulated.
    """

    targets: dict[str, float]
    efforts: dict[str, float] = {}
    normal_forces: list[float] = []
    load_factor: float
    slip: float | None = None
    rotation: float | None = None


class Hold(FileModel):
    """The physical test.

    Attributes:
        preset: name of the settings.
        settings: the settings by name.
        kind: what was tested: `lift` against gravity, `turn`, or `press`.
        held: whether the test was passed, in every direction; False where the grasp could not be tried.
        margin: largest load up to which it passed, in multiples of the test's: gravity, the friction of the
            hinge, or the force of a press; None where not measured.
        settings_agree: whether other settings say the same; None where they were not tried.
        agreement: the verdict by each other setting.
        creep: fastest creep over the directions in m/s; None where the simulation broke down.
        creep_rotation: the same of the rotation in rad/s.
        at_rest: whether both stay within the budget that the settings state.
        probability: share of trials with noise that passed; None where there were none.
        trials: number of those trials.
        directions: results by direction of gravity.
        squeeze: how the hand pressed; None where no squeeze was found.
        reason: why the grasp could not be tried.
    """

    preset: str
    settings: dict[str, Setting] = {}
    kind: Literal["lift", "turn", "press"] = "lift"
    held: bool
    margin: float | None = None
    settings_agree: bool | None = None
    agreement: dict[str, bool] = {}
    creep: float | None = None
    creep_rotation: float | None = None
    at_rest: bool | None = None
    probability: float | None = None
    trials: int = 0
    directions: list[Direction] = []
    squeeze: Squeeze | None = None
    reason: str = ""

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


class Solution(FileModel):
    """A configuration as the solver leaves it; what `holdfast solve --json` lists.

    Attributes:
        id: unique in its run.
        joints: positions of all joints, coupled ones included.
        object: pose of the object.
        parameters: where on each Bezier patch the contact lies, contact by contact, hand side first.
        contacts: the points that touch.
        certified: whether a true solution is proved to lie within `certified_radius`.
        certified_radius: in the solver's variables (cosines, sines, and lengths in its own unit).
        residual: largest absolute value of the contact equations.
    """

    id: Identifier
    joints: dict[str, float]
    object: ObjectPose
    parameters: list[Annotated[float, Field(ge=0, le=1)]] = []
    contacts: list[Contact]
    certified: bool
    certified_radius: float | None = None
    residual: float


class GraspRecord(Solution):
    """A grasp, as far as it has come: what the later stages have not seen yet is None.

    Attributes:
        strengthened: whether it has slid along its contacts, away from the solver's configuration, to where a
            squeeze carries more.
        restarts: places from which retraction searched again before it came to this configuration. Above 0 it
            is not the solver's configuration moved out of penetration, but another one of the same task.
        clearance: penetration before and after retraction.
        approach: the pregrasp, and whether the way from there is clear; None where the grasp itself is not
            and has not come to a test.
        quality: figures by name.
        hold: the physical test.
    """

    strengthened: bool = False
    restarts: int = 0
    clearance: Clearance | None = None
    approach: Approach | None = None
    quality: dict[str, float] = {}
    hold: Hold | None = None

    @property
    def is_clear(self) -> bool:
        """Whether nothing sinks in."""
        return self.clearance is not None and self.clearance.status != "failed"

    @property
    def is_unreachable(self) -> bool:
        """Whether no clear way was found for the fingers to get to it."""
        return self.approach is not None and not self.approach.reachable

    @property
    def is_held(self) -> bool:
        """Whether the physical test was passed."""
        return self.hold is not None and self.hold.held

    @property
    def is_untested(self) -> bool:
        """Whether it was not simulated, as no squeeze was found."""
        return self.hold is not None and not self.hold.directions

    @property
    def moves(self) -> list[str]:
        """What has moved it since the solver, in words."""
        moves = ["strengthened"] if self.strengthened else []
        if self.restarts:
            return [*moves, "re-searched"]
        retracted = self.clearance is not None and self.clearance.status == "retracted"
        return [*moves, "retracted"] if retracted else moves

    @property
    def is_done(self) -> bool:
        """Whether every stage has had its say."""
        return self.hold is not None or (self.clearance is not None and not self.is_clear)

    @property
    def is_good(self) -> bool:
        """Certified, clear and held: what a run looks for."""
        return self.certified and self.is_clear and self.is_held


class GraspFile(GraspRecord):
    """`grasps/<id>.json`: a grasp that can be read without its run.

    Attributes:
        holdfast: version that wrote the file.
        task: the task's name.
        task_source: built-in name, or path of the task file relative to this file.
        task_fingerprint: hash of the task as it was.
        hand: the hand's name.
        object_name: the object's name.
    """

    holdfast: str
    task: str
    task_source: str
    task_fingerprint: str = ""
    hand: str
    object_name: str


class Round(FileModel):
    """One call of the solver.

    Attributes:
        seed: the random seed of this round.
        verdict: `solved`, `infeasible` or `undecided`.
        seconds: wall-clock time.
        boxes: boxes processed.
        lps: linear programmes solved.
        found: configurations that no earlier round had found.
        whole: False where the run was stopped meanwhile; a resumed run does such a round again.
        spread: how different the configurations are, by the solver's measures.
    """

    seed: int
    verdict: Literal["solved", "infeasible", "undecided"]
    seconds: float
    boxes: int
    lps: int
    found: int
    whole: bool = True
    spread: dict[str, float] | None = None


class Solve(FileModel):
    """What the solver did, summed over its rounds.

    Attributes:
        verdict: `solved` where a round found something, else the last round's.
        seconds: wall-clock time.
        boxes: boxes processed.
        lps: linear programmes solved.
        sigma: width at which boxes are no longer split.
        rounds: the calls one by one.
    """

    verdict: Literal["solved", "infeasible", "undecided"]
    seconds: float
    boxes: int
    lps: int
    sigma: float
    rounds: list[Round]

    @classmethod
    def of(cls, rounds: list[Round], sigma: float) -> "Solve":
        """The sum of at least one round."""
        return cls(
            verdict="solved" if any(entry.found for entry in rounds) else rounds[-1].verdict,
            seconds=sum(entry.seconds for entry in rounds),
            boxes=sum(entry.boxes for entry in rounds),
            lps=sum(entry.lps for entry in rounds),
            sigma=sigma,
            rounds=rounds,
        )


class RunRecord(FileModel):
    """`run.json`.

    Attributes:
        holdfast: version that wrote the file.
        task: the task's name.
        task_source: built-in name, or path of the task file relative to this file.
        task_fingerprint: hash of the task as it was.
        hand: the hand's name.
        object: the object's name.
        seed: random seed.
        settings: what was asked for, and the settings of the hold test.
        verdict: `held` where a grasp is certified, clear and held.
        complete: False while the run is under way, or where it was stopped.
        seconds: wall-clock time by stage.
        solve: None before the solver has answered.
        grasps: the best first.
    """

    holdfast: str
    task: str
    task_source: str
    task_fingerprint: str
    hand: str
    object: str
    seed: int
    settings: dict[str, Setting] = {}
    verdict: Literal["held", "not held", "infeasible", "undecided"] = "undecided"
    complete: bool = False
    seconds: dict[str, float] = {}
    solve: Solve | None = None
    grasps: list[GraspRecord] = []

    @property
    def kind(self) -> Literal["lift", "turn", "press"]:
        """What was tested, as far as a grasp has come to it."""
        return next((grasp.hold.kind for grasp in self.grasps if grasp.hold is not None), "lift")

    @property
    def good(self) -> list[GraspRecord]:
        """The grasps that are certified, clear and held, best first."""
        return [grasp for grasp in self.grasps if grasp.is_good]


def read_grasp(path: Path) -> GraspFile:
    """Reads `grasps/<id>.json`.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return parse(GraspFile, read_json(path), path)


def read_run(path: Path) -> RunRecord:
    """Reads `run.json`.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return parse(RunRecord, read_json(path), path)


def to_json(record: FileModel) -> dict[str, Any]:
    """The record as plain data."""
    return record.model_dump(mode="json")
