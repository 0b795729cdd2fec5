"""The pictures of a run, drawn while this process waits for others and, what is left, after that."""

from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Self

from ...cancellation import Cancelled, cancellable
from ...console import Console
from ...mjcf import HoldSettings
from ...objects import Task
from ..records import RunFolder, RunRecord
from .pictures import Drawn, draw_grasps

__all__ = ["Drawing"]


class Drawing:
    """Draws the pictures of a run one by one.

    What they show is settled once all grasps have their verdicts: measures that come later change no picture
    and no order. A drawing that is left before its end is gone on with by a resumed run.

    Args:
        task: of the run.
        record: of the run, its grasps in their final order.
        folder: of the run.
        settings: of its hold test.
        known: see `draw_grasps`.
        console: where progress goes.
        should_stop: whether to end early.
    """

    def __init__(
        self,
        task: Task,
        record: RunRecord,
        folder: RunFolder,
        settings: HoldSettings,
        known: Mapping[str, Drawn],
        *,
        console: Console,
        should_stop: Callable[[], bool],
    ):
        self._pictures = draw_grasps(task, record, folder, settings, known)
        self._console, self._should_stop = console, should_stop
        self._count = console.count("drawing", len(record.grasps))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pictures.close()

    def step(self) -> bool:
        """Draws the next picture; False where there is none, or the run is to stop."""
        try:
            with cancellable(self._should_stop):
                is_last_of_grasp = next(self._pictures)
        except (StopIteration, Cancelled):
            return False
        self._count.done += is_last_of_grasp
        return True

    def finish(self) -> None:
        """Draws what is left."""
        self._console.say("drawing")
        while not self._should_stop() and self.step():
            self._count.show()
