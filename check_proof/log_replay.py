"""The way through a log, from head to checksum, whatever it refutes."""

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Any

from .reading import Rejected

__all__ = ["LogReplay", "box_name"]


class LogReplay(ABC):
    """Takes the records of a log one by one.

    Attributes:
        boxes: boxes replayed.
        steps: hints among their records.
    """

    def __init__(self) -> None:
        self.boxes = 0
        self.steps = 0

    def run(self, records: Iterator[tuple[bytes, dict[str, Any]]], expected: Any) -> None:
        """Accepts the log by returning.

        Raises:
            Rejected: saying why.
        """
        digest = hashlib.sha256()
        digest.update(next(records)[0])
        for line, record in records:
            if "end" in record:
                self._finish(record["end"], digest.hexdigest())
                if next(records, None) is not None:
                    raise Rejected("something follows the last record")
                return
            digest.update(line)
            if "form" in record:
                self._begin(record["form"], expected)
            else:
                self._take(record)
        raise Rejected("the log breaks off: its last record is missing")

    @abstractmethod
    def _begin(self, form: Any, expected: Any) -> None:
        """Takes what the log is about, which must be as expected where that is given."""

    @abstractmethod
    def _take(self, record: dict[str, Any]) -> None:
        """Takes a box."""

    @abstractmethod
    def _finish(self, end: Any, digest: str) -> None:
        """Sees to it that nothing is left open and that nothing was changed."""


def box_name(path: str) -> str:
    """A box in words, however long its path."""
    return repr(path[:40] + ("..." if len(path) > 40 else "")) if path else "at the root"
