"""Exact oracles and small tasks that the tests of the solver share."""

import dataclasses
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from math import comb

import numpy as np
import pytest
from holdfast.geometry import Region
from holdfast.objects import Contact, ObjectRegion, Task, load_task
from holdfast.solver.interval import COSINE
from holdfast.solver.polynomial.system import BernsteinFunction, PolynomialSystem, TrigFunction
from holdfast.solver.search import job_queue as job_queue_module
from holdfast.workers import WorkerPool

from ..exact import Exact
from .plates import plate_faces


class RootKeeping:
    """Contracts boxes around exact roots and sees to it that none loses its root.

    Attributes:
        count: boxes so far.
        narrowed: those of them that lost a good part of their widths.
    """

    def __init__(self) -> None:
        self.count = self.narrowed = 0

    def check(
        self,
        root: Sequence[Fraction],
        boxes: Iterable[tuple[np.ndarray, np.ndarray]],
        contract: Callable[[np.ndarray, np.ndarray], bool],
    ) -> None:
        """Contracts boxes that hold `root`, in place; `contract` answers False for an empty one."""
        low, high = Exact.ends(root)
        for lower, upper in boxes:
            width = (upper - lower).sum()
            assert contract(lower, upper), "a box with a root was refuted"
            assert (lower <= low).all() and (high <= upper).all(), "a root was cut off"
            self.count += 1
            self.narrowed += bool((upper - lower).sum() < 0.9 * width)


@pytest.fixture
def keeping() -> RootKeeping:
    return RootKeeping()


@pytest.fixture(scope="session")
def exact() -> type[Exact]:
    return Exact


def _values(system: PolynomialSystem, x: np.ndarray) -> np.ndarray:
    x = np.array(x, dtype=float)
    for k, value in system.definitions.items():
        if isinstance(value, BernsteinFunction):
            m, n = np.array(value.coefficients.shape) - 1
            bu = np.array([comb(m, i) * x[value.i] ** i * (1 - x[value.i]) ** (m - i) for i in range(m + 1)])
            bv = np.array([comb(n, i) * x[value.j] ** i * (1 - x[value.j]) ** (n - i) for i in range(n + 1)])
            x[k] = bu @ value.coefficients @ bv
        elif isinstance(value, TrigFunction):
            angle = value.ratio * x[value.i] + value.offset
            x[k] = np.cos(angle) if value.kind == COSINE else np.sin(angle)
        else:
            x[k] = value.evaluate(x)
    return x


@pytest.fixture(scope="session")
def values() -> Callable[[PolynomialSystem, np.ndarray], np.ndarray]:
    """Fills the defined variables of a vector of a system, in ordinary floats."""
    return _values


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes are started at once, and everything waits for all of them."""
    monkeypatch.setattr(job_queue_module, "PATIENCE_S", 0.0)
    monkeypatch.setattr(WorkerPool, "ready", property(lambda pool: pool.wait_until_complete(60.0)))


@pytest.fixture(scope="session")
def upholding() -> Task:
    return load_task("upholding")


@pytest.fixture(scope="session")
def make_task(upholding: Task) -> Callable[..., Task]:
    """A task for the SA hand from pairs (its region, one of an object that the task's own stands for)."""

    def make(*pairs: tuple[str, Region]) -> Task:
        contacts = tuple(
            Contact(
                upholding.hand.regions[name],
                ObjectRegion(f"r{k}", dataclasses.replace(region, off_surface=True)),
            )
            for k, (name, region) in enumerate(pairs)
        )
        return dataclasses.replace(upholding, contacts=contacts)

    return make


@pytest.fixture(scope="session")
def make_plate_task(make_task: Callable[..., Task]) -> Callable[[float], Task]:
    """A task for index and thumb on opposite faces, 40 mm square, of a plate; half its thickness in m."""

    def make(half_thickness: float) -> Task:
        bottom, top = plate_faces(half_thickness)
        return make_task(("index/tip", bottom), ("thumb/tip", top))

    return make
