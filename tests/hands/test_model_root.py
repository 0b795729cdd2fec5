"""How far above its own folder a model without a hand file is followed."""

from pathlib import Path

import pytest
from holdfast.hands.reader import model_root


def model(folder: Path, mesh: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "hand.urdf"
    path.write_text(f'<robot name="h"><mesh filename="{mesh}"/></robot>', "utf-8")
    return path


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    monkeypatch.delenv("HOLDFAST_ROOT", raising=False)


def test_a_model_opens_its_own_folder(tmp_path: Path) -> None:
    assert model_root(model(tmp_path / "mine", "palm.stl")) == tmp_path / "mine"


@pytest.mark.parametrize("folder", ["urdf", "mjcf"])
def test_a_folder_of_models_has_the_meshes_beside_it(folder: str, tmp_path: Path) -> None:
    assert model_root(model(tmp_path / "mine" / folder, "../meshes/palm.stl")) == tmp_path / "mine"


def test_a_package_is_open_to_its_models(tmp_path: Path) -> None:
    path = model(tmp_path / "pkg" / "robots" / "left", "palm.stl")
    (tmp_path / "pkg" / "package.xml").write_text("<package/>", "utf-8")
    assert model_root(path) == tmp_path / "pkg"


def test_what_a_model_names_opens_nothing_of_the_users(tmp_path: Path) -> None:
    path = model(tmp_path / "a" / "b" / "c", "../../palm.stl")
    assert model_root(path) == tmp_path / "a" / "b" / "c"


def test_what_lies_below_the_current_folder_or_the_root_is_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = model(tmp_path / "a" / "b" / "c", "../../palm.stl")
    monkeypatch.setenv("HOLDFAST_ROOT", str(tmp_path / "a"))
    assert model_root(path) == tmp_path / "a"
    monkeypatch.delenv("HOLDFAST_ROOT")
    monkeypatch.chdir(tmp_path)
    assert model_root(path) == tmp_path / "a"
