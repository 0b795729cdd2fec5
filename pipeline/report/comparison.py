"""In what two runs differ: settings, counts, verdicts by grasp, times."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from ..records import RunRecord
from .formats import setting_text
from .why import stage_word

__all__ = ["Comparison", "Row", "compare_runs"]


@dataclass(frozen=True)
class Row:
    """Something of both runs, in words; `-` where a run has none."""

    name: str
    first: str
    second: str

    @property
    def differs(self) -> bool:
        """Whether it is not the same in both."""
        return self.first != self.second


@dataclass(frozen=True)
class Comparison:
    """Two runs beside each other.

    Attributes:
        settings: what was asked for and what it was made with, as far as it differs.
        counts: verdict, and how many grasps came how far; all of them.
        grasps: by id, how far each came, as far as that differs.
        same_grasps: how many came equally far.
        times: seconds by stage; all of them.
    """

    settings: list[Row]
    counts: list[Row]
    grasps: list[Row]
    same_grasps: int
    times: list[Row]

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def compare_runs(first: RunRecord, second: RunRecord) -> Comparison:
    """Compares two runs; grasps are matched by their ids, which means most where the task is the same."""
    settings = _rows(_settings(first), _settings(second))
    grasps = _rows(*({g.id: stage_word(g, run.kind) for g in run.grasps} for run in (first, second)))
    return Comparison(
        [row for row in settings if row.differs],
        _rows(_counts(first), _counts(second)),
        [row for row in grasps if row.differs],
        sum(not row.differs for row in grasps),
        _rows(
            *({name: f"{seconds:.1f}" for name, seconds in run.seconds.items()} for run in (first, second))
        ),
    )


def _rows(first: dict[str, str], second: dict[str, str]) -> list[Row]:
    names: Iterable[str] = dict.fromkeys([*first, *second])
    return [Row(name, first.get(name, "-"), second.get(name, "-")) for name in names]


def _settings(run: RunRecord) -> dict[str, str]:
    own = {
        "task": run.task,
        "task_fingerprint": run.task_fingerprint,
        "hand": run.hand,
        "object": run.object,
        "seed": str(run.seed),
        "quick": setting_text(run.quick),
        "holdfast": run.holdfast,
        **{name: setting_text(value) for name, value in run.settings.items()},
    }
    if run.made is None:
        return own
    made = {"system": run.made.system, "processor": run.made.processor, "workers": str(run.made.workers)}
    return own | made | {f"version of {name}": number for name, number in run.made.versions.items()}


def _counts(run: RunRecord) -> dict[str, str]:
    solve = run.solve
    figures = {
        "verdict": run.verdict + (", narrowly" if run.narrow else ""),
        "complete": setting_text(run.complete),
        "solved": None if solve is None else solve.solved,
        "boxes": None if solve is None else solve.boxes,
        "tried": len(run.grasps),
        "certified": sum(grasp.certified for grasp in run.grasps),
        "clear": sum(grasp.is_clear for grasp in run.grasps),
        "held": sum(grasp.is_held for grasp in run.grasps),
        "all three": len(run.good),
        "not narrowly": len(run.firm),
        "reachable": sum(grasp.approach is not None and grasp.approach.reachable for grasp in run.grasps),
    }
    return {name: "-" if value is None else str(value) for name, value in figures.items()}


def _times(run: RunRecord) -> dict[str, str]:
    return {name: f"{seconds:.1f}" for name, seconds in run.seconds.items()}
