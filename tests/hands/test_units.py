"""Units that models of hands probably have: joints that hardly turn, and lengths that no hand has."""

import warnings

import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError, InputWarning
from holdfast.hands import load_hand

from .test_odd_models import mjcf, urdf, written


def said(folder, model, hand=None, name="model.xml"):
    """The hand, and what is warned of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        loaded = load_hand(written(folder, model, hand, name))
    return loaded, [str(one.message) for one in caught if issubclass(one.category, InputWarning)]


UNSAID = mjcf().replace(' angle="radian"', "")


def test_angles_without_a_unit_that_can_only_be_radians_are_read_so_and_warned_of(tmp_path):
    turned = UNSAID.replace('quat="0.9 0 0.1 0"', 'euler="0 1.2 0"')
    hand, (words,) = said(tmp_path, turned)
    assert np.ptp(hand.limits, axis=1) == pytest.approx([1.5, 2.0])
    assert "in degrees no joint would turn by more than 2.0: they were read as radians" in words
    assert "`angle: degree`" in words and any("read as radians" in note for note in hand.notes)
    stated, _ = said(tmp_path, turned, {"angle": "radian"})
    assert hand.links[1].T_parent_link0 == pytest.approx(stated.links[1].T_parent_link0)


def test_degrees_that_a_model_says_stay_degrees_and_are_warned_of(tmp_path):
    hand, (words,) = said(tmp_path, mjcf().replace('angle="radian"', 'angle="degree"'))
    assert np.ptp(hand.limits, axis=1) == pytest.approx(np.radians([1.5, 2.0]))
    assert "no joint turns by more than 2.0 degrees" in words and "`angle: radian`" in words


@pytest.mark.parametrize("unit", ["radian", "degree"])
def test_a_hand_file_says_the_unit_of_angles(tmp_path, unit):
    hand, words = said(tmp_path, UNSAID if unit == "radian" else mjcf(), {"angle": unit})
    widths = np.array([1.5, 2.0])
    assert np.ptp(hand.limits, axis=1) == pytest.approx(widths if unit == "radian" else np.radians(widths))
    assert len(words) == (unit == "degree")


@pytest.mark.parametrize(
    ("model", "hand"),
    [
        (mjcf(), None),
        (UNSAID.replace('range="-0.3 1.2"', 'range="-3 12"'), None),
        (UNSAID, {"limits": {"bend": [0.0, 1.0]}}),
    ],
)
def test_joints_that_turn_are_no_matter_of_units(tmp_path, model, hand):
    assert said(tmp_path, model, hand)[1] == []


def test_limits_in_degrees_where_radians_are_needed_are_refused_as_such(tmp_path):
    text = urdf(follow='<limit lower="0" upper="90" effort="2" velocity="1"/>')
    with pytest.raises(InputError, match=r"rad, not \(0.0, 90.0\): are they in degrees"):
        load_hand(written(tmp_path, text, name="model.urdf"))


@pytest.mark.parametrize(("factor", "size"), [(80.0, "6.51 m"), (0.1, "0.00813 m")])
def test_sizes_that_no_hand_has_are_warned_of(tmp_path, factor, size):
    text = mjcf()
    for old in ("0 0.01 0.05", "0 0 0.04", "0 0 0.01"):
        text = text.replace(f'"{old}"', f'"{" ".join(f"{factor * float(x):g}" for x in old.split())}"')
    for old in ("0.02", "0.01"):
        text = text.replace(f'size="{old}"', f'size="{factor * float(old):g}"')
    words = said(tmp_path, text)[1][0]  # fingers of a metre are told as limbs as well
    assert f"the hand is {size} large" in words and "scales of its meshes" in words


def test_meshes_in_millimetres_are_refused_as_such(tmp_path):
    trimesh.creation.box((20.0, 20.0, 40.0)).export(tmp_path / "tip.stl")
    mesh = '<asset><mesh name="tip" file="tip.stl"/></asset>'
    text = mjcf(two='<geom type="mesh" mesh="tip" mass="0.03"/>', rest=mesh)
    with pytest.raises(InputError, match="is it in mm"):
        load_hand(written(tmp_path, text))
    scaled = text.replace('file="tip.stl"', 'file="tip.stl" scale="0.001 0.001 0.001"')
    assert said(tmp_path, scaled)[1] == []
