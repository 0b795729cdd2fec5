"""How far a batch is, how fast each stage goes, and how long it will take."""

import time
from dataclasses import dataclass, field

from .outcome import Outcome

__all__ = ["Progress"]

_STAGES = ("solved", "certified", "clear", "tested", "good")


@dataclass
class Progress:
    """Counts what came of items since this batch was taken up.

    Attributes:
        total: items of the batch.
        before: of these, how many were done before.
        done: how many have been since.
        failed: how many of these are not done for whatever reason.
        counts: grasps by the stage that they have come to.
        seconds: what each stage took, over all items.
    """

    total: int
    before: int = 0
    done: int = 0
    failed: int = 0
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(_STAGES, 0))
    seconds: dict[str, float] = field(default_factory=dict)
    started: float = field(default_factory=time.monotonic)

    def add(self, outcome: Outcome) -> None:
        """Counts an item."""
        self.done += 1
        self.failed += outcome.state != "done"
        for run in outcome.runs:
            for stage in _STAGES:
                self.counts[stage] += getattr(run, stage)
            for stage, spent in run.seconds.items():
                self.seconds[stage] = self.seconds.get(stage, 0.0) + spent

    @property
    def elapsed_s(self) -> float:
        """Since this batch was taken up."""
        return time.monotonic() - self.started

    @property
    def left_s(self) -> float | None:
        """How long the rest will take at the pace so far; None before anything is known."""
        if not self.done:
            return None
        return self.elapsed_s / self.done * (self.total - self.before - self.done)

    def __str__(self) -> str:
        minutes = max(self.elapsed_s, 1e-9) / 60.0
        rates = ", ".join(f"{count / minutes:.1f} {stage}" for stage, count in self.counts.items())
        said = [f"{self.before + self.done} of {self.total}"]
        if self.failed:
            said.append(f"{self.failed} failed")
        said.append(f"a minute: {rates}")
        if self.done and self.seconds:
            stages = ", ".join(f"{name} {spent / self.done:.1f} s" for name, spent in self.seconds.items())
            said.append(f"a task: {stages}")
        if self.left_s is not None:
            said.append(f"{_duration(self.left_s)} left")
        return "; ".join(said)


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
