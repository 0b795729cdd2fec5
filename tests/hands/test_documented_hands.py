"""The hand files that docs/hands.md shows."""

import re
from pathlib import Path

import pytest
from holdfast.hands import load_hand
from holdfast.objects import load_task
from holdfast.solver import solve

ROOT = Path(__file__).resolve().parents[2]
BLOCKS = {
    re.match(r"name: (\w+)", block)[1]: block
    for block in re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "hands.md").read_text("utf-8"), re.S)
}


def test_all_blocks_are_tried_here():
    assert set(BLOCKS) == {"pair", "allegro"}


def test_the_built_hand_does_a_task(tmp_path):
    path = tmp_path / "pair.yaml"
    path.write_text(BLOCKS["pair"], "utf-8")
    hand = load_hand(path)
    # U(RR) has three, URR four degrees of freedom.
    assert len(hand.independent) == 3 + 4 + 4
    result = solve(
        load_task(f"{ROOT / 'examples' / 'hands' / 'pinch.yaml'}@{path}"), candidates=1, budget_s=600.0
    )
    assert result.configurations[0].certified


def test_the_imported_hand_loads(public_hands):
    path = public_hands["allegro"].with_name("documented.yaml")
    path.write_text(BLOCKS["allegro"], "utf-8")
    hand = load_hand(path)
    assert hand.independent_names[:3] == ("index_abduction", "index_flexion", "joint_2.0")
    assert set(hand.regions) == {"index/tip"}


@pytest.mark.parametrize("name", ["allegro", "leap"])
def test_the_examples_give_every_finger_a_tip_and_a_pad(public_hands, name):
    fingers = ("index", "middle", "ring", "thumb")
    regions = {f"{finger}/{part}" for finger in fingers for part in ("tip", "pad")}
    assert regions <= set(load_hand(public_hands[name]).regions)
