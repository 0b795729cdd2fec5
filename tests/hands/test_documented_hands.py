"""The hand files that docs/hands.md shows."""

import re
from pathlib import Path

import pytest
from holdfast.hands import load_hand
from holdfast.objects import load_task
from holdfast.solver import solve

ROOT = Path(__file__).resolve().parents[2]
SHOWN = re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "hands.md").read_text("utf-8"), re.S)
BLOCKS = {block.split()[1]: block for block in SHOWN if block.startswith("name: ")}
FIELDS = [block for block in SHOWN if not block.startswith("name: ")]


def test_all_blocks_are_tried_here():
    assert set(BLOCKS) == {"pair", "allegro"} and len(FIELDS) == 1


def test_single_fields_fit_into_a_hand_file(tmp_path):
    path = tmp_path / "pair.yaml"
    path.write_text(BLOCKS["pair"] + "".join(FIELDS), "utf-8")
    hand = load_hand(path)
    assert (hand.pad.thickness_m, hand.rated_force_N, hand.max_normal_force_N) == (0.013, 30.0, 40.0)


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
