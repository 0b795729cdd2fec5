"""Jaws whose convex hull fills what grips."""

import warnings

import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError, InputWarning
from holdfast.geometry import ConvexSurface
from holdfast.hands import load_hand

SLIDE = """<body name="{name}" pos="{x} 0 0.03" quat="{turn}"><joint name="{name}_slide" type="slide"
axis="1 0 0" range="0 0.01"/><geom type="mesh" mesh="jaw" mass="0.03"/></body>"""
HALF_FINGER_M, FOOT_M = 0.003, 0.006


def hooked_jaws(folder, hook: float, *, rest: str = ""):
    """Two jaws that slide along x, each with a foot that reaches inward by `hook` below its pad."""
    foot = trimesh.creation.box((2 * HALF_FINGER_M + hook, 0.02, FOOT_M))
    foot.apply_translation((0.5 * hook, 0.0, 0.5 * FOOT_M))
    finger = trimesh.creation.box((2 * HALF_FINGER_M, 0.02, 0.05))
    finger.apply_translation((0.0, 0.0, 0.025))
    jaw = trimesh.util.concatenate([foot, finger])
    jaw.export(folder / "jaw.stl")
    jaws = "".join(
        SLIDE.format(name=name, x=-0.04 * side, turn=turn)
        for name, side, turn in (("left", 1, "1 0 0 0"), ("right", -1, "0 0 0 1"))
    )
    (folder / "h.xml").write_text(
        f"""<mujoco><asset><mesh name="jaw" file="jaw.stl"/></asset><worldbody><body name="palm">
        <geom type="box" size="0.05 0.02 0.01" mass="0.3"/>{jaws}</body></worldbody></mujoco>""",
        "utf-8",
    )
    (folder / "h.yaml").write_text(f"import: h.xml\n{rest}", "utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        hand = load_hand(folder / "h.yaml")
    return hand, [str(one.message) for one in caught]


@pytest.mark.parametrize("hook", [0.0, 0.035])
def test_pads_lie_on_the_mesh_and_not_on_a_hull_that_fills_a_hook(tmp_path, hook):
    hand, said = hooked_jaws(tmp_path, hook)
    assert said == []
    told = [note for note in hand.notes if "hollow where they touch" in note]
    assert len(told) == (1 if hook else 0)
    for name in ("left", "right"):
        entry = hand.regions[f"{name}/pad"]
        point, normal = entry.region.middle()
        assert np.allclose(normal, [1.0, 0.0, 0.0], atol=1e-6)
        assert point[0] == pytest.approx(HALF_FINGER_M, abs=1e-5)
        assert point[2] > FOOT_M
        shapes = hand.links[entry.link].shapes
        assert 1 <= len(shapes) <= 3
        assert (len(shapes) > 1) == bool(hook)


def test_what_the_hull_held_is_held_by_the_pieces_but_for_the_hollow(tmp_path):
    hand, _ = hooked_jaws(tmp_path, 0.035)
    surface = ConvexSurface(hand.links[1].shapes)
    inside = np.array([[0.0, 0.0, 0.03], [0.03, 0.005, 0.003], [-0.002, -0.009, 0.049], [0.0, 0.0, 0.003]])
    in_the_hollow = np.array([[0.02, 0.0, 0.02], [0.01, 0.005, 0.03], [0.006, -0.009, 0.04]])
    assert surface.signed_distances(inside).max() < 0.0
    assert surface.signed_distances(in_the_hollow).min() > 0.0


def test_a_region_that_a_file_gives_within_a_hook_is_freed(tmp_path):
    pad = "{link: left, bezier: [[[0.003, -0.005, 0.01], [0.003, 0.005, 0.01]], [[0.003, -0.005, 0.03], "
    hand, said = hooked_jaws(tmp_path, 0.035, rest=f"regions:\n  left/pad: {pad}[0.003, 0.005, 0.03]]]}}\n")
    assert said == []
    points, normals = hand.regions["left/pad"].region.spread()
    by_link = {link.name: link.shapes for link in hand.links}
    assert np.abs(ConvexSurface(by_link["left"]).compare(points, normals)[0]).max() < 1e-5
    assert len(by_link["left"]) > 1
    assert len(by_link["right"]) == 1  # nothing touches there


def test_a_mesh_without_an_inside_keeps_its_hull_and_is_warned_of(tmp_path, monkeypatch):
    def refuse(*_):
        raise InputError("h.yaml", "mesh", "is not closed")

    monkeypatch.setattr("holdfast.hands.models.hollows.closed_mesh", refuse)
    hand, said = hooked_jaws(tmp_path, 0.035)
    assert [len(link.shapes) for link in hand.links[1:]] == [1, 1]
    assert len(said) == 2
    assert all("/pad: leans by" in words and "several convex meshes" in words for words in said)
    (told,) = [note for note in hand.notes if "lie before the mesh" in note]
    assert "left/pad" in told
    assert "right/pad" in told
