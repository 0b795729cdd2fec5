"""COLLADA files (.dae): what is looked at before a library builds what they describe, and their triangles.

The unit that a file states is applied. Its up axis is not, as is usual in robotics: a link's mesh stands in
the link's frame whatever a drawing program takes for up.
"""

import warnings
from importlib.util import find_spec
from io import BytesIO
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np
import trimesh

from .xml_file import parse_xml

__all__ = ["check_collada", "read_collada"]

_LARGEST_UNIT_M = 1e4


def check_collada(data: bytes, *, largest: int) -> None:
    """Counts the triangles of a file with all copies of them, which few lines can multiply without end.

    Args:
        data: the file.
        largest: how many triangles it may describe.

    Raises:
        ValueError: saying what is wrong.
    """
    try:
        _Expansion(parse_xml(data), 3 * largest).check()
    except (expat.ExpatError, RecursionError) as error:
        raise ValueError(f"it is no COLLADA file: {error}") from None


def read_collada(data: bytes) -> trimesh.Trimesh:
    """The triangles of a file that `check_collada` has passed, in m.

    Raises:
        ImportError: the package pycollada is not installed; the message says what to do.
        ValueError: a unit that is none, or a scene without the shapes. Others of `READER_ERRORS` come from
            the library.
    """
    if find_spec("collada") is None:  # an extra: only files of this format need it
        raise ImportError(
            "reading .dae needs the package pycollada: pip install 'holdfast[dae]', or export it as .obj"
        )
    root = parse_xml(data)
    units = [element for element in root.iter() if _tag(element) == "unit"]
    unit_m = float(units[0].get("meter", "1")) if units else 1.0
    if not 0.0 < unit_m <= _LARGEST_UNIT_M:
        raise ValueError(f"its unit is {unit_m:g} m")
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        # From memory and without a resolver, so that no other file is found by what this one says.
        mesh = trimesh.load_scene(BytesIO(data), file_type="dae", process=False).to_mesh()
    if not len(mesh.faces) and any(_tag(element) == "geometry" for element in root.iter()):
        raise ValueError(
            "none of its shapes stands in its scene: they hang on bones, on cameras or materials that are "
            "missing, or on nothing; export it without animation and materials"
        )
    vertices = unit_m * np.array(mesh.vertices, dtype=float).reshape(-1, 3)
    return trimesh.Trimesh(vertices, np.array(mesh.faces, dtype=np.int64).reshape(-1, 3), process=False)


def _tag(element: ElementTree.Element) -> str:
    """The name without a prefix or namespace."""
    return element.tag.rpartition(":")[2]


class _Expansion:
    """How many indices the scene of a file comes to, with what it instances counted every time."""

    def __init__(self, root: ElementTree.Element, most: int):
        self._root, self._most = root, most
        self._by_id = {element.get("id", ""): element for element in root.iter()}
        self._known: dict[ElementTree.Element, int | None] = {}

    def check(self) -> None:
        """Raises ValueError where there are too many, or where nodes hang on each other in a circle."""
        placed = sum(self._count(scene) for scene in self._root.iter() if _tag(scene) == "visual_scene")
        written = sum(self._indices(element) for element in self._root.iter() if _tag(element) == "geometry")
        if max(placed, written) > self._most:
            raise ValueError(f"it describes more than {self._most // 3} triangles")

    def _count(self, element: ElementTree.Element) -> int:
        """Indices below a scene or node."""
        if element in self._known:
            known = self._known[element]
            if known is None:
                raise ValueError("nodes hang on each other in a circle")
            return known
        self._known[element] = None
        total = 0
        for child in element:
            target = self._by_id.get(child.get("url", "").removeprefix("#"))
            if _tag(child) == "node":
                total += self._count(child)
            elif _tag(child) == "instance_node" and target is not None:
                total += self._count(target)
            elif _tag(child) == "instance_geometry" and target is not None:
                total += self._indices(target)
        # An empty copy takes its time as well.
        self._known[element] = total = total + 1
        return total

    @staticmethod
    def _indices(geometry: ElementTree.Element) -> int:
        return sum(len((p.text or "").split()) for p in geometry.iter() if _tag(p) == "p")
