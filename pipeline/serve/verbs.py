"""What can be asked for, and the command line that does it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import Field

from ...base.files.file_model import FileModel, parse
from ...errors import UnknownName
from .inside import check_inside

__all__ = ["VERBS", "Verb", "read_request"]

# Names of tasks, hands and objects, and paths; what begins with a dash would be an option.
Name = Annotated[str, Field(min_length=1, max_length=300, pattern=r"^[\w.][^\x00-\x1f]*$")]
Count = Annotated[int, Field(ge=1, le=1000)]
Seed = Annotated[int, Field(ge=0, le=2**31)]
Seconds = Annotated[float, Field(gt=0.0, le=86_400.0)]
PICTURES = "shown"
"""Folder of the pictures, below the served one."""


class Verb(FileModel):
    """A request; its fields are those that a client sends."""

    summary: ClassVar[str]
    """What it does, for people and for language models."""

    def words(self) -> list[str]:
        """The words after `holdfast`."""
        raise NotImplementedError

    def names(self) -> dict[str, str]:
        """Those of its fields that may be paths."""
        raise NotImplementedError

    @property
    def picture(self) -> str | None:
        """The picture that is the answer, below the served folder; None where the answer is JSON."""
        return None


class Solve(Verb):
    """Configurations of a task."""

    summary: ClassVar[str] = (
        "Find certified hand configurations in which the hand's regions touch the object's, or prove that "
        "there are none. The verdict is solved, infeasible or undecided."
    )

    task: Name = Field(description="a built-in task, such as upholding, or the path of a task file or a mesh")
    hand: Name | None = Field(None, description="a built-in hand or a hand file, in place of the task's own")
    candidates: Count = Field(4, description="configurations to look for")
    seed: Seed = Field(0, description="random seed; the same one gives the same answer")
    budget_s: Seconds = Field(60.0, description="time after which to stop, in seconds")
    statics: bool = Field(False, description="first try to prove that the regions can't hold the load")
    explain_s: Seconds | None = Field(
        None, description="where it is infeasible, say what would help, with so many seconds for each reason"
    )

    def words(self) -> list[str]:
        """The words after `holdfast`."""
        words = [
            "solve",
            self.task,
            "--json=-",
            "--quiet",
            *_search(self.candidates, self.seed, self.budget_s),
        ]
        words += [f"--hand={self.hand}"] if self.hand else []
        words += ["--statics"] if self.statics else []
        return words + ([f"--explain={self.explain_s:g}"] if self.explain_s else [])

    def names(self) -> dict[str, str]:
        """Those of its fields that may be paths."""
        return {"task": self.task} | ({"hand": self.hand} if self.hand else {})


class Run(Verb):
    """Grasps of a task, tried in simulation."""

    summary: ClassVar[str] = (
        "Solve a task, free the grasps of penetration, squeeze them and test them in simulation. Writes a "
        "run folder with a report, and answers with its record, the best grasp first."
    )

    task: Name = Field(description="a built-in task, such as upholding, or the path of a task file or a mesh")
    hand: Name | None = Field(None, description="a built-in hand or a hand file, in place of the task's own")
    candidates: Count = Field(8, description="configurations that grasps are made of in each round")
    wanted: Annotated[int, Field(ge=0, le=1000)] | None = Field(
        None, description="grasps that should hold before no more are looked for"
    )
    enough: Annotated[int, Field(ge=1, le=1000)] | None = Field(
        None, description="in place of wanted: once so many hold, the others are not tested"
    )
    seed: Seed = Field(0, description="random seed; the same one gives the same answer")
    budget_s: Seconds = Field(120.0, description="time after which nothing new is begun, in seconds")
    quick: bool = Field(True, description="verdicts alone, without margins and pictures")
    replace: bool = Field(False, description="replace an earlier run of the same task")

    def words(self) -> list[str]:
        """The words after `holdfast`."""
        words = ["run", self.task, *_search(self.candidates, self.seed, self.budget_s)]
        words += [f"--hand={self.hand}"] if self.hand else []
        words += [] if self.wanted is None else [f"--wanted={self.wanted}"]
        words += [] if self.enough is None else [f"--enough={self.enough}"]
        return words + (["--quick"] if self.quick else []) + (["--force"] if self.replace else [])

    def names(self) -> dict[str, str]:
        """Those of its fields that may be paths."""
        return {"task": self.task} | ({"hand": self.hand} if self.hand else {})


class Verify(Verb):
    """A judgement of grasps that others made."""

    summary: ClassVar[str] = (
        "Judge grasps from files of other programs: do the fingers touch, does anything sink in, do they "
        "hold in simulation, and is there a certified grasp nearby?"
    )

    files: Annotated[list[Name], Field(min_length=1, max_length=20)] = Field(
        description="files of grasps, of any format that is read"
    )
    hand: Name = Field(description="a built-in hand, or the path of its file or model")
    object: Name = Field(description="a built-in object, or the path of an object file or a mesh")
    mass_kg: Annotated[float, Field(gt=0.0, le=1e6)] | None = Field(None, description="mass of a mesh, in kg")
    friction: Annotated[float, Field(gt=0.0, le=10.0)] | None = Field(None, description="friction of a mesh")
    count: Count | None = Field(None, description="judge the first ones alone")
    hold: bool = Field(False, description="try them in simulation, by every protocol of hold tests")
    nearby: bool = Field(True, description="look for certified grasps nearby")

    def words(self) -> list[str]:
        """The words after `holdfast`."""
        words = [
            "verify",
            *self.files,
            f"--hand={self.hand}",
            f"--object={self.object}",
            "--json=-",
            "--quiet",
        ]
        words += [f"--mass={self.mass_kg:g}"] if self.mass_kg else []
        words += [f"--friction={self.friction:g}"] if self.friction else []
        words += [f"--count={self.count}"] if self.count else []
        return words + ([] if self.hold else ["--no-hold"]) + ([] if self.nearby else ["--no-nearby"])

    def names(self) -> dict[str, str]:
        """Those of its fields that may be paths."""
        files = {f"files.{i}": name for i, name in enumerate(self.files)}
        return {**files, "hand": self.hand, "object": self.object}


class Show(Verb):
    """A picture."""

    summary: ClassVar[str] = (
        "Draw an object, a hand, a task or a grasp file with its contact regions and a scale."
    )

    name: Name = Field(
        description="a built-in object, hand or task, or the path of a file of one, or of a grasp"
    )
    view: Annotated[str, Field(pattern=r"^([a-z]+|-?[\d.]{1,9},-?[\d.]{1,9})$")] | None = Field(
        None, description="front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees"
    )

    def words(self) -> list[str]:
        """The words after `holdfast`."""
        words = ["show", self.name, f"--out={self.picture}", "--quiet"]
        return words + ([f"--view={self.view}"] if self.view else [])

    def names(self) -> dict[str, str]:
        """Those of its fields that may be paths."""
        return {"name": self.name}

    @property
    def picture(self) -> str:
        """The picture that is the answer, below the served folder."""
        safe = "".join(c if c.isalnum() or c in "-_" else "_" for c in self.name)
        return f"{PICTURES}/{safe[:100]}.png"


def _search(candidates: int, seed: int, budget_s: float) -> list[str]:
    numbers = [f"--candidates={candidates}", f"--seed={seed}", f"--budget={budget_s:g}"]
    return [*numbers, "--json=-", "--quiet"]


VERBS: dict[str, type[Verb]] = {"solve": Solve, "run": Run, "verify": Verify, "show": Show}
"""By name."""


def read_request(verb: str, data: Mapping[str, object], folder: Path) -> Verb:
    """A request, as far as it can be judged without doing it.

    Args:
        verb: which of `VERBS`.
        data: its fields.
        folder: whatever it names has to lie below it.

    Raises:
        InputError: no such verb, a field that is not right, or a path that leads elsewhere.
    """
    if verb not in VERBS:
        raise UnknownName("serve", "", "verb", verb, VERBS)
    request = parse(VERBS[verb], dict(data), verb)
    for field, name in request.names().items():
        check_inside(folder, name, verb, field)
    return request
