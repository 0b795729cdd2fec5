"""The certified grasps that were found, in the format in which the given ones came."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ...base.files.output_file import write_bytes
from ...geometry import invert
from ..exports import GRASP_FORMATS, ONE_EACH, PlacedGrasp, grasp_files
from .verify import Verification, Verified

__all__ = ["write_fixed"]

# What grasps of a format become that can't be written.
_OTHERWISE = "isaac_grasp"


def write_fixed(verification: Verification, folder: Path) -> list[Path]:
    """Writes the certified grasps of each format into files of a folder, and says which.

    Formats that can't be written become isaac_grasp. Joints that hold are those of the test `holdfast`, and a
    file holds one object of one size.
    """
    written = []
    for name in dict.fromkeys(grasp.file.format for grasp in verification.grasps):
        grasps = [grasp for grasp in verification.grasps if grasp.file.format == name]
        placed = [
            one for k, grasp in enumerate(grasps) if (one := _placed(verification, grasp, k)) is not None
        ]
        if placed:
            written += _write(placed, name, folder)
    return written


def _write(placed: Sequence[PlacedGrasp], name: str, folder: Path) -> list[Path]:
    format_ = name if name in GRASP_FORMATS else _OTHERWISE
    files: dict[Path, bytes] = {}
    for ending, grasps in _by_file(placed, format_ == ONE_EACH, name):
        files |= grasp_files(grasps, format_, folder / f"fixed_{ending}{GRASP_FORMATS[format_]}")
    for path, data in files.items():
        write_bytes(path, data)
    return list(files)


def _by_file(
    placed: Sequence[PlacedGrasp], one_each: bool, name: str
) -> Iterator[tuple[str, list[PlacedGrasp]]]:
    """What goes into each file, with the end of its name: a file holds one object of one size."""
    if one_each:
        yield from ((grasp.name, [grasp]) for grasp in placed)
        return
    scales = sorted({grasp.scale for grasp in placed})
    for k, scale in enumerate(scales):
        ending = name if len(scales) == 1 else f"{name}_{k + 1}"
        yield ending, [grasp for grasp in placed if grasp.scale == scale]


def _placed(verification: Verification, grasp: Verified, number: int) -> PlacedGrasp | None:
    nearby = grasp.judged.nearby
    if nearby is None or nearby.grasp is None:
        return None
    configuration, squeeze = nearby.grasp.configuration, nearby.grasp.squeeze
    hand = verification.hand
    factor = verification.sized.loaded_at * _factor(verification, grasp)
    targets = hand.expand(np.asarray(squeeze.targets))
    trial = grasp.judged.nearby_trials.get("holdfast")
    return PlacedGrasp(
        f"{number:04d}",
        invert(configuration.state.T_palm_object),
        hand.name,
        verification.sized.given.name,
        float(factor.mean()),
        configuration.joints,
        squeeze=dict(zip(hand.joint_names, targets.tolist(), strict=True)),
        holds=None if trial is None else trial.held,
    )


def _factor(verification: Verification, grasp: Verified) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """What the object as it was loaded is multiplied by for a grasp."""
    base, own = verification.sized.base.mesh.extents, grasp.judged.obj.mesh.extents
    return np.asarray(own, dtype=float) / np.asarray(base, dtype=float)
