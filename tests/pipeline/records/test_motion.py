"""Motions in few rows: straight lines between them give the samples back."""

import numpy as np
import pytest
from holdfast.pipeline.records import thinned


def given_back(rows: list[list[float]], times: np.ndarray) -> np.ndarray:
    table = np.array(rows)
    return np.column_stack([np.interp(times, table[:, 0], column) for column in table[:, 1:].T])


def test_what_moves_little_takes_few_rows() -> None:
    times = np.linspace(0.0, 1.0, 101)
    still = np.tile(np.arange(5.0), (101, 1))
    assert len(thinned(times, still)) == 2
    swing = still + 0.05 * np.exp(-5.0 * times)[:, None] * np.sin(9.0 * times)[:, None] * [0, 0, 1, 0.5, 0]
    rows = thinned(times, swing)
    assert 4 < len(rows) <= 24
    assert given_back(rows, times) == pytest.approx(swing, abs=4e-4)
    assert rows[0][0] == 0.0 and rows[-1][0] == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_wild_motions_are_cut_to_a_number_of_rows(seed: int) -> None:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.01, 0.1, 200))
    rows = thinned(times, rng.normal(size=(200, 9)))
    assert len(rows) == 24 and all(len(row) == 10 for row in rows)
    assert [row[0] for row in rows] == sorted(row[0] for row in rows)


def test_a_simulation_that_breaks_down_is_recorded_until_then() -> None:
    times, qpos = np.linspace(0.0, 1.0, 11), np.zeros((11, 3))
    qpos[6:] = np.nan
    rows = thinned(times, qpos)
    assert rows[-1][0] == 0.5 and np.isfinite(rows).all()
    assert thinned(times, np.full((11, 3), np.nan)) == []
    assert thinned(times[:1], qpos[:1]) == [[0.0, 0.0, 0.0, 0.0]]
