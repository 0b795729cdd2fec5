"""Honest proof logs, written once, for the tests that check them and tamper with them."""

from pathlib import Path

import pytest
from holdfast.objects import Task
from holdfast.solver import Verdict, solve

from ..exact import Exact
from .logs import INFEASIBLE, Records, boxes_of, plates, read, search


@pytest.fixture(scope="package")
def proved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Task, Path]:
    """A plate that two fingers can't span, and the proof."""
    task, path = plates(0.11), tmp_path_factory.mktemp("proof") / "plate.proof"
    result = solve(task, candidates=1, budget_s=300, proof=path)
    assert result.verdict is Verdict.INFEASIBLE
    assert len(boxes_of(read(path))) == result.boxes > 3
    return task, path


@pytest.fixture
def records(proved: tuple[Task, Path]) -> Records:
    return read(proved[1])


@pytest.fixture(scope="package")
def curved(tmp_path_factory: pytest.TempPathFactory) -> Records:
    """The log of a system that is refuted by planes beside its function."""
    path = tmp_path_factory.mktemp("proof") / "curved.proof"
    assert search(INFEASIBLE["saddle"], path)
    return read(path)


@pytest.fixture(scope="session")
def exact() -> type[Exact]:
    return Exact
