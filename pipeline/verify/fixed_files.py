"""The certified grasps that were found, in the format in which the given ones came."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...files import write_bytes
from ...geometry import invert
from ..exports import PlacedGrasp, acronym_bytes, dexgraspbench_bytes, graspgen_bytes, isaac_grasp_bytes
from .verify import Verification, Verified

__all__ = ["write_fixed"]

_WHOLE = {
    "isaac_grasp": (isaac_grasp_bytes, ".yaml"),
    "graspgen": (graspgen_bytes, ".json"),
    "acronym": (acronym_bytes, ".h5"),
}
_EACH = "dexgraspbench"
_OTHERWISE = "isaac_grasp"


def write_fixed(verification: Verification, folder: Path) -> list[Path]:
    """Writes the certified grasps of each format into files of a folder, and says which.

    Formats that can't be written become isaac_grasp. Joints that hold are those of the test `holdfast`.
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
    if name == _EACH:
        paths = [folder / f"fixed_{grasp.name}.npy" for grasp in placed]
        for path, grasp in zip(paths, placed, strict=True):
            write_bytes(path, dexgraspbench_bytes(grasp))
        return paths
    to_bytes, suffix = _WHOLE.get(name, _WHOLE[_OTHERWISE])
    path = folder / f"fixed_{name}{suffix}"
    write_bytes(path, to_bytes(placed))
    return [path]


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
