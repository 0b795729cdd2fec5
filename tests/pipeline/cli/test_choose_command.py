"""`holdfast choose`: models and studies as files, clean JSON, and one line for what is wrong."""

import json
from pathlib import Path
from typing import Any

import pytest
from holdfast.pipeline.choice import ARRAYS_FILE, DATASET_FILE, SCHEMA_VERSION, write_arrays
from holdfast.pipeline.choose import load_model
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import find_command

from ..choice.synthetic import make_choice_data


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data set of 60 objects of a known law."""
    path = tmp_path_factory.mktemp("data") / "grasps"
    path.mkdir()
    data = make_choice_data(groups=60, candidates=5)
    head = {
        "schema_version": SCHEMA_VERSION,
        "loads": list(data.loads),
        "hands": [{"name": "sa", "hash": "a" * 64}, {"name": "shadow", "hash": "b" * 64}],
        "features": [feature.as_record() for feature in data.feature_specs],
        "object_features": [feature.as_record() for feature in data.object_specs],
        "conditions": [{"name": name} for name in data.condition_names],
    }
    (path / DATASET_FILE).write_text(json.dumps(head), "utf-8")
    write_arrays(path / ARRAYS_FILE, data)
    return path


def evaluated(capsys: pytest.CaptureFixture[str], *words: object) -> dict[str, Any]:
    """What `--json -` writes to stdout, and nothing else."""
    assert main(["choose", "evaluate", *map(str, words), "--json", "-", "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    found = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert isinstance(found, dict)
    return found


def train(folder: Path, out: Path, *words: str) -> None:
    assert main(["choose", "train", str(folder), "--out", str(out), "--quiet", *words]) == 0


def test_models_are_judged_by_objects_that_they_have_not_seen(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    train(folder, tmp_path / "plain.json", "--policy", "logistic")
    train(folder, tmp_path / "boosted.json", "--policy", "boosting")
    assert capsys.readouterr().out.split() == [
        str(tmp_path / name) for name in ("plain.json", "boosted.json")
    ]
    model = load_model(tmp_path / "boosted.json")
    assert (model.policy, len(model.trained_on.objects)) == ("boosting", 49)
    assert model.trained_on.hands == {"sa": "a" * 64, "shadow": "b" * 64}
    found = evaluated(capsys, folder, tmp_path / "plain.json", tmp_path / "boosted.json")
    assert [entry["load"] for entry in found["comparisons"]] == [1.0, 2.0]
    for entry in found["comparisons"]:
        assert entry["objects"] == 11
        success = {one["policy"]: one["success"][0] for one in entry["policies"]}
        assert success["oracle"] >= success["boosted"] > success["formula:epsilon"]
        assert success["plain"] > success["random"]


def test_a_hand_is_left_out(folder: Path, tmp_path: Path) -> None:
    train(folder, tmp_path / "m.json", "--policy", "logistic", "--without-hand", "shadow")
    model = load_model(tmp_path / "m.json")
    assert set(model.trained_on.hands) == {"sa"}
    assert all(column.kind == "free" for column in model.columns)


def test_policies_are_trained_anew_without_models(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "page.html"
    words = ("--policies", "random, logistic", "--unseen", "object,hand", "--seeds", "2", "--out", page)
    found = evaluated(capsys, folder, *words)
    assert [entry["unseen"] for entry in found["comparisons"]] == ["object", "object", "hand", "hand"]
    assert found["seeds"] == 2 and found["data"]["objects"] == 60
    assert page.read_text("utf-8").startswith("<!doctype html>")
    assert main(["choose", "evaluate", str(folder), *map(str, words[:-2]), "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "unseen hand, load 2: 60 situations of 60 objects" in out and "On an unseen object" in out


def test_what_is_wrong_is_one_line(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = tmp_path / "model.json"
    train(folder, model, "--policy", "random")
    other = tmp_path / "other.json"
    other.write_text("{}", "utf-8")
    capsys.readouterr()
    data = str(folder)
    for words, expected in (
        (["train", str(tmp_path / "none"), "--out", str(model)], "is no data set"),
        (["train", data, "--policy", "bosting", "--out", str(model)], "did you mean 'boosting'?"),
        (["train", data, "--without-hand", "claw", "--out", str(model)], "unknown hand 'claw'"),
        (
            ["train", data, "--without-hand", "sa", "--without-hand", "shadow", "--out", str(model)],
            "no situation of the data is left",
        ),
        (["train", data], "--out"),
        (["evaluate", data, str(other)], "format: must be 'holdfast choice model'"),
        (["evaluate", data, str(tmp_path / "gone.json")], "no such file"),
        (["evaluate", data, str(model), str(model), str(model)], "stands twice"),
        (["evaluate", data, str(model), "--unseen", "hand"], "goes without models"),
        (["evaluate", data, "--unseen", "foot"], "unknown question 'foot'"),
        (["evaluate", data, "--policies", "oracle"], "unknown policy 'oracle'"),
    ):
        assert main(["choose", *words]) == 2, words
        out, err = capsys.readouterr()
        assert out == "" and err.count("\n") == 1 and expected in err, (words, err)


def test_commands_of_the_documentation_are_as_they_say(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Those on a model run; the others, which take long or simulate, are read."""
    text = (Path(__file__).resolve().parents[3] / "docs" / "choosing.md").read_text("utf-8")
    lines = [line.split()[1:] for line in text.splitlines() if line.startswith("    holdfast ")]
    assert len(lines) == 8
    (tmp_path / "grasps").symlink_to(folder)
    monkeypatch.chdir(tmp_path)
    for words in lines:
        command, rest = find_command(words)
        assert command is not None
        _, unknown = command_parser(command).parse_known_args(rest)
        assert not unknown
    for words in lines[:2]:
        assert main(words) == 0
    out = capsys.readouterr().out
    assert "model.json" in out and "unseen object, load 2" in out
