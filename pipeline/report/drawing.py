"""The pictures of a run, drawn while this process waits for others and, what is left, after that."""

from collections.abc import Callable, Generator, Mapping
from types import TracebackType
from typing import Self, TypeVar

from ...base.machine.cancellation import Cancelled, cancellable
from ...base.text.console import Console
from ...errors import MissingBackend
from ...mjcf import HoldSettings
from ...mjcf.render import Studio
from ...objects import Task
from ..records import RunFolder, RunRecord
from .pictures import Drawn, draw_first, draw_grasps

__all__ = ["Drawing"]

ResultT = TypeVar("ResultT")


class Drawing:
    """Draws the pictures of a run one by one.

    What they show is settled once all grasps have their verdicts: measures that come later change no picture
    and no order. A drawing that is left before its end is gone on with by a resumed run.

    Args:
        task: of the run.
        folder: of the run.
        settings: of its hold test.
        known: see `draw_grasps`.
        console: where progress goes.
        should_stop: whether to end early.
    """

    def __init__(
        self,
        task: Task,
        folder: RunFolder,
        settings: HoldSettings,
        known: Mapping[str, Drawn],
        *,
        console: Console,
        should_stop: Callable[[], bool],
    ):
        self._task, self._folder, self._settings, self._known = task, folder, settings, known
        self._console, self._should_stop = console, should_stop
        self._studio = Studio(task, transparent=True)
        self._pictures: Generator[bool, None, None] | None = None
        self._count = console.count("drawing", 0)
        self._failed: MissingBackend | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._pictures is not None:
            self._pictures.close()
        self._studio.close()

    def get_ready(self) -> bool:
        """Sets up what draws, which may be done long before; False where that has been done."""
        if self._failed is not None or self._studio.is_ready:
            return False
        self._try(self._studio.get_ready)
        return True

    def begin(self, record: RunRecord) -> None:
        """Has the pictures of a record drawn from now on, whose grasps are in their final order."""
        self._pictures = draw_grasps(self._studio, record, self._folder, self._settings, self._known)
        self._count = self._console.count("drawing", len(record.grasps))

    def first(self, record: RunRecord) -> None:
        """Draws the first grasp of a run that was given up, from one side.

        Raises:
            MissingBackend: nothing can be drawn here.
        """
        draw_first(self._studio, record, self._folder, self._known)

    def step(self) -> bool:
        """Draws the next picture; False where there is none, the run is to stop, or nothing can be drawn."""
        if self._pictures is None or self._failed is not None:
            return False
        pictures = self._pictures
        is_last_of_grasp = self._try(lambda: next(pictures, None))
        self._count.done += bool(is_last_of_grasp)
        return is_last_of_grasp is not None

    def finish(self) -> None:
        """Draws what is left.

        Raises:
            MissingBackend: nothing can be drawn here.
        """
        self._console.say("drawing")
        while not self._should_stop() and self.step():
            self._count.show()
        if self._failed is not None:
            raise self._failed

    def _try(self, draw: Callable[[], ResultT]) -> ResultT | None:
        """What comes of drawing, None where that ends early; what is amiss with it is said at the end."""
        try:
            with cancellable(self._should_stop):
                return draw()
        except MissingBackend as error:
            self._failed = error
        except Cancelled:
            pass
        return None
