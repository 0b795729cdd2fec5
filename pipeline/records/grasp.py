"""Grasps in their written form: `grasps/<id>.json`, and the entries of `run.json`."""

from pathlib import Path
from typing import Literal, Self, TypeVar

from ... import __version__
from ...base.files.fields import Finite
from ...base.files.file_model import FileModel, parse
from ...base.files.json_file import read_json
from ...errors import InputError
from .evidence import EvidenceRecord
from .hold import Hold
from .solution import Solution

__all__ = ["Approach", "Clearance", "GraspFile", "GraspRecord", "parse_record", "read_grasp", "updated"]


_GraspT = TypeVar("_GraspT", bound="GraspRecord")
ModelT = TypeVar("ModelT", bound=FileModel)


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
        carried_before: what could be carried before retraction, at the friction that is planned with first:
            multiples of the load or, below zero, minus the imbalance; None where nothing was to be carried.
        carried_after: the same after.
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
    carried_before: Finite | None = None
    carried_after: Finite | None = None

    @property
    def took_balance(self) -> bool:
        """Whether retraction ended where forces don't balance that did before."""
        before, after = self.carried_before, self.carried_after
        return before is not None and after is not None and after < 0.0 <= before


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
        evidence: what was proved beside the verdict; None where that was not looked for.
    """

    strengthened: bool = False
    restarts: int = 0
    clearance: Clearance | None = None
    approach: Approach | None = None
    quality: dict[str, float] = {}
    hold: Hold | None = None
    evidence: EvidenceRecord | None = None

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
    def lacks_extras(self) -> bool:
        """Whether it has its verdict, and its measures, evidence or a margin are still to be found."""
        if self.hold is None:
            return False
        if self.is_clear and not (self.is_measured and self.evidence is not None):
            return True
        return self.hold.held and self.hold.margin is None

    @property
    def has_motion(self) -> bool:
        """Whether the motion of its test was kept, or a curve of it."""
        directions = () if self.hold is None else self.hold.directions
        return any(entry.motion or entry.curve or entry.rotation_curve for entry in directions)

    def without_motion(self) -> Self:
        """The grasp without what only drawings need, which is more than half of it."""
        if self.hold is None or not self.has_motion:
            return self
        nothing: dict[str, list[float]] = {"motion": [], "curve": [], "rotation_curve": []}
        directions = [entry.model_copy(update=nothing) for entry in self.hold.directions]
        return self.model_copy(update={"hold": self.hold.model_copy(update={"directions": directions})})

    def with_motion_of(self, other: "GraspRecord") -> Self:
        """The grasp with the motion of the same test as another record of it has kept it."""
        if self.hold is None or other.hold is None:
            return self
        kept = zip(self.hold.directions, other.hold.directions, strict=False)
        names = ("motion", "curve", "rotation_curve")
        directions = [a.model_copy(update={name: getattr(b, name) for name in names}) for a, b in kept]
        if len(directions) != len(self.hold.directions):
            return self
        return self.model_copy(update={"hold": self.hold.model_copy(update={"directions": directions})})

    @property
    def is_measured(self) -> bool:
        """Whether the analytic measures of its configuration are known."""
        return "epsilon" in self.quality

    @property
    def is_good(self) -> bool:
        """Certified, clear and held: what a run looks for."""
        return self.certified and self.is_clear and self.is_held

    @property
    def is_narrow(self) -> bool:
        """Whether it is held, but narrowly: not with one finger first, say, or with less spin friction."""
        return self.hold is not None and self.hold.held and self.hold.narrow is True

    @property
    def is_near_miss(self) -> bool:
        """Whether it failed its test, but narrowly: it would pass with limits somewhat wider."""
        return self.hold is not None and not self.hold.held and self.hold.near_miss is True


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


def read_grasp(path: Path) -> GraspFile:
    """Reads `grasps/<id>.json`.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return parse_record(GraspFile, path)


def parse_record(model: type[ModelT], path: Path) -> ModelT:
    """Reads a file whose field `holdfast` says which version wrote it.

    Raises:
        InputError: naming the file, the field and what is allowed, and the version where it is another.
    """
    data = read_json(path)
    try:
        return parse(model, data, path)
    except InputError as error:
        version = data.get("holdfast")
        if not isinstance(version, str) or version == __version__:
            raise
        words = f"{error.allowed} (written by version {version[:40]!r}; this is {__version__!r})"
        raise InputError(path, error.field, words) from None


def updated(grasp: _GraspT, **found: object) -> _GraspT:
    """The grasp with what a stage has found, validated anew."""
    return type(grasp).model_validate({**dict(grasp), **found})
