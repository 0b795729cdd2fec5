"""Some hundred damaged inputs: refused in one line, or harmless. `./run bench fuzz` tries thousands."""

from dataclasses import replace

import pytest

from .kinds import GRASP_FILES, KINDS
from .law import broken_law, try_good, try_one, warm_up

# What takes longer to read is tried less often, and what draws or solves by the benchmark alone.
COUNTS = {"built hand": 4, "checkpoint": 8, "system": 10, "run": 20, "picture": 6, "grasp": 12}
COUNTS |= {"mesh object": 8, "mesh of an object": 8, "edited task": 6, "edited mesh": 6, "new hand": 8}
COUNTS |= dict.fromkeys(GRASP_FILES, 2)
LONG = {
    *("shown object", "shown hand", "shown task", "shown grasp"),
    *("suggested mesh", "run mesh", "run task", "resumed run"),
}


@pytest.fixture(autouse=True, scope="module")
def _warm():
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOLDFAST_RENDERER", "rays")
        patch.setenv("MUJOCO_GL", "disable")
        warm_up()
        yield


@pytest.mark.parametrize("name", [name for name in KINDS if name not in LONG])
def test_damage_is_refused_in_one_line_or_harmless(name, tmp_path):
    kind = KINDS[name]()
    for seed in range(COUNTS.get(name, 20)):
        folder = tmp_path / str(seed)
        folder.mkdir()
        assert try_one(kind, folder, seed) == "", f"{name}, seed {seed}"


@pytest.mark.parametrize(
    "words", [["tasks", "a\0b.yaml"], ["report", ""], ["hold", "\udcff.json"], ["\x1b[31m"]]
)
def test_strange_words_cost_one_line(words, tmp_path):
    assert broken_law(words, tmp_path) == ""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in LONG else []) for name in KINDS]
)
def test_what_is_not_damaged_is_accepted(name, tmp_path):
    assert try_good(KINDS[name](), tmp_path) == ""


def test_a_refused_input_does_not_pass_for_a_good_one(tmp_path):
    kind = replace(KINDS["task"](), good=b"name: [")
    assert "exit code 2" in try_good(kind, tmp_path)


@pytest.mark.parametrize("name", ["task", "grasp"])
def test_a_command_that_is_started_anew_keeps_the_law_as_well(name, tmp_path):
    assert try_one(KINDS[name](), tmp_path, 1, anew=True) == ""
