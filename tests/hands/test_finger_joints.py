"""Fingers as groups of joints, of hands with and without couplings between them."""

from pathlib import Path

import numpy as np
import pytest
from holdfast.hands import builtin_hands, finger_joints, load_hand, mirrored


def test_the_sa_hand_has_four_fingers_and_the_thumb_has_its_base() -> None:
    hand = load_hand("sa")
    fingers = finger_joints(hand)
    names = {name: [hand.independent_names[j] for j in joints] for name, joints in fingers.items()}
    assert set(names) == {"ring", "middle", "index", "thumb"}
    for name in ("ring", "middle", "index"):
        assert names[name] == [f"{name}_abduction", f"{name}_flexion", f"{name}_pip"]
    assert names["thumb"][0] == "thumb_base" and len(names["thumb"]) == 4


def test_every_joint_belongs_to_one_finger() -> None:
    for name in builtin_hands():
        hand = load_hand(name)
        for one in (hand, mirrored(hand)):
            joints = np.concatenate(list(finger_joints(one).values()))
            assert sorted(joints.tolist()) == list(range(len(one.independent))), name


def test_no_joint_moves_links_of_two_fingers() -> None:
    for name in builtin_hands():
        hand = load_hand(name)
        seen: dict[int, str] = {}
        for finger, joints in finger_joints(hand).items():
            axes = np.any(hand.coupling_matrix[:, joints] != 0.0, axis=1)
            for link in np.flatnonzero(hand.tree.moves[:, axes].any(axis=1)):
                assert seen.setdefault(int(link), finger) == finger, (name, hand.links[link].name)


JAWS = """
name: jaws
actuators: {servo: {effort: 20.0, stiffness: 1000.0, damping: 10.0, armature: 0.1}}
links:
  - {name: palm, mass: 0.2, shapes: [{box: {centre: [0, 0, 0], half_extents: [0.02, 0.05, 0.02]}}]}
  - {name: left, mass: 0.05, shapes: [{box: {centre: [0, 0, 0], half_extents: [0.005, 0.005, 0.03]}}]}
  - {name: right, mass: 0.05, shapes: [{box: {centre: [0, 0, 0], half_extents: [0.005, 0.005, 0.03]}}]}
joints:
  - type: prismatic
    parent: palm
    child: left
    position: [0, 0.04, 0.06]
    axes: [{name: close, direction: [0, -1, 0], limits: [0, 0.03], actuator: servo}]
  - type: prismatic
    parent: palm
    child: right
    position: [0, -0.04, 0.06]
    axes: [{name: follow, direction: [0, 1, 0], limits: [0, 0.03], COUPLING}]
"""


@pytest.mark.parametrize(
    ("coupling", "fingers"),
    [("coupled: {to: close}", {"right": [0]}), ("actuator: servo", {"left": [0], "right": [1]})],
)
def test_jaws_are_one_finger_where_one_joint_moves_both(
    coupling: str, fingers: dict[str, list[int]], tmp_path: Path
) -> None:
    path = tmp_path / "jaws.yaml"
    path.write_text(JAWS.replace("COUPLING", coupling))
    assert {name: joints.tolist() for name, joints in finger_joints(load_hand(path)).items()} == fingers
