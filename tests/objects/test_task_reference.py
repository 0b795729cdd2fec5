"""Tasks with another hand: `task@hand`."""

import shutil
from pathlib import Path

import pytest
from holdfast.errors import InputError
from holdfast.hands import load_hand
from holdfast.objects import load_task
from holdfast.objects.task_reference import split_reference, with_hand
from holdfast.pipeline.records import fingerprint, relative_source, resolve_source

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "hands"


@pytest.mark.parametrize(
    ("reference", "task", "hand"),
    [
        ("upholding", "upholding", None),
        ("upholding@shadow", "upholding", "shadow"),
        ("a/b.yaml@c/d.yaml", "a/b.yaml", "c/d.yaml"),
        ("upholding@nothing", "upholding@nothing", None),
        ("@sa", "@sa", None),
        ("", "", None),
    ],
)
def test_references_are_split(reference, task, hand):
    assert split_reference(reference) == (task, hand)
    if hand is not None:
        assert with_hand(task, hand) == with_hand(reference, hand) == reference
    assert with_hand(reference, None) == reference


def test_a_file_whose_name_has_the_sign_is_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("pinch@work.yaml").write_text("name: x", "utf-8")
    assert split_reference("pinch@work.yaml") == ("pinch@work.yaml", None)


def test_the_hand_is_put_in_place():
    own = load_task(EXAMPLES / "pinch.yaml")
    other = load_task(f"{EXAMPLES / 'pinch.yaml'}@shadow")
    assert other.hand is load_hand("shadow")
    assert [c.hand.name for c in other.contacts] == [c.hand.name for c in own.contacts]
    assert fingerprint(own) != fingerprint(other)
    assert len(other.limits) == len(other.hand.independent)


def test_a_built_in_task_without_its_regions_lists_those_of_the_hand(tmp_path):
    task = tmp_path / "t.yaml"
    shutil.copy(EXAMPLES / "can.yaml", tmp_path)
    text = (EXAMPLES / "pinch.yaml").read_text("utf-8")
    task.write_text(text.replace("index/tip", "wrist/knob"), "utf-8")
    with pytest.raises(InputError, match=r"region of hand twendy_one 'wrist/knob'; known: .*index/tip"):
        load_task(f"{task}@twendy_one")


def test_unknown_hands_are_refused_by_name():
    with pytest.raises(InputError, match="unknown hand 'shadwo'; did you mean 'shadow'"):
        with_hand("upholding", "shadwo")


def test_paths_are_kept_relative_to_the_file_that_names_them(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    record = tmp_path / "runs" / "x" / "run.json"
    for reference in (
        "upholding@shadow",
        "tasks/pinch.yaml@hands/my.yaml",
        "tasks/pinch.yaml@sa",
        "upholding",
    ):
        written = relative_source(reference, record)
        found = split_reference(resolve_source(written, record))
        for part, original in zip(found, split_reference(reference), strict=True):
            if original is None or not original.endswith(".yaml"):
                assert part == original
            else:
                assert Path(part).resolve() == Path(original).resolve()
    assert (
        relative_source("tasks/pinch.yaml@hands/my.yaml", record)
        == "../../tasks/pinch.yaml@../../hands/my.yaml"
    )
