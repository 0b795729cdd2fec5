"""Checks a proof log that a task is infeasible, in arithmetic of its own.

Nothing here comes from the solver: no compiled code, no linear programming, none of its interval
functions. (A task, where one is given, is formulated by the package: that says what is to be refuted.) The
log holds hints only: where boxes were split, and multipliers of inequalities. What follows from them is
worked out here, so a wrong hint can make a proof fail but never make a false one pass. A box counts as empty
only where this module has emptied it. docs/proof-log.md describes the format and the reasoning.
"""

import gzip
import hashlib
import json
import math
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError

if TYPE_CHECKING:
    from ..objects import Task

__all__ = ["ProofCheck", "check_proof"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_LONGEST_RECORD = 1 << 26
_HIGHEST_DEGREE = 40
# A box may stick out by this share from where the log says that propagation takes it: rounding differs.
_SLACK = 1e-4
# Sweeps over all constraints in search of what the log says, or of emptiness, and the share of some width
# by which a sweep must shrink the box for another to follow.
_SWEEPS = 400
_LEAST_GAIN = 1e-5


@dataclass(frozen=True)
class ProofCheck:
    """What came of checking a proof log.

    Attributes:
        accepted: whether the log proves that its system has no solution.
        boxes: boxes replayed.
        steps: relaxations, bounds and rays replayed.
        reason: why the log was rejected; empty where it was accepted.
    """

    accepted: bool
    boxes: int
    steps: int
    reason: str


class Rejected(Exception):
    """The log does not prove what it claims."""


def check_proof(path: str | Path, task: "Task | None" = None) -> ProofCheck:
    """Replays a proof log.

    Args:
        path: the log.
        task: where given, the log's system must be this task's, to the last bit. Without a task, acceptance
            says that the system written in the log has no solution, whatever that system stands for.

    Raises:
        InputError: the file can't be read or is no proof log at all. A damaged log is rejected instead.
    """
    replay = _Replay()
    records = _records(Path(path))
    try:
        with np.errstate(all="ignore"):
            replay.run(records, None if task is None else _system_of(task))
    except Rejected as reason:
        return ProofCheck(False, replay.boxes, replay.steps, str(reason))
    return ProofCheck(True, replay.boxes, replay.steps, "")


def _system_of(task: "Task") -> Any:
    """The system that the package makes of a task, as a log writes it."""
    from .canonical import canonical_form
    from .formulate import formulate
    from .proof import form_data

    return form_data(canonical_form(formulate(task).system))


# Reading


def _records(path: Path) -> Iterator[tuple[bytes, dict[str, Any]]]:
    """The log's records, each with its line; the first is the head."""
    is_head = True
    try:
        with gzip.open(path) as file:
            while line := file.readline(_LONGEST_RECORD):
                record = _record(line)
                if is_head and record.get("holdfast_proof") != 2:
                    raise Rejected
                yield line, record
                is_head = False
    except (EOFError, gzip.BadGzipFile, zlib.error, Rejected) as error:
        if not is_head:
            raise Rejected(str(error) or "the log is damaged") from None
    except OSError as error:
        raise InputError(path, "", error.strerror or "can't be read") from None
    if is_head:
        raise InputError(path, "", "not a proof log, as `holdfast solve --proof` writes it")


def _record(line: bytes) -> dict[str, Any]:
    try:
        record = json.loads(line) if line.endswith(b"\n") else None
    except (ValueError, RecursionError):
        record = None
    if not isinstance(record, dict):
        raise Rejected("a record is not a line of JSON")
    return record


def _numbers(data: Any, count: int | None = None) -> Array:
    """Finite numbers."""
    if all(type(x) in (int, float) for x in _items(data, count)):
        try:
            out = np.array(data, dtype=np.float64)
        except OverflowError:
            out = np.array([np.inf])
        if np.isfinite(out).all():
            return out
    raise Rejected("something is not a finite number")


def _indices(data: Any, below: int, count: int | None = None) -> Index:
    """Whole numbers from 0 to `below` - 1."""
    if all(type(x) is int and 0 <= x < below for x in _items(data, count)):
        return np.array(data, dtype=np.int64)
    raise Rejected("an index is out of range")


def _items(data: Any, count: int | None = None) -> list[Any]:
    if not isinstance(data, list) or count not in (None, len(data)):
        raise Rejected("a list is missing or has the wrong length")
    return data


# Arithmetic: an operation rounds to nearest, so the neighbouring floats enclose its true result.


def _down(x: Any) -> Any:
    return np.nextafter(x, -np.inf)


def _up(x: Any) -> Any:
    return np.nextafter(x, np.inf)


def _mul(al: Any, au: Any, bl: Any, bu: Any) -> tuple[Array, Array]:
    corners = np.stack([al * bl, al * bu, au * bl, au * bu])
    return _down(corners.min(axis=0)), _up(corners.max(axis=0))


def _square(al: Array, au: Array) -> tuple[Array, Array]:
    least = np.maximum(np.maximum(al, -au), 0.0)
    most = np.maximum(-al, au)
    return np.maximum(_down(least * least), 0.0), _up(most * most)


def _divide(al: Array, au: Array, bl: Array, bu: Array) -> tuple[Array, Array]:
    """[al, au] / [bl, bu]; nothing is known where the divisor changes sign or both hold zero."""
    # A zero at the divisor's end stands for the side on which the divisor lies.
    bl, bu = np.where(bl == 0.0, 0.0, bl), np.where(bu == 0.0, -0.0, bu)
    corners = np.stack([al / bl, al / bu, au / bl, au / bu])
    one_signed = (bl > 0.0) | (bu < 0.0) | (((al > 0.0) | (au < 0.0)) & ((bl >= 0.0) ^ (bu <= 0.0)))
    return (
        np.where(one_signed, _down(corners.min(axis=0)), -np.inf),
        np.where(one_signed, _up(corners.max(axis=0)), np.inf),
    )


# The system


@dataclass(eq=False)
class _Box:
    lower: Array
    upper: Array

    def narrow(self, columns: Any, lower: Array, upper: Array) -> None:
        """Cuts columns, which may repeat, to what is known of them; a bound that is NaN says nothing."""
        np.fmax.at(self.lower, columns, lower)
        np.fmin.at(self.upper, columns, upper)

    @property
    def is_empty(self) -> bool:
        return bool((self.lower > self.upper).any())

    def copy(self) -> "_Box":
        return _Box(self.lower.copy(), self.upper.copy())


class _Functions:
    """Functions x_k = f(x_i, x_j) in Bernstein form over the unit square, all of one degree."""

    def __init__(self, kij: list[Index], nets: list[Array]):
        self.k, self.i, self.j = np.array(kij).T
        self.nets = np.array(nets)  # (m, d_i + 1, d_j + 1)
        self.degrees = self.nets.shape[1] - 1, self.nets.shape[2] - 1

    def nets_over(self, box: _Box) -> tuple[Array, Array]:
        """The control points of the parts over a box, enclosed: their hull holds the functions' values."""
        net = self.nets, self.nets
        net = _restrict(net, box.lower[self.i], box.upper[self.i])
        net = net[0].swapaxes(1, 2), net[1].swapaxes(1, 2)
        net = _restrict(net, box.lower[self.j], box.upper[self.j])
        return net[0].swapaxes(1, 2), net[1].swapaxes(1, 2)


def _restrict(net: tuple[Array, Array], start: Array, end: Array) -> tuple[Array, Array]:
    """Control points along axis 1 over [start, end]: point p is the blossom with p arguments at the end."""
    points = []
    degree = net[0].shape[1] - 1
    for p in range(degree + 1):
        lo, hi = net
        for step in range(degree):
            x = (end if step < p else start)[:, None, None]
            y = 1.0 - x
            al, au = _mul(_down(y), _up(y), lo[:, :-1], hi[:, :-1])
            bl, bu = _mul(x, x, lo[:, 1:], hi[:, 1:])
            lo, hi = _down(al + bl), _up(au + bu)
        points.append((lo, hi))
    return np.concatenate([lo for lo, _ in points], axis=1), np.concatenate([hi for _, hi in points], axis=1)


@dataclass(eq=False)
class _Inequalities:
    """Rows lower <= sum of value * x_column <= upper."""

    row: Index
    column: Index
    value: Array
    lower: Array
    upper: Array


class LoggedSystem:
    """Linear rows, products x_k = x_i x_j and Bernstein functions over a box, as a log writes them."""

    def __init__(self, data: Any):
        if not isinstance(data, dict):
            raise Rejected("the system is missing")
        self.box = _Box(_numbers(data.get("lower")), _numbers(data.get("upper")))
        n = self.n = len(self.box.lower)
        if len(self.box.upper) != n:
            raise Rejected("the initial box has a side too few")
        self._read_rows(_items(data.get("rows")))
        triples = [_indices(triple, n, 3) for triple in _items(data.get("products"))]
        self.products = np.array(triples, dtype=np.int64).reshape(-1, 3)
        is_square = self.products[:, 1] == self.products[:, 2]
        self.squares, self.others = self.products[is_square].T, self.products[~is_square].T
        # Rows of the relaxation: the linear ones, 4 for a product, 2 for a function.
        first = self.n_linear + 4 * np.arange(len(self.products) + 1, dtype=np.int64)
        self.square_rows, self.other_rows = first[:-1][is_square], first[:-1][~is_square]
        self._read_functions(_items(data.get("functions")), int(first[-1]))
        factors = [self.products[:, 1:].ravel(), *(f.i for f in self.groups), *(f.j for f in self.groups)]
        self.factors = np.unique(np.concatenate(factors)).astype(np.int64)

    def _read_rows(self, rows: list[Any]) -> None:
        self.n_linear = len(rows)
        longest = max((len(_items(_items(row, 4)[0])) for row in rows), default=0)
        self.columns = np.zeros((len(rows), longest), dtype=np.int64)
        self.values = np.zeros((len(rows), longest))
        self.row_lower, self.row_upper = np.full(len(rows), -np.inf), np.full(len(rows), np.inf)
        for r, (columns, values, lower, upper) in enumerate(rows):
            self.columns[r, : len(columns)] = _indices(columns, self.n)
            self.values[r, : len(columns)] = _numbers(values, len(columns))
            if lower is not None:
                self.row_lower[r] = _numbers([lower])[0]
            if upper is not None:
                self.row_upper[r] = _numbers([upper])[0]

    def _read_functions(self, functions: list[Any], row: int) -> None:
        """Groups the functions by their degrees."""
        found: dict[tuple[int, int], list[tuple[int, Index, Array]]] = {}
        for function in functions:
            kij, degrees, coefficients = _items(function, 3)
            di, dj = _indices(degrees, _HIGHEST_DEGREE + 1, 2).tolist()
            net = _numbers(coefficients, (di + 1) * (dj + 1)).reshape(di + 1, dj + 1)
            found.setdefault((di, dj), []).append((row, _indices(kij, self.n, 3), net))
            row += 2
        self.groups = [_Functions([f[1] for f in group], [f[2] for f in group]) for group in found.values()]
        self.group_rows = [np.array([f[0] for f in group]) for group in found.values()]
        self.n_rows = row

    # Propagation

    def propagate(self, box: _Box, target: _Box | None = None) -> None:
        """Narrows the box by all constraints until it lies in the target, is empty, or stands still."""
        for _ in range(_SWEEPS):
            if box.is_empty or (target is not None and self.sticks_out(box, target) <= 0.0):
                return
            before = box.upper - box.lower
            self._sweep_rows(box)
            self._sweep_squares(box)
            self._sweep_products(box)
            for functions in self.groups:
                lo, hi = functions.nets_over(box)
                box.narrow(functions.k, lo.min(axis=(1, 2)), hi.max(axis=(1, 2)))
            if not (before - (box.upper - box.lower) > _LEAST_GAIN * before).any():
                return

    def sticks_out(self, box: _Box, target: _Box) -> float:
        """By how much the box exceeds the target in any factor of a product or function."""
        f = self.factors
        out = np.maximum(target.lower[f] - box.lower[f], box.upper[f] - target.upper[f])
        return float(out.max(initial=-np.inf))

    def _sweep_rows(self, box: _Box) -> None:
        """Solves each row for each of its columns: what the others leave, over the coefficient."""
        a, columns = self.values, self.columns
        tl, tu = _mul(a, a, box.lower[columns], box.upper[columns])
        tl, tu = np.where(a == 0.0, 0.0, tl), np.where(a == 0.0, 0.0, tu)
        # The sum of the others is what stands before plus what stands behind.
        n_rows, length = a.shape
        sums = np.zeros((4, n_rows, length + 1))
        for t in range(length):
            s = length - t
            sums[0, :, t + 1], sums[1, :, t + 1] = (
                _down(sums[0, :, t] + tl[:, t]),
                _up(sums[1, :, t] + tu[:, t]),
            )
            sums[2, :, s - 1] = _down(sums[2, :, s] + tl[:, s - 1])
            sums[3, :, s - 1] = _up(sums[3, :, s] + tu[:, s - 1])
        if (sums[0, :, length] > self.row_upper).any() or (sums[1, :, length] < self.row_lower).any():
            box.lower[:], box.upper[:] = np.inf, -np.inf  # a row can't hold, be it without any column
            return
        least, most = _down(sums[0, :, :-1] + sums[2, :, 1:]), _up(sums[1, :, :-1] + sums[3, :, 1:])
        lo, hi = _down(self.row_lower[:, None] - most), _up(self.row_upper[:, None] - least)
        lo, hi = np.where(a > 0.0, lo / a, hi / a), np.where(a > 0.0, hi / a, lo / a)
        used = a != 0.0
        box.narrow(columns[used], _down(lo[used]), _up(hi[used]))

    def _sweep_squares(self, box: _Box) -> None:
        k, i, _ = self.squares
        box.narrow(k, *_square(box.lower[i], box.upper[i]))
        least = np.maximum(_down(np.sqrt(np.maximum(box.lower[k], 0.0))), 0.0)
        most = _up(np.sqrt(np.maximum(box.upper[k], 0.0)))
        box.narrow(
            i,
            np.where(box.lower[i] > -least, least, -most),
            np.where(box.upper[i] < least, -least, most),
        )

    def _sweep_products(self, box: _Box) -> None:
        k, i, j = self.others
        box.narrow(k, *_mul(box.lower[i], box.upper[i], box.lower[j], box.upper[j]))
        for target, other in ((i, j), (j, i)):
            box.narrow(target, *_divide(box.lower[k], box.upper[k], box.lower[other], box.upper[other]))

    # Relaxation

    def relax(self, box: _Box) -> _Inequalities:
        """Linear inequalities that hold at every solution in the box."""
        lower, upper = np.full(self.n_rows, -np.inf), np.full(self.n_rows, np.inf)
        lower[: self.n_linear], upper[: self.n_linear] = self.row_lower, self.row_upper
        r, t = np.nonzero(self.values)
        entries = [(r, self.columns[r, t], self.values[r, t])]

        def plane(row: Index, k: Index, i: Index, a_i: Array, j: Index, a_j: Array) -> None:
            """x_k - a_i x_i - a_j x_j in the given rows."""
            entries.extend([(row, k, np.ones(len(k))), (row, i, -a_i), (row, j, -a_j)])

        k, i, _ = self.squares
        none = np.zeros(len(k))
        a, b = box.lower[i], box.upper[i]
        for number, x in enumerate((a, b, 0.5 * (a + b))):  # tangents: (x_i - x)^2 >= 0
            plane(self.square_rows + number, k, i, 2.0 * x, i, none)
            lower[self.square_rows + number] = _down(-(x * x))
        slope = a + b  # the chord: (x_i - a)(x_i - b) <= 0, with room for the rounding of the slope
        room = _up(_up(_up(slope) - _down(slope)) * np.maximum(np.abs(a), np.abs(b)))
        plane(self.square_rows + 3, k, i, slope, i, none)
        upper[self.square_rows + 3] = _up(_up(-(a * b)) + room)

        k, i, j = self.others
        il, iu, jl, ju = box.lower[i], box.upper[i], box.lower[j], box.upper[j]
        for number, (a, b) in enumerate(((il, jl), (iu, ju))):  # (x_i - a)(x_j - b) >= 0
            plane(self.other_rows + number, k, i, b, j, a)
            lower[self.other_rows + number] = _down(-(a * b))
        for number, (a, b) in enumerate(((iu, jl), (il, ju)), start=2):  # (x_i - a)(x_j - b) <= 0
            plane(self.other_rows + number, k, i, b, j, a)
            upper[self.other_rows + number] = _up(-(a * b))

        for functions, row in zip(self.groups, self.group_rows, strict=True):
            a_i, a_j, least, most = _bands(functions, box)
            lower[row], upper[row + 1] = least, most
            for number in range(2):
                plane(row + number, functions.k, functions.i, a_i, functions.j, a_j)
        row, column, value = (np.concatenate(part) for part in zip(*entries, strict=True))
        return _Inequalities(row.astype(np.int64), column.astype(np.int64), value, lower, upper)

    def bound(self, rows: _Inequalities, duals: Array, column: int | None, sign: float, box: _Box) -> float:
        """A lower bound on sign * x_column over the rows and the box, or on zero where no column is given.

        For every y: c . x = y . (A x) + (c - A^T y) . x; a bound above zero on zero shows that there is no x.
        """
        side = np.where(duals > 0.0, rows.lower, rows.upper)
        duals = np.where(np.isfinite(side), duals, 0.0)  # that side is missing
        used = np.flatnonzero(duals[rows.row])
        at, products = rows.column[used], duals[rows.row[used]] * rows.value[used]
        cost = np.zeros(self.n)
        if column is not None:
            cost[column] = sign
        reduced = cost - np.bincount(at, products, self.n)
        # A sum of m rounded products is off by less than m 2^-53 of the sum of their sizes, to first order,
        # and m underflows; twice that covers the rest.
        m = np.bincount(at, minlength=self.n) + 2.0
        error = m * 2.0**-52 * (np.abs(cost) + np.bincount(at, np.abs(products), self.n)) + m * 1e-300
        terms, _ = _mul(_down(reduced - error), _up(reduced + error), box.lower, box.upper)
        y = np.flatnonzero(duals)
        terms = np.concatenate([terms, _down(duals[y] * side[y])])
        # The sum is rounded once. Terms so large that it might overflow prove nothing.
        return float(_down(math.fsum(terms))) if np.all(np.abs(terms) < 1e300) else -np.inf


def _bands(functions: _Functions, box: _Box) -> tuple[Array, Array, Array, Array]:
    """Slopes a_i, a_j and bounds of f - a_i x_i - a_j x_j over a box."""
    lo, hi = functions.nets_over(box)
    di, dj = functions.degrees
    il, iu = box.lower[functions.i], box.upper[functions.i]
    jl, ju = box.lower[functions.j], box.upper[functions.j]
    # Control points at the corners are values. Any slope will do, so they need no care.
    rise_i = lo[:, -1, 0] - lo[:, 0, 0] + lo[:, -1, -1] - lo[:, 0, -1]
    rise_j = lo[:, 0, -1] - lo[:, 0, 0] + lo[:, -1, -1] - lo[:, -1, 0]
    a_i = np.where(iu > il, 0.5 * rise_i / (iu - il), 0.0)
    a_j = np.where(ju > jl, 0.5 * rise_j / (ju - jl), 0.0)
    # A linear function has its own values, evenly spaced, as control points.
    for p in range(di + 1):
        for q in range(dj + 1):
            xl, xu = _between(il, iu, p, di)
            yl, yu = _between(jl, ju, q, dj)
            (xl, xu), (yl, yu) = _mul(a_i, a_i, xl, xu), _mul(a_j, a_j, yl, yu)
            lo[:, p, q] = _down(lo[:, p, q] - _up(xu + yu))
            hi[:, p, q] = _up(hi[:, p, q] - _down(xl + yl))
    return a_i, a_j, lo.min(axis=(1, 2)), hi.max(axis=(1, 2))


def _between(a: Array, b: Array, p: int, d: int) -> tuple[Array, Array]:
    """The enclosed point that lies p / d of the way from a to b; all of [a, b] where d is 0."""
    if d == 0:
        return a, b
    sl, su = _down(_down((d - p) * a) + _down(p * b)), _up(_up((d - p) * a) + _up(p * b))
    return _down(sl / d), _up(su / d)


# Replay


class _Replay:
    """Walks through the tree of boxes; what has been split or emptied is no longer open."""

    def __init__(self) -> None:
        self.boxes = 0
        self.steps = 0
        self._open: dict[str, _Box] = {}

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
                self._replay(record)
        raise Rejected("the log breaks off: its last record is missing")

    def _begin(self, form: Any, expected: Any) -> None:
        if hasattr(self, "_system"):
            raise Rejected("a second system")
        if expected is not None and form != expected:
            raise Rejected("the log's system is not that of the task")
        self._system = LoggedSystem(form)
        self._open[""] = self._system.box

    def _finish(self, end: Any, digest: str) -> None:
        if not hasattr(self, "_system"):
            raise Rejected("the system is missing")
        if self._open:
            raise Rejected(
                f"{len(self._open)} boxes are left open, the first is {_name(next(iter(self._open)))}"
            )
        if end != {"boxes": self.boxes, "steps": self.steps, "sha256": digest}:
            raise Rejected("the log was changed after it was written: its checksum or its counts differ")

    def _replay(self, record: dict[str, Any]) -> None:
        """One box: its steps, and then either a split into two or nothing left."""
        path = record.get("box")
        if not isinstance(path, str) or path not in self._open:
            raise Rejected("a record is of a box that is not open")
        box = self._open.pop(path)
        try:
            self._narrow(box, _items(record.get("steps")))
            if "split" in record:
                self._split(path, box, record["split"])
            elif not box.is_empty:
                self._system.propagate(box)
                if not box.is_empty:
                    raise Rejected("is not shown to be empty")
        except Rejected as reason:
            raise Rejected(f"box {_name(path)}: {reason}") from None
        self.boxes += 1

    def _split(self, path: str, box: _Box, cut: Any) -> None:
        """The halves x_k <= value and x_k >= value, which together are the whole for any value."""
        k, value = _items(cut, 2)
        k, value = int(_indices([k], self._system.n)[0]), float(_numbers([value])[0])
        left, right = box, box.copy()
        left.upper[k] = min(left.upper[k], value)
        right.lower[k] = max(right.lower[k], value)
        self._open[path + "0"], self._open[path + "1"] = left, right

    def _narrow(self, box: _Box, steps: list[Any]) -> None:
        """Each step is either where the relaxation is taken, or multipliers of its rows."""
        rows: _Inequalities | None = None
        for step in steps:
            self.steps += 1
            if not _items(step):
                raise Rejected("a step is empty")
            kind, *content = step
            if kind == "over":
                rows = self._relax(box, content)
                continue
            if rows is None:
                raise Rejected("multipliers without a relaxation")
            if kind == "bound":
                column, end, at, values = _items(content, 4)
                if end not in ("lower", "upper"):
                    raise Rejected("a bound is neither lower nor upper")
                j = int(_indices([column], self._system.n)[0])
                sign = 1.0 if end == "lower" else -1.0
                bound = sign * self._system.bound(rows, self._duals(at, values), j, sign, box)
                side = box.lower if end == "lower" else box.upper
                side[j] = max(side[j], bound) if end == "lower" else min(side[j], bound)
            elif kind == "ray":
                at, values = _items(content, 2)
                if not self._is_refuted(rows, self._duals(at, values), box):
                    raise Rejected("a ray does not show what it should")
                box.lower[:], box.upper[:] = np.inf, -np.inf
            else:
                raise Rejected("an unknown kind of step")

    def _is_refuted(self, rows: _Inequalities, ray: Array, box: _Box) -> bool:
        """Whether multipliers of the rows show that the box is empty.

        Propagation stopped where the factors were as narrow as the log says; the others may be wider than
        they were for the solver, and have to be narrowed first.
        """
        if self._system.bound(rows, ray, None, 0.0, box) > 0.0:
            return True
        self._system.propagate(box)
        return box.is_empty or self._system.bound(rows, ray, None, 0.0, box) > 0.0

    def _relax(self, box: _Box, content: list[Any]) -> _Inequalities:
        """The relaxation over the log's box of factors, which propagation must reach but for rounding."""
        f = self._system.factors
        lower, upper = (_numbers(side, len(f)) for side in _items(content, 2))
        target = box.copy()
        target.lower[f], target.upper[f] = lower, upper
        self._system.propagate(box, target)
        room = _SLACK * (1.0 + max(np.abs(lower).max(initial=0.0), np.abs(upper).max(initial=0.0)))
        if not box.is_empty and not self._system.sticks_out(box, target) <= room:
            raise Rejected("propagation does not give the box that the log says")
        # The rows are valid where the box lies within what they were made for.
        target.lower, target.upper = np.minimum(target.lower, box.lower), np.maximum(target.upper, box.upper)
        return self._system.relax(target)

    def _duals(self, at: Any, values: Any) -> Array:
        duals = np.zeros(self._system.n_rows)
        rows = _indices(at, self._system.n_rows)
        duals[rows] = _numbers(values, len(rows))
        return duals


def _name(path: str) -> str:
    return repr(path[:40] + ("..." if len(path) > 40 else "")) if path else "at the root"
