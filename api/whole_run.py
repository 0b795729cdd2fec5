"""The whole chain from Python: solve, make grasps, hold, and a folder with the report."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from ..console import Console
from ..errors import MissingBackend
from ..notebook import html_table
from ..objects import Task, load_task
from ..pipeline.records import GraspRecord, RunRecord
from ..pipeline.run import RunSettings, choose_folder, run_task

__all__ = ["Run", "run"]


@dataclass(frozen=True, eq=False, repr=False)
class Run:
    """What a run found: a sequence of grasps, the best first.

    Attributes:
        folder: the run folder.
        record: what its `run.json` says.
    """

    folder: Path
    record: RunRecord

    @property
    def verdict(self) -> str:
        """One of held, not held, infeasible, undecided."""
        return self.record.verdict

    @property
    def report(self) -> Path:
        """The page with tables and pictures."""
        return self.folder / "report.html"

    @property
    def good(self) -> list[GraspRecord]:
        """The grasps that are certified, clear and held."""
        return list(self.record.good)

    def __len__(self) -> int:
        return len(self.record.grasps)

    def __iter__(self) -> Iterator[GraspRecord]:
        return iter(self.record.grasps)

    def __getitem__(self, index: int) -> GraspRecord:
        return self.record.grasps[index]

    def __str__(self) -> str:
        held = f"{len(self.good)} of {len(self)} grasps certified, clear and held"
        return f"{self.record.task}: {self.verdict}; {held}; {self.report}"

    def __repr__(self) -> str:
        return f"<Run {self}>"

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


_SHOWN = ("grasp", "certified", "clear", "held", "depth_m", "slip_m", "margin")


def _row(grasp: GraspRecord) -> dict[str, Any]:
    hold, clearance = grasp.hold, grasp.clearance
    return {
        "grasp": grasp.id,
        "certified": grasp.certified,
        "clear": grasp.is_clear,
        "held": grasp.is_held,
        "residual_m": grasp.residual,
        "depth_m": max(0.0, -clearance.after) if clearance else None,
        "slip_m": hold.slip if hold else None,
        "margin": hold.margin if hold else None,
        **{f"quality.{name}": value for name, value in grasp.quality.items()},
        **{f"joint.{name}": value for name, value in grasp.joints.items()},
    }


def run(
    task: Task | str | Path,
    out: str | Path | None = None,
    *,
    resume: bool = False,
    force: bool = False,
    quiet: bool = True,
    should_stop: Callable[[], bool] | None = None,
    **settings: Any,
) -> Run:
    """Runs every stage on a task, as `holdfast run` does, and leaves a run folder.

    Args:
        task: a task, the name of a built-in one, or the path of a task file.
        out: the run folder; `runs/<task>` unless given.
        resume: continue what an earlier run with the same task and settings left there.
        force: replace the run that lies there, also one with another task, seed or settings. Without it such
            a run is refused where `out` is given, and goes into a folder with a number where it is not.
        quiet: whether to keep progress off the terminal.
        should_stop: asked between steps; the run ends early where it answers True.
        **settings: fields of `pipeline.run.RunSettings`, such as `candidates=8`, `seed=1`, `workers=2`.

    Raises:
        InputError: a task, a folder or a setting that can't be used.
    """
    chosen = RunSettings.from_names(**settings)
    loaded = task if isinstance(task, Task) else load_task(task)
    folder = Path(out) if out is not None else Path("runs") / loaded.name
    if out is None and not force:
        folder = choose_folder(loaded, folder, chosen)
    record = run_task(
        task,
        folder,
        chosen,
        resume=resume,
        force=force,
        console=Console(quiet=quiet),
        **({} if should_stop is None else {"should_stop": should_stop}),
    )
    return Run(folder, record)
