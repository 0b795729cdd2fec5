"""A record is written often, and never for more than a small share of the time."""

import pytest
from holdfast.base.machine import pace as pace_module
from holdfast.base.machine.pace import Pace


@pytest.mark.parametrize("grows_s", [0.0, 0.001, 0.02])
def test_writing_takes_a_small_share_however_long_it_comes_to_take(
    grows_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two thousand pieces of work of a second each; every writing takes longer than the one before."""
    now = 0.0
    monkeypatch.setattr(pace_module.time, "monotonic", lambda: now)
    pace, spent, writings = Pace(), 0.0, 0
    for k in range(2000):
        now += 1.0
        if pace.is_due:
            started, took = now, 0.01 + grows_s * k
            now += took
            pace.note(started)
            spent, writings = spent + took, writings + 1
    assert spent <= 0.1 * now
    assert writings >= (2000 if grows_s == 0.0 else 10)
