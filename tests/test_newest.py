"""The wheel as a user installs it: no pins, the newest allowed versions, an environment of its own."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
NOT_COPIED = shutil.ignore_patterns(
    ".git", ".venv", "__pycache__", "*.egg-info", "build", "dist", "runs", ".*_cache"
)
# What pip says where there is no registry, or none that answers: no version of a package is known to it.
UNREACHABLE = re.compile(
    r"from versions: none\)|connection (broken|error|refused)|timed out|NewConnectionError"
)
# And what it says where versions are known, but do not go together, or not with this Python.
CONFLICT = re.compile(r"ResolutionImpossible|conflict|require a different python version")


def is_unreachable(said: str) -> bool:
    """Whether pip failed for want of a registry, not for what it found there."""
    return bool(UNREACHABLE.search(said)) and not CONFLICT.search(said)


def call(*words: str | Path, folder: Path) -> "subprocess.CompletedProcess[str]":
    """Runs a command in a folder, with nothing of this checkout on the path of imports."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.run(
        [str(word) for word in words],
        cwd=folder,
        env={**environment, "NUMBA_CACHE_DIR": str(folder / "numba")},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def newest(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `holdfast` command of an environment without pins."""
    folder = tmp_path_factory.mktemp("newest")
    shutil.copytree(ROOT, folder / "copy", ignore=NOT_COPIED)
    build = (
        sys.executable,
        "-P",
        "-m",
        "build",
        "--wheel",
        "--no-isolation",
        "--outdir",
        folder,
        folder / "copy",
    )
    built = call(*build, folder=folder)
    assert built.returncode == 0, built.stderr
    (wheel,) = folder.glob("*.whl")
    assert call(sys.executable, "-m", "venv", folder / "venv", folder=folder).returncode == 0
    python = folder / "venv" / "bin" / "python"
    installed = call(python, "-m", "pip", "install", "--quiet", wheel, folder=folder)
    if installed.returncode != 0 and is_unreachable(installed.stderr):
        pytest.skip(f"the newest versions can't be fetched: {installed.stderr.strip().splitlines()[-1]}")
    assert installed.returncode == 0, installed.stderr
    return python.with_name("holdfast")


@pytest.mark.parametrize(
    ("said", "unreachable"),
    [
        ("ERROR: Could not find a version that satisfies the requirement numpy (from versions: none)", True),
        ("WARNING: Retrying after connection broken by 'NewConnectionError'", True),
        (
            "ERROR: Could not find a version that satisfies the requirement numpy>99 (from versions: 1.0)",
            False,
        ),
        (
            "ERROR: Cannot install a and b because these package versions have conflicting dependencies.",
            False,
        ),
        (
            "ERROR: Ignored the following versions that require a different python version: 3.0\n"
            "ERROR: Could not find a version that satisfies the requirement x (from versions: none)",
            False,
        ),
    ],
)
def test_a_conflict_of_versions_is_no_missing_registry(said: str, unreachable: bool) -> None:
    assert is_unreachable(said) is unreachable


@pytest.mark.slow  # installs some 40 packages and compiles the inner loops
def test_the_newest_allowed_versions_work(newest: Path, tmp_path: Path) -> None:
    # The first call compiles; the second is what scripts read.
    for _ in range(2):
        solved = call(newest, "solve", "upholding", "--candidates", "4", "--json", "-", folder=tmp_path)
        assert solved.returncode == 0, solved.stderr
        found = json.loads(solved.stdout)
        assert "Traceback" not in solved.stderr and found
    ran = call(newest, "run", "upholding", "--candidates", "2", "--quick", "--out", "run", folder=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert json.loads((tmp_path / "run" / "run.json").read_text("utf-8"))["complete"] is True
