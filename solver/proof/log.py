"""Writes the proof log of an infeasible task; `check_proof` replays it, docs/proof-log.md describes it."""

import gzip
import hashlib
import io
import json
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ... import __version__
from ...base.files.output_file import check_target, write_bytes
from ...base.numeric.arrays import Array
from ..polynomial import CanonicalForm, Rows

__all__ = ["BoxRecord", "BoxTrace", "LogWriter", "ProofWriter", "form_data"]

PROOF_VERSION = 4

Step: TypeAlias = list[Any]

# Any multipliers and slopes prove something, so they may be rounded; twelve digits lose next to nothing.
_DIGITS = 12
# Multipliers below this share of the largest are left out.
_SMALLEST = 1e-11


class BoxRecord(NamedTuple):
    """A box of the tree that was refuted or split.

    Attributes:
        path: which box: "" is the root, and each split adds 0 for the half below or 1 for the half above.
        steps: what narrowed it.
        cut: column and value where it was split; None where it was proved empty.
    """

    path: str
    steps: list[Step]
    cut: tuple[int, float] | None


class BoxTrace:
    """The steps that narrowed one box, but for those of propagation, which the checker finds itself."""

    def __init__(self, form: CanonicalForm):
        self.steps: list[Step] = []
        self._factors = np.unique(form.factors)
        self._n_fixed = len(form.rows.lower) + 4 * len(form.products)
        defined = np.concatenate([form.functions.kij[:, 0], form.trig.ki[:, 0]])
        self._function_of = {k: f for f, k in enumerate(defined.tolist())}

    def relaxed(self, lower: Array, upper: Array, rows: Rows) -> None:
        """These rows were built over this box (n,), of which only the factors of products matter to them."""
        self._rows = rows
        self._planes: list[list[Any]] = []  # those beside functions that some step needs, as the log has them
        self._number: dict[int, int] = {}  # which numbers their rows have in the log
        box = _outward(lower[self._factors], -1), _outward(upper[self._factors], 1)
        self.steps.append(["over", *box, self._planes])

    def bounded(self, column: int, sign: float, duals: Array) -> None:
        """Multipliers (n_rows,) of its rows bound a column, from below where `sign` is positive."""
        self.steps.append(["bound", int(column), "lower" if sign > 0 else "upper", *self._sparse(duals)])

    def refuted(self, ray: Array) -> None:
        """Multipliers (n_rows,) of its rows show that the box is empty."""
        self.steps.append(["ray", *self._sparse(ray)])

    def _sparse(self, duals: Array) -> tuple[list[int], list[float]]:
        """Numbers of rows in the log, and their multipliers."""
        at = np.flatnonzero(np.abs(duals) > _SMALLEST * np.abs(duals).max(initial=0.0))
        return [self._numbered(r) for r in at.tolist()], [_short(y) for y in duals[at]]

    def _numbered(self, row: int) -> int:
        """The row's number in the log, where planes of functions count from the first that is needed."""
        if row < self._n_fixed:
            return row
        if row not in self._number:
            first, last = self._rows.start[row : row + 2]
            slopes = [_short(-a) for a in self._rows.value[first + 1 : last]]
            slopes += [0.0] * (2 - len(slopes))  # beside a cosine or sine it is a line
            self._number[row] = self._n_fixed + len(self._planes)
            self._planes.append([self._function_of[int(self._rows.column[first])], *slopes])
        return self._number[row]


class LogWriter:
    """Collects records, lines of JSON, and writes them as a whole, packed, with a checksum.

    Args:
        path: where `finish` writes; checked at once, for a search may take long.
        head: the first record.
    """

    def __init__(self, path: str | Path, head: dict[str, Any]):
        self.path = Path(path)
        check_target(self.path)
        self._buffer = io.BytesIO()
        # Without a time stamp the same search writes the same bytes.
        self._file = gzip.GzipFile(filename="", mode="wb", fileobj=self._buffer, mtime=0)
        self._digest = hashlib.sha256()
        self.add(head)

    def add(self, record: dict[str, Any]) -> None:
        """Adds a record."""
        line = json.dumps(record, allow_nan=False, separators=(",", ":")).encode() + b"\n"
        self._digest.update(line)
        self._file.write(line)

    def finish(self, end: dict[str, Any]) -> None:
        """Writes the file, whole or not at all; the last record holds `end` and a checksum of all before."""
        self.add({"end": {**end, "sha256": self._digest.hexdigest()}})
        self._file.close()
        write_bytes(self.path, self._buffer.getvalue())


class ProofWriter:
    """Writes the records of a search's boxes.

    Args:
        path: where `finish` writes; checked at once, for a search may take long.
        form: the system.
        task: the task's name, for people.
    """

    def __init__(self, path: str | Path, form: CanonicalForm, task: str):
        self._writer = LogWriter(
            path, {"holdfast_proof": PROOF_VERSION, "holdfast": __version__, "task": task}
        )
        self._boxes = self._steps = 0
        self._writer.add({"form": form_data(form)})

    @property
    def path(self) -> Path:
        """Where `finish` writes."""
        return self._writer.path

    def add(self, box: BoxRecord) -> None:
        """Adds a box; its parent comes before it."""
        record: dict[str, Any] = {"box": box.path, "steps": box.steps}
        if box.cut is not None:
            record["split"] = [int(box.cut[0]), float(box.cut[1])]
        self._writer.add(record)
        self._boxes += 1
        self._steps += len(box.steps)

    def finish(self) -> None:
        """Writes the log, whole or not at all."""
        self._writer.finish({"boxes": self._boxes, "steps": self._steps})


def form_data(form: CanonicalForm) -> dict[str, Any]:
    """A canonical form as the log holds it; floats are written so that they read back to the last bit."""
    rows, functions = form.rows, form.functions
    sizes = np.prod(functions.degree + 1, axis=1)
    trig = [
        [*ki, kind, ratio, offset]
        for ki, kind, ratio, offset in zip(*(part.tolist() for part in form.trig), strict=True)
    ]
    return {
        "lower": form.lower.tolist(),
        "upper": form.upper.tolist(),
        "rows": [
            [rows.column[a:b].tolist(), rows.value[a:b].tolist(), _end(rows.lower[r]), _end(rows.upper[r])]
            for r, (a, b) in enumerate(zip(rows.start[:-1], rows.start[1:], strict=True))
        ],
        "products": form.products.tolist(),
        "functions": [
            [kij.tolist(), degree.tolist(), functions.coefficients[start : start + size].tolist()]
            for kij, degree, start, size in zip(
                functions.kij, functions.degree, functions.start, sizes, strict=True
            )
        ],
        **({"trig": trig} if trig else {}),
    }


def _end(x: float) -> float | None:
    """A row's end; None where that side is missing."""
    return float(x) if np.isfinite(x) else None


def _short(x: float) -> float:
    return float(f"{x:.{_DIGITS}g}")


def _outward(values: Array, sign: int) -> list[float]:
    """The values rounded to a few digits, up where `sign` is positive and down otherwise."""
    step = 10.0 ** (np.floor(np.log10(np.maximum(np.abs(values), 1e-30))) - (_DIGITS - 1))
    return [_short(x) for x in values + sign * step]
