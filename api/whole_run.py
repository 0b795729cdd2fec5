"""The whole chain from Python, of a task or a mesh: solve, make grasps, hold, and write the report."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from ..arguments import check_name_or_path, check_path, check_whole_number
from ..base.text.console import Console
from ..base.text.notebook import html_table
from ..errors import InputError, MissingBackend
from ..objects import Task, load_task, names_object, with_hand
from ..pipeline.records import GraspRecord, RunRecord
from ..pipeline.run import RunSettings, choose_folder, folder_name, free_folder, run_task
from ..pipeline.run_object import GraspRequest, ObjectRun, run_object

__all__ = ["MeshRun", "Run", "run"]


class _Grasps(ABC):
    """A sequence of grasps with their figures."""

    @property
    @abstractmethod
    def grasps(self) -> list[GraspRecord]:
        """All of them, the best first."""

    @property
    def good(self) -> list[GraspRecord]:
        """The grasps that are certified, clear and held."""
        return [grasp for grasp in self.grasps if grasp.is_good]

    def __len__(self) -> int:
        return len(self.grasps)

    def __iter__(self) -> Iterator[GraspRecord]:
        return iter(self.grasps)

    def __getitem__(self, index: int) -> GraspRecord:
        return self.grasps[index]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    def _repr_html_(self) -> str:
        rows = [tuple(row[name] for name in _SHOWN) for row in self.rows()]
        return html_table(str(self), list(_SHOWN), rows)

    def rows(self) -> list[dict[str, Any]]:
        """A row for each grasp: verdicts, figures (SI units) and joints, by name."""
        return [_row(grasp) for grasp in self]

    def to_frame(self) -> Any:
        """The rows as a pandas data frame, indexed by the grasps' names.

        Raises:
            MissingBackend: pandas is not installed.
        """
        try:
            pandas = import_module("pandas")
        except ModuleNotFoundError:
            raise MissingBackend("to_frame needs pandas: pip install pandas, or take rows()") from None
        return pandas.DataFrame(self.rows()).set_index("grasp")


@dataclass(frozen=True, eq=False, repr=False)
class Run(_Grasps):
    """What a run found: a sequence of grasps, the best first.

    Attributes:
        folder: the run folder.
        record: what its `run.json` says.
    """

    folder: Path
    record: RunRecord

    @property
    def grasps(self) -> list[GraspRecord]:
        """All grasps, the best first."""
        return self.record.grasps

    @property
    def verdict(self) -> str:
        """One of held, not held, infeasible, undecided."""
        return self.record.verdict

    @property
    def report(self) -> Path:
        """The page with tables and pictures."""
        return self.folder / "report.html"

    def __str__(self) -> str:
        held = f"{len(self.good)} of {len(self)} grasps certified, clear and held"
        return f"{self.record.task}: {self.verdict}; {held}; {self.report}"


@dataclass(frozen=True, eq=False, repr=False)
class MeshRun(_Grasps):
    """What became of a mesh: the grasps of all tasks that were tried, those of the best task first.

    Attributes:
        outcome: the tasks that were tried, and what refused the others; in words when printed.
    """

    outcome: ObjectRun

    @property
    def runs(self) -> list[Run]:
        """The run of each task whose folder is there still, the one with the most grasps that hold first."""
        last = {attempt.folder: attempt for attempt in self.outcome.attempts}
        ordered = sorted(last.values(), key=lambda attempt: -len(attempt.record.good))
        return [Run(attempt.folder, attempt.record) for attempt in ordered]

    @property
    def grasps(self) -> list[GraspRecord]:
        """All grasps."""
        return [grasp for one in self.runs for grasp in one]

    @property
    def verdict(self) -> str:
        """Held where some grasp held, else that of the last task, or undecided where there was none."""
        return self.runs[0].verdict if self.runs else "undecided"

    @property
    def report(self) -> Path | None:
        """The page of the best task."""
        return self.runs[0].report if self.runs else None

    def __str__(self) -> str:
        return str(self.outcome)


_SHOWN = ("grasp", "certified", "clear", "held", "depth_m", "slip_m", "margin")


def _row(grasp: GraspRecord) -> dict[str, Any]:
    hold, clearance, evidence = grasp.hold, grasp.clearance, grasp.evidence
    return {
        "grasp": grasp.id,
        "certified": grasp.certified,
        "clear": grasp.is_clear,
        "held": grasp.is_held,
        "reachable": grasp.approach.reachable if grasp.approach else None,
        "residual_m": grasp.residual,
        "depth_m": max(0.0, -clearance.after) if clearance else None,
        "slip_m": hold.slip if hold else None,
        "margin": hold.margin if hold else None,
        "slack_N": evidence.stable.slack if evidence and evidence.stable else None,
        "proved_clear": bool(evidence and evidence.clear),
        **{f"quality.{name}": value for name, value in grasp.quality.items()},
        **{f"joint.{name}": value for name, value in grasp.joints.items()},
    }


def run(
    task: Task | str | Path,
    out: str | Path | None = None,
    *,
    hand: str | Path | None = None,
    resume: bool = False,
    force: bool = False,
    quiet: bool = True,
    should_stop: Callable[[], bool] | None = None,
    mass_kg: float | None = None,
    friction: float | None = None,
    scale: float | None = None,
    units: str | None = None,
    contacts: int | None = None,
    save: str | Path | None = None,
    **settings: Any,
) -> "Run | MeshRun":
    """Runs every stage on a task, or on an object that has none, as `holdfast run` does; leaves a run folder.

    Args:
        task: a task, the name of a built-in one, or the path of a task file; or an object: the path of a
            mesh or an object file, or the name of a built-in one. Then contacts are looked for, and tried in
            turn until enough grasps hold.
        out: the run folder; `runs/<task>`, or `runs/<object>_<hand>`, unless given.
        hand: name of a built-in hand or path of a hand file, in place of the task's own, or for the object
            (`sa` unless given).
        resume: continue what an earlier run with the same task and settings left there.
        force: replace the run that lies there, also one with another task, seed or settings. Without it such
            a run is refused where `out` is given, and goes into a folder with a number where it is not.
        quiet: whether to keep progress off the terminal.
        should_stop: asked between steps; the run ends early where it answers True.
        mass_kg: of a mesh; that of 500 kg/m^3 unless given.
        friction: of a mesh; 0.6 unless given.
        scale: factor on a mesh's coordinates.
        units: their unit, `m` unless given; `cm`, `mm`, `in` or `ft`.
        contacts: pairs of regions on an object; as few as can carry it, and one more, in turn, unless given.
        save: folder for the files that are made of an object; `<run folder>_task` unless given.
        **settings: fields of `pipeline.run.RunSettings`, such as `candidates=8`, `seed=1`, `workers=2`.

    Raises:
        InputError: a task, a mesh, a folder or a setting that can't be used.
    """
    chosen = RunSettings.from_names(**settings)
    if hand is not None:
        hand = check_name_or_path(hand, "run", "hand", "must be the name of a built-in hand, or a path")
    asked = None if out is None else check_path("out", out)
    stop = should_stop or (lambda: False)
    figures: dict[str, object] = {"mass_kg": mass_kg, "friction": friction, "scale": scale, "units": units}
    figures |= {"contacts": contacts, "save": save}
    if not isinstance(task, Task) and names_object(str(task)):
        request = GraspRequest(
            str(task),
            "sa" if hand is None else hand,
            mass_kg=mass_kg,
            friction=friction,
            scale=scale,
            units=units,
            contacts=None if contacts is None else check_whole_number("contacts", contacts, least=2),
        )
        folder = asked or Path("runs") / folder_name(request.name)
        if out is None and not force and not resume:
            folder = free_folder(folder)
        saved = None if save is None else check_path("save", save)
        console = Console(quiet=quiet)
        return MeshRun(
            run_object(
                request,
                folder,
                chosen,
                save=saved,
                resume=resume,
                force=force,
                console=console,
                should_stop=stop,
            )
        )
    for name, given in figures.items():
        if given is not None:
            goes_with = "an object" if name in ("contacts", "save") else "a mesh file"
            raise InputError("run", name, f"goes with {goes_with}; a task has its own")
    if hand is not None:
        if isinstance(task, Task):
            raise InputError("run", "hand", "goes with the name of a task, or a path; this task has its own")
        task = with_hand(str(task), hand)
    loaded = task if isinstance(task, Task) else load_task(task)
    folder = asked or Path("runs") / folder_name(loaded.name)
    if out is None and not force:
        folder = choose_folder(loaded, folder, chosen)
    console = Console(quiet=quiet)
    record = run_task(task, folder, chosen, resume=resume, force=force, console=console, should_stop=stop)
    return Run(folder, record)
