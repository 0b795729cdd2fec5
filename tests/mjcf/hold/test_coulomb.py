"""With our own settings pinched bodies slip where Coulomb's law says so."""

import runpy
from pathlib import Path

import pytest
from holdfast.mjcf import preset_settings
from holdfast.objects import load_task

COULOMB = runpy.run_path(str(Path(__file__).parents[3] / "benchmarks" / "holding" / "coulomb.py"))


@pytest.mark.parametrize("title", COULOMB["PINCHES"])
def test_a_pinch_holds_just_below_the_critical_load_and_slips_just_above(title: str) -> None:
    settings, pinch = preset_settings("holdfast", load_task("upholding")), COULOMB["PINCHES"][title]
    assert not COULOMB["motion"](pinch, settings, 0.98, 2.0)[0]
    assert COULOMB["motion"](pinch, settings, 1.02, 2.0)[0]


def test_mujocos_defaults_let_a_sphere_go_far_below_it() -> None:
    assert COULOMB["motion"](COULOMB["PINCHES"]["sphere, pulled"], None, 0.5, 2.0)[0]


def test_a_box_between_fingertips_of_the_hand_slips_where_the_forces_there_say_so() -> None:
    hand = runpy.run_path(str(Path(__file__).parents[3] / "benchmarks" / "holding" / "coulomb_hand.py"))
    task = hand["pinch_task"]("sa", ("index/tip", "thumb/tip"), 0.3)
    pinch = hand["Pinch"](hand["pinch_grasp"](task), preset_settings("holdfast", task))
    for direction, least, most in (((0.0, -1.0, 0.0), 0.98, 1.02), (None, 0.98, 1.02)):
        pinch.slips(direction, 0.0, 0.1)
        load = 0.0
        # Normal forces follow the load: with a few rounds the critical one is that of the forces under it.
        for _ in range(3):
            load = least * pinch.critical(direction)
            assert not pinch.slips(direction, load, 1.0)
        assert pinch.slips(direction, most / least * load, 1.0)
