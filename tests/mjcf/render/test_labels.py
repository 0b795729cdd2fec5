"""Names beside a picture never cover each other, and lengths on it are true."""

from itertools import pairwise

import numpy as np
import pytest
from holdfast.mjcf.render.labels import Callout, colour_of, round_length, spread_out, with_callouts
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

GAP, LOW, HIGH = 19.0, 38.0, 624.0
_MOST = int((HIGH - LOW) // GAP) + 1


@given(st.lists(st.floats(-200.0, 1000.0), max_size=_MOST))
def test_places_are_apart_and_inside(wanted: list[float]) -> None:
    places = spread_out(sorted(wanted), GAP, LOW, HIGH)
    assert len(places) == len(wanted)
    assert all(after - before >= GAP - 1e-9 for before, after in pairwise(places))
    assert all(LOW - 1e-9 <= place <= HIGH + 1e-9 for place in places)


@given(st.lists(st.integers(2, 30), max_size=_MOST))
def test_places_that_are_free_are_taken(steps: list[int]) -> None:
    wanted = LOW + np.cumsum([GAP * step / 2 for step in steps])
    wanted = wanted[wanted <= HIGH]
    assert spread_out(list(wanted), GAP, LOW, HIGH) == pytest.approx(list(wanted))


def test_places_are_the_nearest_ones_there_are() -> None:
    rng = np.random.default_rng(3)
    for _ in range(5):
        wanted = np.sort(rng.uniform(250.0, 400.0, 6))
        apart = {"type": "ineq", "fun": lambda y: np.diff(y) - GAP}
        start = 300.0 + GAP * np.arange(6)
        best = minimize(lambda y, w=wanted: ((y - w) ** 2).sum(), start, constraints=[apart], tol=1e-12)
        assert spread_out(list(wanted), GAP, LOW, HIGH) == pytest.approx(best.x, abs=1e-2)


def test_every_name_that_has_room_is_written_and_the_others_are_counted() -> None:
    blank = np.full((300, 600, 3), 255, dtype=np.uint8)
    rng = np.random.default_rng(0)
    some = [
        Callout(f"region {i}", rng.uniform((200.0, 100.0), (400.0, 200.0)), colour_of(i)) for i in range(8)
    ]
    drawn = with_callouts(blank, some, 150)
    for callout in some:
        assert (drawn == callout.colour).all(axis=-1).sum() > 20, callout.text
    below = slice(300 - 4 * 19, None)
    assert (drawn[below] == 255).all(), "nothing is left out, and nothing hidden"
    many = [Callout(f"region {i}", np.array([300.0, 150.0]), colour_of(i)) for i in range(60)]
    assert not (with_callouts(blank, many, 150)[below] == 255).all()
    hidden = [Callout("behind", np.array([300.0, 150.0]), colour_of(0), hidden=True)]
    assert not (with_callouts(blank, hidden, 150)[below] == 255).all()


def test_neighbours_have_colours_apart() -> None:
    colours = np.array([colour_of(i) for i in range(24)], dtype=float)
    assert np.linalg.norm(np.diff(colours, axis=0), axis=1).min() > 60.0
    assert len({tuple(colour) for colour in colours}) == len(colours)
    assert colours.min(axis=1).max() < 160.0, "each stands out on white"


@given(st.floats(1e-5, 10.0))
def test_a_scale_bar_is_round_and_as_long_as_it_may_be(most: float) -> None:
    length = round_length(most)
    assert length <= most * (1.0 + 1e-6) and 2.5 * length > most * (1.0 - 1e-6)
    digits = f"{length:.6e}".split("e")[0]
    assert digits in ("1.000000", "2.000000", "5.000000")
