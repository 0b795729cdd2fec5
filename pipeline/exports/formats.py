"""Grasp files in the formats that are written, by the names that the readers have for them."""

from collections.abc import Callable, Sequence
from pathlib import Path

from ...base.files.output_file import check_folder_target
from .acronym import acronym_bytes
from .bare import bare_bytes
from .dexgraspbench import dexgraspbench_bytes
from .dexgraspnet import dexgraspnet_bytes
from .graspgen import graspgen_bytes
from .isaac_grasp import isaac_grasp_bytes
from .multigripper import multigripper_bytes
from .placed import PlacedGrasp

__all__ = ["GRASP_FORMATS", "ONE_EACH", "grasp_files"]

_IN_ONE_FILE: dict[str, Callable[[Sequence[PlacedGrasp]], bytes]] = {
    "isaac_grasp": isaac_grasp_bytes,
    "graspgen": graspgen_bytes,
    "acronym": acronym_bytes,
    "dexgraspnet": dexgraspnet_bytes,
    "multigrippergrasp": multigripper_bytes,
    "bare": bare_bytes,
}
ONE_EACH = "dexgraspbench"
"""The format that has a file for each grasp."""

GRASP_FORMATS: dict[str, str] = {
    "isaac_grasp": ".yaml",
    "graspgen": ".json",
    "acronym": ".h5",
    "dexgraspbench": ".npy",
    "dexgraspnet": ".npy",
    "multigrippergrasp": ".json",
    "bare": ".npy",
}
"""The formats of grasp files that are written, each with how names of its files usually end."""


def grasp_files(placed: Sequence[PlacedGrasp], format_: str, out: Path) -> dict[Path, bytes]:
    """What to write, by path: one file, or of formats with a file for each grasp, and several, a folder.

    Args:
        placed: the grasps.
        format_: one of `GRASP_FORMATS`.
        out: the file, or the folder.

    Raises:
        InputError: the format can't hold these grasps, or a folder is needed where a file is.
    """
    if format_ != ONE_EACH:
        return {out: _IN_ONE_FILE[format_](placed)}
    if len(placed) == 1:
        return {out: dexgraspbench_bytes(placed[0])}
    check_folder_target(out)
    return {out / f"{i}.npy": dexgraspbench_bytes(grasp) for i, grasp in enumerate(placed)}
