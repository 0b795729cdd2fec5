"""The wheel holds the package and nothing else; the repository names no machine and no package index."""

import fnmatch
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
NOT_PACKAGED = {"tests", "benchmarks", "docs", "examples"}
LARGEST_BYTES = 1_000_000

# Each pattern is written so that it does not match itself.
FORBIDDEN = {
    "index option": re.compile(r"--(?:extra-)?index-url|--find[-]links|--trusted[-]host"),
    "index address": re.compile(r"files[.]pythonhosted|pypi[.]org/simple"),
    "machine path": re.compile(r"(?<![\w.:/<>-])/(?:home|root|Users|work|workspace|opt|tmp|mnt|var|srv)/\w"),
}


def repository_files() -> list[Path]:
    """Every file that is not ignored, relative to the root; without git, which a user may not have."""
    lines = (ROOT / ".gitignore").read_text("utf-8").splitlines()
    ignored = [".git", *(line.rstrip("/") for line in lines if line and not line.startswith("#"))]

    def kept(names: list[str]) -> list[str]:
        return [name for name in names if not any(fnmatch.fnmatch(name, pattern) for pattern in ignored)]

    found = []
    for folder, folders, files in os.walk(ROOT):
        folders[:] = kept(folders)
        found += [(Path(folder) / name).relative_to(ROOT) for name in kept(files)]
    return sorted(found)


def package_folders(files: list[Path]) -> list[Path]:
    return [file.parent for file in files if file.name == "__init__.py" and file.parts[0] not in NOT_PACKAGED]


def pinned(name: str) -> dict[str, list[Requirement]]:
    """Requirements of a pinned file by name; several where the version depends on the Python."""
    text = (ROOT / name).read_text("utf-8").replace("\\\n", " ")
    found: dict[str, list[Requirement]] = {}
    for line in text.splitlines():
        if not line or line.startswith("#"):
            continue
        requirement, *hashes = line.split(" --hash=sha256:")
        assert hashes, f"{name}: no hash for {requirement}"
        parsed = Requirement(requirement.strip())
        found.setdefault(canonicalize_name(parsed.name), []).append(parsed)
    return found


def test_listed_packages_are_the_folders_with_an_init() -> None:
    folders = package_folders(repository_files())
    expected = {".".join(["holdfast", *folder.parts]) for folder in folders}
    assert set(PROJECT["tool"]["setuptools"]["packages"]) == expected


@pytest.fixture(scope="module")
def distributions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the wheel and the source distribution of a copy of the repository."""
    files, folder = repository_files(), tmp_path_factory.mktemp("built")
    copy = folder / "a copy"
    for file in files:
        (copy / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / file, copy / file)
    built = subprocess.run(
        [
            sys.executable,
            "-P",
            "-m",
            "build",
            "--wheel",
            "--sdist",
            "--no-isolation",
            "--outdir",
            folder,
            copy,
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


def test_the_source_distribution_has_what_the_wheel_leaves_out(distributions: Path) -> None:
    (sdist,) = distributions.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    files = [file for file in repository_files() if file.parts[0] in ("docs", "examples")]
    assert len(files) > 20
    assert {file.as_posix() for file in files} <= names
    assert {"README.md", "CHANGELOG.md", "CITATION.cff", "LICENSE", "mkdocs.yml", "pyproject.toml"} <= names
    assert not [name for name in names if name.endswith((".pyc", ".nbi", ".nbc"))]


def test_wheel_holds_every_file_of_the_package_and_nothing_else(distributions: Path) -> None:
    files = repository_files()
    (wheel,) = distributions.glob("*.whl")

    rooms = {folder.parts[0] for folder in package_folders(files) if folder.parts}
    expected = {file.as_posix() for file in files if file.parts[0] in rooms}
    expected |= {file.name for file in files if len(file.parts) == 1 and file.suffix == ".py"}
    expected.add("py.typed")
    with zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if not name.endswith("/")]
        info = f"holdfast-{PROJECT['project']['version']}.dist-info"
        packaged = {name for name in names if not name.startswith(f"{info}/")}
        entry_points = archive.read(f"{info}/entry_points.txt").decode()
        metadata = archive.read(f"{info}/METADATA").decode()
    assert packaged == {f"holdfast/{name}" for name in expected}
    assert "holdfast = holdfast.pipeline.cli:main" in entry_points
    assert "holdfast/pipeline/cli/main.py" in packaged
    assert "License-Expression: Apache-2.0" in metadata
    assert f"{info}/licenses/LICENSE" in names


def test_pinned_files_satisfy_the_project() -> None:
    runtime, development = pinned("requirements.txt"), pinned("requirements-dev.txt")
    assert {name: development[name] for name in runtime} == runtime
    for asked, available in [
        (PROJECT["project"]["dependencies"], runtime),
        (PROJECT["dependency-groups"]["dev"], development),
        (PROJECT["build-system"]["requires"], development),
    ]:
        for requirement in map(Requirement, asked):
            for pin in available[canonicalize_name(requirement.name)]:
                (exact,) = pin.specifier
                assert exact.operator == "=="
                assert requirement.specifier.contains(exact.version), f"{pin} does not meet {requirement}"


@pytest.mark.parametrize("what", FORBIDDEN)
def test_no_file_names_a_machine_or_an_index(what: str) -> None:
    hits = []
    for file in repository_files():
        text = (ROOT / file).read_bytes().decode("utf-8", errors="replace")
        hits += [f"{file}: {match.group()!r}" for match in FORBIDDEN[what].finditer(text)]
    assert not hits


def test_files_are_small() -> None:
    assert not [file for file in repository_files() if (ROOT / file).stat().st_size > LARGEST_BYTES]


def test_version_is_the_same_everywhere() -> None:
    version = PROJECT["project"]["version"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert citation["version"] == version
    assert f"## [{version}]" in (ROOT / "CHANGELOG.md").read_text("utf-8")
