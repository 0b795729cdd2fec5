"""Pads against pressure that is added up cell by cell, and what files may say of them."""

import re
from pathlib import Path

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.hands import Pad, load_hand

CURVED = np.array([[77.0, 188.0], [77.0, 77.0], [120.0, 900.0]])
FORCES_N = np.array([2.0, 25.0, 0.7])


@pytest.mark.parametrize("i", range(3))
def test_force_and_arm_are_those_of_the_pressure_added_up(i: int) -> None:
    """An elastic foundation on a grid: the force of a yield, and the mean arm of its pressure."""
    pad = Pad(2.0e6, 0.02)
    yield_m = pad.yield_m(FORCES_N, CURVED)[i]
    k1, k2 = CURVED[i]
    half = np.sqrt(2.0 * yield_m / k1), np.sqrt(2.0 * yield_m / k2)
    x, y = np.meshgrid(*(np.linspace(-a, a, 601) for a in half), indexing="ij")
    depth = np.maximum(0.0, yield_m - 0.5 * k1 * x**2 - 0.5 * k2 * y**2)
    cell = 4.0 * half[0] * half[1] / 600**2
    assert pad.modulus_Pa / pad.thickness_m * depth.sum() * cell == pytest.approx(FORCES_N[i], rel=1e-3)
    arm_m = (depth * np.hypot(x, y)).sum() / depth.sum()
    assert pad.spin_arm_m(FORCES_N, CURVED)[i] == pytest.approx(arm_m, rel=1e-3)


def test_known_figures_of_a_fingertip_of_13_mm() -> None:
    """On a flat face and on a rod of radius 9 mm."""
    tip, rod = 1.0 / 0.013, 1.0 / 0.009
    curvatures = np.array([[tip, tip], [tip, tip + rod], [tip, tip + rod]])
    arms = Pad().spin_arm_m(np.array([25.0, 2.0, 20.0]), curvatures)
    assert 1e3 * arms == pytest.approx([3.3, 1.6, 2.9], abs=0.05)
    assert 1e3 * Pad().yield_m(np.array([21.0]), curvatures[:1]) == pytest.approx([1.4], abs=0.05)


def test_a_pad_yields_more_the_softer_and_the_sharper_and_arms_stay_within_it() -> None:
    rng = np.random.default_rng(3)
    forces, curvatures = rng.uniform(0.1, 200.0, 50), rng.uniform(-50.0, 900.0, (50, 2))
    firm, soft = Pad(), Pad(modulus_Pa=1.0e6)
    assert np.all(soft.yield_m(forces, curvatures) > firm.yield_m(forces, curvatures))
    assert np.all(firm.yield_m(forces, curvatures + 100.0) > firm.yield_m(forces, curvatures))
    arms = soft.spin_arm_m(forces, curvatures)
    assert np.all((arms > 0.0) & (arms <= soft.largest_arm_m * (1.0 + 1e-9)))
    assert firm.yield_m(np.array([-1.0]), curvatures[:1]) == 0.0


def test_a_patch_ends_where_the_pad_does_and_resists_less_spin() -> None:
    pad, flat = Pad(), np.array([[0.0, 0.0]])
    force = np.array([25.0])
    ((free_m, _),) = pad.patch_m(force, flat)
    edges = np.array([[[0.5 * free_m, np.inf], [np.inf, np.inf]]])
    assert pad.patch_m(force, flat, edges)[0] == pytest.approx([0.75 * free_m, free_m])
    assert pad.spin_arm_m(force, flat, np.full((1, 2, 2), np.inf)) == pad.spin_arm_m(force, flat)
    arms = [
        pad.spin_arm_m(force, flat, np.full((1, 2, 2), share * free_m))[0] for share in (0.2, 0.5, 1.0, 2.0)
    ]
    assert arms[0] < arms[1] < arms[2] == arms[3] == pad.spin_arm_m(force, flat)[0]
    assert arms[1] == pytest.approx(0.5 * arms[2])  # a round patch of half the radius


def test_the_sa_hand_states_its_pads() -> None:
    hand = load_hand("sa")
    assert hand.pad == Pad(3.5e6, 0.013)
    assert hand.rated_force_N == 30.0 and hand.max_normal_force_N is None


HAND = """
name: stub
{more}
actuators: {{servo: {{effort: 1.0, stiffness: 10.0, damping: 0.1, armature: 0.001}}}}
links:
  - {{name: palm, mass: 0.1, shapes: [{{sphere: {{centre: [0, 0, 0], radius: 0.02}}}}]}}
  - {{name: tip, mass: 0.1, shapes: [{{sphere: {{centre: [0.05, 0, 0], radius: 0.01}}}}]}}
joints:
  - parent: palm
    child: tip
    type: revolute
    position: [0.02, 0, 0]
    axes: [{{name: bend, direction: [0, -1, 0], limits: [0, 1], actuator: servo}}]
"""


def test_a_hand_file_may_state_its_own(tmp_path: Path) -> None:
    path = tmp_path / "stub.yaml"
    path.write_text(HAND.format(more="pad: {modulus: 800000.0}\nmax_normal_force: 12.0"))
    hand = load_hand(path)
    assert hand.pad == Pad(0.8e6, 0.013)
    assert hand.max_normal_force_N == 12.0


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ("pad: {modulus: 0.0}", "pad.modulus"),
        ("pad: {thickness: -0.01}", "pad.thickness"),
        ("pad: {softness: 3.0}", "pad.softness"),
        ("rated_force: much", "rated_force"),
        ("max_normal_force: 0.0", "max_normal_force"),
    ],
)
def test_pads_that_can_not_be_are_refused(tmp_path: Path, more: str, field: str) -> None:
    path = tmp_path / "stub.yaml"
    path.write_text(HAND.format(more=more))
    with pytest.raises(InputError, match=re.escape(field)):
        load_hand(path)


def test_a_pad_needs_figures_above_zero() -> None:
    with pytest.raises(InputError, match=r"Pad\.modulus_Pa"):
        Pad(modulus_Pa=0.0)
