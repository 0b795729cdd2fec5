"""What several folders of tests share."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def shared_facts() -> Path:
    """The folder of published facts, which lies beside a checkout and not in it."""
    beside = Path(__file__).resolve().parents[2] / "shared"
    folder = Path(os.environ.get("HOLDFAST_SHARED") or beside) / "facts"
    if not folder.is_dir():
        pytest.skip(f"the published facts are not here ({folder}); HOLDFAST_SHARED names their folder")
    return folder


@pytest.fixture(autouse=True, scope="session")
def _cache_of_its_own(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Convex pieces are computed by the code under test, never found in the user's cache."""
    os.environ["HOLDFAST_CACHE"] = str(tmp_path_factory.mktemp("cache"))
