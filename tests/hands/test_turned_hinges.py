"""Axes that are turned round, and pads that lean: what a model seems to get wrong is warned of."""

import warnings

import pytest
import trimesh
from holdfast.errors import InputWarning
from holdfast.hands import load_hand

from .test_found_regions import BLOCK, finger, model

ROW = {"index": -0.03, "middle": -0.01, "ring": 0.01, "little": 0.03}


def turned_hinges(folder, *turned: str) -> list[str]:
    """What is warned of in a hand of four fingers and a thumb, with the axes of some joints turned round."""
    parts = [
        finger(name, -0.03, -1.0, BLOCK).replace('pos="-0.03 0', f'pos="-0.03 {y}') for name, y in ROW.items()
    ]
    text = model("".join(parts) + finger("thumb", 0.03, 1.0, BLOCK))
    for joint in turned:
        for axis in ("0 1.0 0", "0 -1.0 0"):
            other = "0 -1.0 0" if axis == "0 1.0 0" else "0 1.0 0"
            if f'name="{joint}" axis="{axis}"' in text:
                text = text.replace(f'name="{joint}" axis="{axis}"', f'name="{joint}" axis="{other}"')
                break
        else:
            raise AssertionError(joint)
    (folder / "h.xml").write_text(text, "utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        load_hand(folder / "h.xml")
    return [str(one.message).split("h.xml: ")[1] for one in caught]


@pytest.mark.parametrize(
    ("turned", "words"),
    [
        ((), None),
        (("ring_bend",), "joint ring_bend: bends the other way than the rest of its finger"),
        (("ring_base",), "joint ring_base: bends the other way than the rest of its finger"),
        (("ring_base", "ring_bend"), "joint ring_base: bends the other way than all other fingers"),
        (tuple(f"{name}_bend" for name in (*ROW, "thumb")), None),  # as some hands are built
    ],
)
def test_a_finger_that_bends_against_itself_or_all_others_is_warned_of(tmp_path, turned, words):
    said = turned_hinges(tmp_path, *turned)
    if words is None:
        assert said == []
    else:
        (told,) = said
        assert told.startswith(words) and "is its axis turned round" in told


@pytest.mark.parametrize("hook", [0.0, 0.035])
def test_jaws_whose_hulls_fill_what_grips_are_warned_of(tmp_path, hook):
    """A jaw with a foot that reaches inward: without the hollow its pad is a slope."""
    foot = trimesh.creation.box((0.006 + hook, 0.02, 0.006))
    foot.apply_translation((0.5 * hook, 0.0, 0.003))
    finger_mesh = trimesh.creation.box((0.006, 0.02, 0.05))
    finger_mesh.apply_translation((0.0, 0.0, 0.025))
    trimesh.util.concatenate([foot, finger_mesh]).export(tmp_path / "jaw.stl")
    jaws = "".join(
        f"""<body name="{name}" pos="{-0.04 * side} 0 0.03" quat="{turn}"><joint name="{name}_slide"
        type="slide" axis="1 0 0" range="0 0.01"/><geom type="mesh" mesh="jaw" mass="0.03"/></body>"""
        for name, side, turn in (("left", 1, "1 0 0 0"), ("right", -1, "0 0 0 1"))
    )
    asset = '<asset><mesh name="jaw" file="jaw.stl"/></asset></mujoco>'
    (tmp_path / "h.xml").write_text(model(jaws).replace("</mujoco>", asset), "utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        load_hand(tmp_path / "h.xml")
    said = [str(one.message) for one in caught]
    assert len(said) == (2 if hook else 0)
    assert all("/pad: leans by" in words and "several convex meshes" in words for words in said)
