"""A mesh and drafts of tasks on it."""

import argparse
from pathlib import Path

import pytest
import trimesh
from holdfast.pipeline.cli.commands.pictures.edit import opened
from holdfast.pipeline.edit import Draft, EditSource


def asked(name: str | Path, **options: object) -> argparse.Namespace:
    """Arguments of `holdfast edit`."""
    given: dict[str, object] = dict.fromkeys(("hand", "mass", "friction", "scale", "units", "save"))
    return argparse.Namespace(command="edit", name=str(name), **{**given, **options})


@pytest.fixture
def block(tmp_path: Path) -> Path:
    """A mesh: a bar with its middle at the origin."""
    path = tmp_path / "block.stl"
    trimesh.creation.box((0.03, 0.1, 0.02)).export(path)
    return path


@pytest.fixture
def of_block(block: Path) -> tuple[Draft, EditSource]:
    draft, source, _ = opened(asked(block))
    return draft, source
