"""What `run.json` says."""

import re
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from ...base.files.fields import Count, Finite
from ...base.files.file_model import FileModel
from .alike import different
from .carrying import CarryingRecord
from .choosing import Choosing
from .explained import Explained
from .grasp import GraspRecord, parse_record
from .hold import Limit, Setting
from .made import Made

__all__ = ["MOST_SHOWN", "Round", "RunRecord", "SearchStep", "Solve", "read_run"]

MOST_SHOWN = 64
"""So many grasps of a run, the best ones, have a card, a picture and a place in the 3D view of its page, and
the motions of their tests in its record: with hundreds both would take tens of megabytes."""

_GRASP_NAME = re.compile(r"g[0-9]{2,9}")


class SearchStep(FileModel):
    """Where the search of a round stood.

    Attributes:
        boxes: boxes processed.
        open: boxes still to be processed.
        depth: splits above the deepest box.
        decided: share of the search space that is decided.
    """

    boxes: Count
    open: Count
    depth: Count
    decided: Finite


class Round(FileModel):
    """One call of the solver.

    Attributes:
        seed: the random seed of this round.
        verdict: `solved`, `infeasible` or `undecided`.
        seconds: wall-clock time.
        boxes: boxes processed.
        lps: linear programmes solved.
        solved: configurations that the solver gave, among which those to be tried were chosen; None in runs
            of versions that tried all.
        found: of these, how many are tried: none that an earlier round had found.
        whole: False where the run was stopped meanwhile; a resumed run does such a round again.
        spread: how different the configurations are that are tried, by the solver's measures.
        reason: `friction` where it is infeasible because its regions can't hold the load; else None.
        search: how the search went on, in at most 41 steps, the last of them where it ended.
    """

    seed: int
    verdict: Literal["solved", "infeasible", "undecided"]
    seconds: Finite
    boxes: Count
    lps: Count
    solved: Count | None = None
    found: Count
    whole: bool = True
    spread: dict[str, float] | None = None
    reason: Literal["friction"] | None = None
    search: list[SearchStep] = []


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
    rounds: Annotated[list[Round], Field(min_length=1)]

    @property
    def solved(self) -> int:
        """Configurations that the solver gave, tried or not."""
        return sum(entry.found if entry.solved is None else entry.solved for entry in self.rounds)

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
        hand_fingerprint: hash of the hand's model as it was; empty in runs of versions without it.
        object_fingerprint: the same of the object.
        seed: random seed.
        settings: what was asked for, and the settings of the hold test.
        verdict: `held` where a grasp is certified, clear and held.
        narrow: whether all grasps that are, are held narrowly.
        complete: False while the run is under way, or where it was stopped.
        quick: whether only verdicts were asked for: no margins, no pictures.
        enough: grasps that hold after which no other was to be tested; None where all are.
        seconds: wall-clock time by stage.
        made: where, when and with what it was begun; None in files of versions that did not say.
        carrying: what the contacts can carry; None where a stand carries the object.
        solve: None before the solver has answered.
        explained: of an infeasible run: what would make the task possible; None where it was not looked for.
        choosing: which grasps were tested first; None where no model has chosen.
        grasps: the best first; those after the first `MOST_SHOWN` without the motions of their tests, which
            their own files have.
    """

    holdfast: str
    task: str
    task_source: str
    task_fingerprint: str
    hand: str
    object: str
    hand_fingerprint: str = ""
    object_fingerprint: str = ""
    seed: int
    settings: dict[str, Setting] = {}
    verdict: Literal["held", "not held", "infeasible", "undecided"] = "undecided"
    narrow: bool = False
    complete: bool = False
    quick: bool = False
    enough: Count | None = None
    seconds: dict[str, float] = {}
    made: Made | None = None
    carrying: CarryingRecord | None = None
    solve: Solve | None = None
    explained: Explained | None = None
    choosing: Choosing | None = None
    grasps: list[GraspRecord] = []

    @model_validator(mode="after")
    def _own_names(self) -> "RunRecord":
        """A run calls its grasps g01, g02, ...; other names, or one twice, it could not take up again."""
        seen = set[str]()
        for i, grasp in enumerate(self.grasps):
            if not _GRASP_NAME.fullmatch(grasp.id) or grasp.id in seen:
                raise ValueError(f"grasps.{i}.id must be g and a number that no other has, not {grasp.id!r}")
            seen.add(grasp.id)
        found = 0 if self.solve is None else sum(entry.found for entry in self.solve.rounds)
        if len(self.grasps) != found:
            raise ValueError(f"{len(self.grasps)} grasps are listed, but {found} were found in solve.rounds")
        return self

    @property
    def kind(self) -> Literal["lift", "turn", "press"]:
        """What was tested, as far as a grasp has come to it."""
        return next((grasp.hold.kind for grasp in self.grasps if grasp.hold is not None), "lift")

    @property
    def lacks_friction(self) -> bool:
        """Whether it is infeasible because no forces at the object's regions can hold the load."""
        return self.solve is not None and self.solve.rounds[-1].reason == "friction"

    @property
    def limit(self) -> Limit | None:
        """Where no grasp is good: what keeps the strongest of them from carrying its load by plan."""
        holds = [grasp.hold for grasp in self.grasps if grasp.hold is not None]
        if self.good or not all(hold.limit is not None for hold in holds):
            return None  # a plan carries the load, and what the matter is the tests say
        limits = [hold.limit for hold in holds if hold.limit is not None]
        return max(limits, key=lambda limit: limit.load_factor, default=None)

    @property
    def good(self) -> list[GraspRecord]:
        """The grasps that are certified, clear and held, best first."""
        return [grasp for grasp in self.grasps if grasp.is_good]

    @property
    def different(self) -> list[GraspRecord]:
        """Those of the good ones that are like no better one: see `alike`."""
        return different(self.good)

    @property
    def has_enough(self) -> bool:
        """Whether as many hold as were to be tested for, one of them not narrowly."""
        return self.enough is not None and len(self.good) >= self.enough and bool(self.firm)

    @property
    def left_untested(self) -> list[GraspRecord]:
        """Grasps that were found and not tested, as enough hold."""
        return [grasp for grasp in self.grasps if not grasp.is_done] if self.has_enough else []

    @property
    def firm(self) -> list[GraspRecord]:
        """Those among them that are not held narrowly."""
        return [grasp for grasp in self.good if not grasp.is_narrow]


def read_run(path: Path) -> RunRecord:
    """Reads `run.json`.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return parse_record(RunRecord, path)
