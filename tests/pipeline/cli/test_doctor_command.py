"""`holdfast doctor`: what is wrong is found, and what to do is said."""

import json
import sys
from importlib import metadata
from pathlib import Path

import pytest
from holdfast.pipeline.cli.commands.machine import _findings, _needs
from holdfast.pipeline.cli.commands.machine._needs import Need, numbers
from holdfast.pipeline.cli.main import main
from packaging.specifiers import SpecifierSet
from packaging.version import Version


@pytest.fixture(autouse=True)
def _rays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOLDFAST_RENDERER", "rays")


def findings(capsys: pytest.CaptureFixture[str], code: int) -> dict[str, dict[str, str]]:
    assert main(["doctor", "--json", "-"]) == code
    data = json.loads(capsys.readouterr().out)
    assert data["well"] == (code == 0)
    return {row["name"]: row for row in data["findings"]}


def install(monkeypatch: pytest.MonkeyPatch, **versions: str | None) -> None:
    """Lets libraries have other versions than they have, or none."""
    real = metadata.version

    def version(name: str) -> str:
        found = versions.get(name.replace("-", "_"), real(name)) if name in versions else real(name)
        if found is None:
            raise metadata.PackageNotFoundError(name)
        return found

    monkeypatch.setattr(_needs.metadata, "version", version)


def test_a_good_installation_is_well(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "pool").write_bytes(b"x" * 2048)
    monkeypatch.setenv("HOLDFAST_CACHE", str(tmp_path))
    found = findings(capsys, 0)
    assert found["renderer"]["found"] == "rays (as asked)"
    assert found["cache"]["found"] == f"{tmp_path}, 2 KiB"
    assert found["mujoco"]["found"] == metadata.version("mujoco")
    assert found["HOLDFAST_RENDERER"]["found"] == "rays"
    assert main(["doctor"]) == 0
    assert capsys.readouterr().out.endswith("all is well\n")


def test_mujoco_that_is_known_to_be_wrong_is_told(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, mujoco="4.0.0")
    found = findings(capsys, 4)
    assert found["mujoco"]["state"] == "wrong" and "pip install" in found["mujoco"]["advice"]


@pytest.mark.parametrize("version", [None, "0.0.1"])
def test_a_library_that_is_missing_or_too_old_is_told(
    version: str | None, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_findings, "needs", lambda: [Need("trimesh", ">=4.6", None)])
    install(monkeypatch, trimesh=version)
    found = findings(capsys, 4)
    assert found["trimesh"]["found"] == (version or "not installed")
    assert found["trimesh"]["advice"] == "pip install 'trimesh>=4.6'"


def test_an_extra_that_is_not_there_is_no_fault(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_findings, "needs", lambda: [Need("no-such-library", ">=1", "edit")])
    found = findings(capsys, 0)
    assert found["extra edit"]["state"] == "note" and "holdfast[edit]" in found["extra edit"]["advice"]


def test_a_cache_that_can_not_be_written_to_is_told(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_findings.os, "access", lambda *_: False)
    assert "not writable" in findings(capsys, 0)["cache"]["found"]


def test_a_variable_that_means_nothing_is_told(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOLDFAST_RENDERER", "crayons")
    found = findings(capsys, 4)
    assert found["renderer"]["state"] == "wrong" and "crayons" in found["renderer"]["found"]


def test_a_python_that_is_too_new_is_a_note(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_findings.sys, "version_info", (3, 99, 0))
    assert findings(capsys, 0)["version"]["state"] == "note"


@pytest.mark.parametrize("version", ["3.16.9", "3.17", "3.17.0", "3.18.1", "4", "4.0.0", "10.2"])
@pytest.mark.parametrize("bounds", [">=3.17,<4", "<4,>=3.17", ">=3.17", ">=3", ""])
def test_bounds_are_met_as_packaging_has_it(
    version: str, bounds: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_needs.metadata, "version", lambda _: version)
    assert Need("mujoco", bounds, None).is_met == (Version(version) in SpecifierSet(bounds))


def test_versions_are_numbers_of_the_same_length() -> None:
    assert numbers("4") == (4, 0, 0) and numbers("1.2.3.post1") == (1, 2, 3, 1)
    assert numbers("2.10") > numbers("2.9") and sys.version_info >= (3, 11)
