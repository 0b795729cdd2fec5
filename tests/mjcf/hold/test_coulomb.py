"""With our own settings pinched bodies slip where Coulomb's law says so."""

import runpy
from pathlib import Path

import pytest
from holdfast.mjcf import preset_settings
from holdfast.objects import load_task

COULOMB = runpy.run_path(str(Path(__file__).parents[3] / "benchmarks" / "coulomb.py"))


@pytest.mark.parametrize("title", COULOMB["PINCHES"])
def test_a_pinch_holds_just_below_the_critical_load_and_slips_just_above(title: str) -> None:
    settings, pinch = preset_settings("holdfast", load_task("upholding")), COULOMB["PINCHES"][title]
    assert not COULOMB["motion"](pinch, settings, 0.98, 2.0)[0]
    assert COULOMB["motion"](pinch, settings, 1.02, 2.0)[0]


def test_mujocos_defaults_let_a_sphere_go_far_below_it() -> None:
    assert COULOMB["motion"](COULOMB["PINCHES"]["sphere, pulled"], None, 0.5, 2.0)[0]
