"""The clock of compiling, alone and fed by numba."""

import pytest
from holdfast.base.machine import compile_clock
from holdfast.base.machine.compile_clock import CompileClock, clock, compile_s, when_compiling
from holdfast.base.machine.jit import compiled
from holdfast.base.machine.work_clock import WorkClock

SOURCE = "def twice(x):\n    return 2.0 * x\n"


def test_nested_stretches_count_once(monkeypatch: pytest.MonkeyPatch) -> None:
    now = iter([10.0, 17.0, 20.0, 21.0])
    monkeypatch.setattr(compile_clock.time, "perf_counter", lambda: next(now))
    alone = CompileClock()
    for step in (alone.begin, alone.begin, alone.end, alone.end, alone.begin, alone.end):
        step()
    assert alone.total_s == 7.0 + 1.0


def test_compiling_is_announced_once_and_is_no_work() -> None:
    said: list[str] = []
    scope: dict[str, object] = {}
    exec(SOURCE, scope)
    before = compile_s()
    when_compiling(lambda: said.append("compiling"))
    function = compiled(scope["twice"])  # type: ignore[type-var]
    assert said == []
    assert function(1.0) == 2.0 and function(1) == 2.0  # type: ignore[operator]
    assert said == ["compiling"]
    assert compile_s() > before


def test_work_is_the_time_without_compiling(monkeypatch: pytest.MonkeyPatch) -> None:
    now = iter([10.0, 12.0, 19.0, 21.0])
    monkeypatch.setattr(compile_clock.time, "perf_counter", lambda: next(now))
    work = WorkClock()
    clock.begin()
    clock.end()
    assert work.seconds == pytest.approx(21.0 - 10.0 - 7.0)
