"""The object in the sizes that grasps have it in."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...base.numeric.arrays import Array
from ...objects import ObjectModel, load_object, looks_like_mesh, metres, read_mesh
from ..formats import GraspFile
from .scaled import scaled_object

__all__ = ["GivenObject", "SizedObject"]

# The longest side of what hands hold, about; a mesh whose size is open is loaded so that it comes near this.
_USUAL_M = 0.12


@dataclass(frozen=True)
class GivenObject:
    """An object as somebody names it.

    Attributes:
        name: of a built-in object or a member of a family, or the path of an object file or a mesh.
        units: of a mesh's coordinates.
        mass_kg: of a mesh.
        friction: of a mesh.
        scale: factor on a mesh's coordinates, before what files say of its size.
    """

    name: str
    units: str | None = None
    mass_kg: float | None = None
    friction: float | None = None
    scale: float = 1.0


@dataclass(eq=False)
class SizedObject:
    """An object, and copies of it in other sizes.

    Args:
        given: which object.
        files: the grasps, whose numbers beside the object say what sizes are to be expected.

    Attributes:
        base: the object as it was loaded.
        loaded_at: (3,) what its mesh was multiplied by.
    """

    given: GivenObject
    files: Sequence[GraspFile]
    base: ObjectModel = field(init=False)
    loaded_at: Array = field(init=False)

    def __post_init__(self) -> None:
        given = self.given
        factor = self._factor() if looks_like_mesh(given.name) else 1.0
        scale = factor * given.scale
        self.loaded_at = np.full(3, factor)
        self.base = load_object(
            given.name,
            mass_kg=given.mass_kg,
            friction=given.friction,
            scale=None if scale == 1.0 else scale,
            units=given.units,
            source="verify",
            field="--object",
        )
        self._sizes: dict[tuple[float, ...], ObjectModel] = {}

    def of_size(self, factor: Array) -> ObjectModel:
        """The object with its coordinates multiplied by `factor` (3,) again."""
        key = tuple(factor.tolist())
        if key not in self._sizes:
            keeps = self.given.mass_kg is not None
            self._sizes[key] = scaled_object(self.base, factor, keeps_mass=keeps)
        return self._sizes[key]

    def _factor(self) -> float:
        """What to load a mesh at: 1, or where numbers stand beside the object, what makes its size usual."""
        written = [grasp.object.scale for file in self.files for grasp in file.grasps]
        if all(scale is None or set(scale) == {1.0} for scale in written):
            return 1.0
        mesh, _ = read_mesh(Path(self.given.name), "verify", "--object")
        longest_m = float(np.max(mesh.extents)) * metres(self.given.scale, self.given.units)
        # A power of two, so that coordinates are multiplied exactly, and the same for all files of an object.
        return float(2.0 ** np.round(np.log2(_USUAL_M / longest_m)))
