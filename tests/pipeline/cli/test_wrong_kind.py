"""A file of another kind than a command takes: one line says what it is, and what to do."""

import gzip
import json
from pathlib import Path

import pytest
from holdfast.pipeline.batch import BatchResult, items_of
from holdfast.pipeline.batch.outcome import Outcome
from holdfast.pipeline.cli.commands.data.batch import say_result
from holdfast.pipeline.cli.file_kinds import KIND_WORDS, kind_of
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import COMMANDS
from holdfast.pipeline.cli.wrong_kind import kinds_taken, of_another_kind

FILES = {
    "task": ("t.yaml", "name: t\nhand: sa\nobject: box.yaml\ncontacts: []\n"),
    "object": ("o.yaml", "name: o\nbox: {half_extents: [0.1, 0.1, 0.1]}\nmass: 1\nfriction: 0.5\n"),
    "hand": ("h.yaml", "name: h\nlinks: []\n"),
    "mesh": ("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    "model": ("r.xml", "<mujoco/>"),
    "grasp": ("run/grasps/g01.json", json.dumps({"joints": {}, "parameters": [], "contacts": []})),
    "record": ("run/run.json", json.dumps({"task": "t", "seed": 0, "settings": {}, "grasps": []})),
    "result": ("r.json", json.dumps({"verdict": "solved", "solutions": [], "seconds": 1.0})),
    "system": ("s.json", json.dumps({"variables": {}, "equations": []})),
    "proof": ("no.proof", ""),
    "report": ("run/report.html", "<html></html>"),
    "picture": ("p.png", "x"),
    "run": ("run", ""),
}
TAKING = [
    (name, taken)
    for name, command in COMMANDS.items()
    for action in command_parser(command)._get_positional_actions()[:1]
    # Batch and table say of each of theirs what is wrong with it, and go on.
    if name not in ("batch", "table") and (taken := kinds_taken(name, action))
]
# What the other arguments have to be before the files are looked at.
MORE = {
    "best": ["--for", "friction"],
    "compare": ["run"],
    "export": ["--format", "isaac_grasp", "--out", "x.yaml"],
    "objects fit": ["--at", "0,0,0", "--radius", "0.01"],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in FILES.values():
        path = tmp_path / name
        if name != "run":
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")
    (tmp_path / "no.proof").write_bytes(gzip.compress(b'{"holdfast_proof": 4}\n'))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("kind", FILES)
def test_every_kind_is_told_from_the_others(kind: str, folder: Path) -> None:
    assert kind_of(FILES[kind][0]) == kind


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("upholding", "task"),
        ("upholding@shadow", "task"),
        ("sa", "hand"),
        ("teapot", "object"),
        ("family:mug:1", None),
        ("nothing", None),
        ("", None),
        ("a\0b", None),
    ],
)
def test_names_of_what_is_built_in_have_kinds(name: str, kind: str | None) -> None:
    assert kind_of(name) == kind


def test_commands_that_read_files_say_what_they_take() -> None:
    assert {"run", "solve", "clear", "hold", "render", "show", "report", "system"} <= {n for n, _ in TAKING}


@pytest.mark.parametrize("kind", FILES)
@pytest.mark.parametrize(("name", "taken"), TAKING)
def test_the_wrong_kind_is_told_in_one_line(
    name: str, taken: tuple[str, ...], kind: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if kind in taken:
        return
    path = FILES[kind][0]
    before = sorted(folder.rglob("*"))
    assert main([*name.split(), path, *MORE.get(name, [])]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1
    assert err.startswith(f"holdfast: {path}: is {KIND_WORDS[kind]}, not {KIND_WORDS[taken[0]]}")
    assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("clear run/run.json", "name one of its grasps, such as run/grasps/g01.json"),
        ("hold run", "name one of its grasps, such as run/grasps/g01.json"),
        ("report run/run.json", "name its folder: run\n"),
        ("report run/report.html", "name the folder of its run: run\n"),
        ("clear upholding", "`holdfast run upholding` makes grasps of it"),
        ("run upholding --hand teapot", "teapot: is an object, not a hand"),
        ("clear run/grasps/g01.json --task o.yaml", "o.yaml: is an object, not a task"),
        ("show s.json", "`holdfast system s.json` solves it"),
    ],
)
def test_what_to_do_is_said(words: str, says: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words.split()) == 2
    assert says in capsys.readouterr().err


def test_a_bad_file_of_the_right_kind_is_told_by_its_field(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "t.yaml"]) == 2
    assert "contacts" in capsys.readouterr().err


def test_a_file_of_no_known_kind_is_told_as_a_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "x.txt").write_text("hello")
    for words, wanted in (("suggest x.txt", "an object"), ("show x.txt", "an object, a mesh")):
        assert main(words.split()) == 2
        assert capsys.readouterr().err.startswith(f"holdfast: x.txt: is not {wanted}")


def test_an_empty_file_is_called_empty(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "e.json").write_text(" \n")
    assert main(["system", "e.json"]) == 2
    assert "e.json: is empty" in capsys.readouterr().err
    assert main(["run", "t.yaml"]) == 2
    assert "contacts: needs at least 1, not 0" in capsys.readouterr().err


def test_batch_says_of_each_task_that_is_none_what_it_is(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name = str(folder / FILES["object"][0])
    assert of_another_kind(str(folder / FILES["mesh"][0]), ("task", "mesh")) is None
    words = of_another_kind(name, ("task", "mesh"))
    assert words is not None and words.startswith("is an object, not a task or a mesh")
    (item,) = items_of([name])
    failed = Outcome(reference=name, name=item.name, state="failed", reason="box: unknown field")
    say_result(BatchResult([item], {item.name: failed}), folder)
    assert f"o: failed: {words}" in capsys.readouterr().out
