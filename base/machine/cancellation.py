"""Long work that can be given up half way: what it has computed by then is dropped.

Deep loops ask `give_up_if_asked()`, which costs next to nothing; whoever started the work says by
`cancellable(...)` who is to be asked. Without that nobody is, and the work runs to its end.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

__all__ = ["Cancelled", "cancellable", "give_up_if_asked"]

_asked: ContextVar[Callable[[], bool] | None] = ContextVar("asked", default=None)


class Cancelled(Exception):
    """The work was given up."""


@contextmanager
def cancellable(should_stop: Callable[[], bool]) -> Iterator[None]:
    """Within it, `give_up_if_asked` raises once `should_stop` answers True."""
    token = _asked.set(should_stop)
    try:
        yield
    finally:
        _asked.reset(token)


def give_up_if_asked() -> None:
    """Ends the work under way where that is wanted.

    Raises:
        Cancelled: whoever started the work wants no more of it.
    """
    should_stop = _asked.get()
    if should_stop is not None and should_stop():
        raise Cancelled
