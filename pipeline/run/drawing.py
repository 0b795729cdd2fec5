"""The pictures of a run, drawn while this process waits for others and, what is left, after that."""

from types import TracebackType
from typing import Self

from ...cancellation import Cancelled, cancellable
from ..records import RunRecord
from ..report import draw_grasps
from .under_way import RunUnderWay

__all__ = ["Drawing"]


class Drawing:
    """Draws the pictures of a run one by one.

    What they show is settled once all grasps have their verdicts: measures that come later change no picture
    and no order. A drawing that is left before its end is gone on with by a resumed run.

    Args:
        run: whose pictures they are.
        record: of the run, its grasps in their final order.
    """

    def __init__(self, run: RunUnderWay, record: RunRecord):
        self._run = run
        self._count = run.console.count("drawing", len(record.grasps))
        self._pictures = draw_grasps(run.task, record, run.folder, run.hold, run.drawn)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pictures.close()

    def step(self) -> bool:
        """Draws the next picture; False where there is none, or the run is to stop."""
        try:
            with cancellable(self._run.should_stop):
                is_last_of_grasp = next(self._pictures)
        except (StopIteration, Cancelled):
            return False
        self._count.done += is_last_of_grasp
        return True

    def finish(self) -> None:
        """Draws what is left."""
        self._run.console.say("drawing")
        while not self._run.should_stop() and self.step():
            self._count.show()
