"""What the tests of hands share."""

import os
import shutil
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
EXAMPLES = REPOSITORY / "examples" / "hands"


@pytest.fixture(scope="session")
def public_hands(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The hand files of the examples, each beside a copy of its model (megabytes of meshes), by name."""
    models = Path(os.environ.get("HOLDFAST_SHARED") or REPOSITORY.parent / "shared") / "models"
    if not models.is_dir():
        pytest.skip(f"the models of public hands are not here ({models}); HOLDFAST_SHARED names their folder")
    folder = tmp_path_factory.mktemp("public_hands")
    hands = {}
    for name in ("allegro", "leap"):
        source = models / f"{name}_hand"
        target = folder / name
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("visual"))
        hands[name] = Path(shutil.copy(EXAMPLES / f"{name}_right.yaml", target))
    return hands
