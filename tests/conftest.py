"""What several folders of tests share."""

import json
import os
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture(scope="session")
def published_data() -> Path:
    """The folder of published figures; its README names their sources."""
    return Path(__file__).resolve().parent / "data"


@pytest.fixture(scope="session")
def published_tasks(published_data: Path) -> list[dict[str, Any]]:
    """The seven tasks of the paper whose numbers were published, in millimetres and degrees."""
    tasks: list[dict[str, Any]] = json.loads((published_data / "paper_tasks.json").read_text("utf-8"))[
        "tasks"
    ]
    return tasks


@pytest.fixture(autouse=True, scope="session")
def _cache_of_its_own(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Convex pieces are computed by the code under test, never found in the user's cache."""
    os.environ["HOLDFAST_CACHE"] = str(tmp_path_factory.mktemp("cache"))
