"""Writes the log of a statics tree; `check_proof` replays it, docs/proof-log.md describes it."""

from pathlib import Path
from typing import Any

from ... import __version__
from ..proof import LogWriter
from .problem import StaticsProblem
from .worker import StaticsRecord

__all__ = ["StaticsLog"]

# What refutes boxes by a hand came with the second.
_VERSION, _WITH_HAND = 1, 2


class StaticsLog:
    """Collects the boxes of a statics tree and writes them as a whole.

    Args:
        path: where `finish` writes; checked at once, for a search may take long.
        problem: what the tree is of.
    """

    def __init__(self, path: str | Path, problem: StaticsProblem):
        self._claim = problem.claim
        version = _WITH_HAND if "hand" in problem.form else _VERSION
        head = {f"holdfast_{problem.log}": version, "holdfast": __version__, "task": problem.task}
        self._writer = LogWriter(path, head)
        self._writer.add({"form": problem.form})
        self._boxes = 0

    def add(self, record: StaticsRecord) -> None:
        """Adds a box; its parent comes before it."""
        entry: dict[str, Any] = {"box": record.box.name}
        if record.cut is not None:
            entry["split"] = [record.cut[0], record.cut[1]]
        elif record.unreached is not None:
            entry["unreached"] = [[path, steps, cut] for path, steps, cut in record.unreached]
        else:
            assert record.box.twist is not None, "a box is refuted by a twist"
            entry["twist"] = [int(x) for x in record.box.twist]
            if record.box.along is not None:
                entry["along"] = [[int(x) for x in e] for e in record.box.along]
        self._writer.add(entry)
        self._boxes += 1

    def finish(self, shown: float) -> None:
        """Writes the log, whole or not at all, of what is shown of all points."""
        self._writer.finish({self._claim: shown, "boxes": self._boxes})
