"""Enclosures of cosine and sine against a series in whole numbers."""

from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.interval import COSINE, SINE, trig_range

from ...exact import Exact

KINDS = [COSINE, SINE]


def exactly(kind: int, x: float) -> Fraction:
    return Exact.cosine_and_sine(Fraction(x))[kind]


def test_the_oracle_knows_what_everybody_knows():
    assert Exact.cosine_and_sine(Fraction(0)) == (1, 0)
    for x in (Fraction(1, 3), Fraction(-41, 2)):
        cosine, sine = Exact.cosine_and_sine(x)
        assert abs(cosine**2 + sine**2 - 1) < Fraction(1, 10**80)
        double, _ = Exact.cosine_and_sine(2 * x)
        assert abs(double - (2 * cosine**2 - 1)) < Fraction(1, 10**80)
        assert float(cosine) == pytest.approx(np.cos(float(x)), abs=1e-15)


def awkward_numbers(rng: np.random.Generator) -> list[float]:
    """Random ones, and floats next to multiples of pi / 4, where the result or a branch changes."""
    near = [k * np.pi / 4 for k in range(-24, 25)]
    near += [float(np.nextafter(x, towards)) for x in near for towards in (-99.0, 99.0)]
    return [*near, *rng.uniform(-20, 20, 400).tolist(), *(10.0 ** rng.uniform(-300, 0, 50)).tolist(), 0.0]


@pytest.mark.parametrize("kind", KINDS)
def test_values_at_points_are_enclosed_within_some_units_in_the_last_place(kind):
    for x in awkward_numbers(np.random.default_rng(kind)):
        lo, hi = trig_range(kind, x, x)
        assert Fraction(lo) <= exactly(kind, x) <= Fraction(hi), x
        assert -1.0 <= lo <= hi <= 1.0 and hi - lo < 2e-15


@pytest.mark.parametrize("kind", KINDS)
def test_ranges_hold_all_values_and_little_else(kind):
    rng = np.random.default_rng(kind)
    for _ in range(150):
        a, width = rng.uniform(-9, 9), 10.0 ** rng.uniform(-9, 1)
        lo, hi = trig_range(kind, a, a + width)
        points = [a, a + width, *rng.uniform(a, a + width, 12)]
        values = [exactly(kind, x) for x in points]
        assert Fraction(lo) <= min(values) and max(values) <= Fraction(hi)
        f = (np.cos, np.sin)[kind](np.linspace(a, a + width, 2001))
        room = 1e-14 + (width / 2000) ** 2
        assert f.min() - lo < room and hi - f.max() < room


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_unknown_or_far_is_anything_from_minus_one_to_one(kind):
    far = [(-np.inf, np.inf), (np.nan, np.nan), (0.0, np.inf), (1e200, 1e200), (-1e5, -1e5), (0.0, 6.5)]
    for a, b in far:
        assert trig_range(kind, a, b) == (-1.0, 1.0)
    a = 9000.0
    assert trig_range(kind, a, a)[0] <= (np.cos, np.sin)[kind](a) + 1e-12
    assert trig_range(kind, a, a)[1] >= (np.cos, np.sin)[kind](a) - 1e-12


def test_peaks_are_reached_exactly_and_not_overstepped():
    assert trig_range(COSINE, -0.1, 0.1)[1] == 1.0
    assert trig_range(COSINE, 3.1, 3.2)[0] == -1.0
    assert trig_range(SINE, 1.5, 1.6)[1] == 1.0
    assert trig_range(SINE, -1.6, 1.6) == (-1.0, 1.0)
    assert trig_range(SINE, 0.1, 1.5)[1] < 0.998
