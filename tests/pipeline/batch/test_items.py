"""What a batch is asked for by words."""

import os
from pathlib import Path

import pytest
from holdfast.errors import InputError
from holdfast.pipeline.batch import items_of, read_list


def test_words_become_items_with_names_of_their_own(tmp_path: Path) -> None:
    words = [
        "upholding", "scalpel/upholding", "family:mug:7-9", "a/pinch.yaml", "b/pinch.yaml",
        "b/../a/pinch.yaml", "cup.obj", "upholding@shadow", "pinch.yaml@hands/my.yaml", "family:box:3@shadow",
    ]  # fmt: skip
    items = items_of([*words, *words])
    here = os.getcwd()
    assert [item.reference for item in items] == [
        "upholding", "scalpel/upholding", "family:mug:7", "family:mug:8", "family:mug:9",
        f"{here}/a/pinch.yaml", f"{here}/b/pinch.yaml", f"{here}/cup.obj", "upholding@shadow",
        f"{here}/pinch.yaml@{here}/hands/my.yaml", "family:box:3@shadow",
    ]  # fmt: skip
    names = [item.name for item in items]
    assert len(set(names)) == len(names)
    assert all("/" not in name and not name.startswith(".") and len(name) < 100 for name in names)
    assert [item.is_mesh for item in items].index(True) == names.index("cup")


def test_a_hand_takes_the_place_of_the_tasks_own() -> None:
    assert [item.reference for item in items_of(["upholding@sa", "family:mug:1"], "shadow")] == [
        "upholding@shadow",
        "family:mug:1@shadow",
    ]


@pytest.mark.parametrize("wrong", [[], ["family:mug:5-4"], ["family:mug:0-1000000"]])
def test_what_names_nothing_is_refused(wrong: list[str]) -> None:
    with pytest.raises(InputError, match="batch: "):
        items_of(wrong)


def test_a_folder_stands_for_its_tasks_and_meshes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mixed" / "deeper").mkdir(parents=True)
    texts = {
        "pinch.yaml": "contacts: []", "slip.yml": "contacts: [", "box.yaml": "box: {}", "cup.OBJ": "",
        "a.txt": "", ".hidden.yaml": "contacts: []",
    }  # fmt: skip
    for name, text in texts.items():
        (tmp_path / "mixed" / name).write_text(text, "utf-8")
    said: list[str] = []
    items = items_of(["mixed", "mixed/pinch.yaml"], on_folder=lambda _, found: said.append(str(found)))
    assert [Path(item.reference).name for item in items] == ["cup.OBJ", "pinch.yaml", "slip.yml"]
    assert said == ["a.txt, box.yaml, deeper/"]
    with pytest.raises(InputError, match=r"mixed/deeper: is a folder with no task file.*holds nothing"):
        items_of(["mixed/deeper"])
    # A run leaves a folder that is called like its task.
    (tmp_path / "upholding").mkdir()
    assert items_of(["upholding"])[0].reference == "upholding"


def test_lists_have_comments(tmp_path: Path) -> None:
    path = tmp_path / "tasks.txt"
    path.write_text("# those to begin with\nupholding\n\n  family:mug:0-3  \n", "utf-8")
    assert read_list(path) == ["upholding", "family:mug:0-3"]
    with pytest.raises(InputError):
        read_list(tmp_path / "no.txt")
