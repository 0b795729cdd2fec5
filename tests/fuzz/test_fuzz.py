"""Some hundred damaged inputs: refused in one line, or harmless. `./run bench fuzz` tries thousands."""

import pytest

from .kinds import KINDS
from .law import broken_law, try_one, warm_up

# What takes longer to read is tried less often, and what draws or solves by the benchmark alone.
COUNTS = {"built hand": 4, "checkpoint": 8, "system": 10, "run": 20, "picture": 6, "grasp": 12}
COUNTS |= {"mesh object": 8, "mesh of an object": 8, "edited task": 6, "edited mesh": 6, "new hand": 8}
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


def test_good_inputs_are_read(tmp_path):
    for name in ("task", "object", "imported hand", "mesh object", "new hand", "obj", "glb", "run", "proof"):
        kind = KINDS[name]()
        folder = tmp_path / name
        for file, data in (*kind.beside, (kind.name, kind.good)):
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_bytes(data)
        assert broken_law([word.replace("{}", kind.name) for word in kind.words], folder) == "", name
