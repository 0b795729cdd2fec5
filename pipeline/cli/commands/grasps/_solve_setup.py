"""What `holdfast solve` does alike with and without `--all`: task, options of the search, grasps."""

import argparse
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypedDict

from .....base.text.console import Console
from .....objects import Task, load_task
from .....solver import Configuration, Progress
from .....workers import available_cores
from ....records import Solution, to_solution, write_solutions

__all__ = ["SearchOptions", "SolveSetup"]


class SearchOptions(TypedDict):
    """Arguments that `solve` and `solve_all` share."""

    sigma: float
    budget_s: float
    workers: int
    checkpoint: str | None
    resume: bool
    on_progress: "Callable[[Progress], None]"
    should_stop: Callable[[], bool]


class SolveSetup:
    """The task of one call of the command, and where its words go.

    Args:
        arguments: of the command.
        reference: of the task, with the hand that is to do it.
        doing: what it is about to do, for people.

    Raises:
        InputError: there is no such task, or it is not valid.
    """

    def __init__(self, arguments: argparse.Namespace, reference: str, doing: str):
        self.arguments = arguments
        self.console = Console(quiet=arguments.quiet)
        self.reference = reference
        self.task: Task = load_task(self.reference)
        self.console.say(f"{doing} {self.task.name}")

    @property
    def workers(self) -> int:
        """Processes to use."""
        return self.arguments.workers or available_cores()

    def options(self, found: str, should_stop: Callable[[], bool]) -> SearchOptions:
        """What both searches are told; `found` says what it is that progress counts."""
        return SearchOptions(
            sigma=self.arguments.sigma,
            budget_s=self.arguments.budget,
            workers=self.workers,
            checkpoint=self.arguments.checkpoint,
            resume=self.arguments.resume,
            on_progress=lambda p: self.console.pass_by(
                f"  {p.found} {found}, {p.boxes} boxes done, {p.open} open, {p.depth} deep, "
                f"{p.decided:.1%} decided, {p.seconds:.0f} s"
            ),
            should_stop=should_stop,
        )

    def solutions(self, configurations: "Iterable[Configuration]") -> list[Solution]:
        """Configurations under their ids; written into the folder that was asked for."""
        solutions = [to_solution(c, f"g{i:02d}") for i, c in enumerate(configurations, start=1)]
        if self.arguments.out:
            write_solutions(Path(self.arguments.out), solutions, self.task, self.reference)
        return solutions
