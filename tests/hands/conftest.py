"""What the tests of hands share."""

import shutil
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "hands"


@pytest.fixture(scope="session")
def public_hands(shared_facts: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The hand files of the examples, each beside a copy of its model, by name."""
    models = shared_facts.parent / "models"
    if not models.is_dir():
        pytest.skip(f"the models of public hands are not here ({models})")
    folder = tmp_path_factory.mktemp("public_hands")
    hands = {}
    for name in ("allegro", "leap"):
        source = models / f"{name}_hand"
        target = folder / name
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("visual"))
        hands[name] = Path(shutil.copy(EXAMPLES / f"{name}_right.yaml", target))
    return hands
