"""MJCF and URDF models as text and meshes, read from below the folder of a hand file and from nowhere else.

MuJoCo would follow any path that a model names. So includes are put in place and meshes are read here, each
path checked, and the compiler gets a model in memory whose meshes have plain names. What only serves to draw
(materials, textures) is left out.
"""

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import InputError
from ..files import resolve_beside

__all__ = ["ModelText", "read_model_text"]

_LARGEST_XML_BYTES = 16 * 1024 * 1024
_LARGEST_MESH_BYTES = 128 * 1024 * 1024
_MOST_INCLUDES = 100
_DEEPEST = 200
_MESH_SUFFIXES = (".obj", ".stl", ".msh")
_SCHEMES = ("package://", "model://")
_DRAWING = ("texture", "material", "skin")


@dataclass(frozen=True)
class ModelText:
    """A model that names no file outside itself.

    Attributes:
        xml: MJCF or URDF text.
        meshes: contents of the mesh files, by the names that the text gives them.
    """

    xml: str
    meshes: dict[str, bytes]


def read_model_text(hand_file: Path, name: str) -> ModelText:
    """Reads the model that `import: name` of a hand file names.

    Raises:
        InputError: a path that leaves the hand file's folder, a file that can't be read, no MJCF or URDF.
    """
    path = resolve_beside(hand_file, name, "import")
    reader = _Reader(hand_file, path)
    root = reader.parse(path)
    if root.tag == "mujoco":
        reader.prepare_mjcf(root)
    elif root.tag == "robot":
        reader.prepare_urdf(root)
    else:
        raise InputError(
            path, "", f"neither MJCF nor URDF: its root is <{root.tag[:40]}>, not <mujoco> or <robot>"
        )
    return ModelText(ET.tostring(root, encoding="unicode"), reader.meshes)


@dataclass
class _Reader:
    """Reads the files of one model; `folder` is that of the model, paths stay below that of the hand file."""

    hand_file: Path
    path: Path
    meshes: dict[str, bytes] = field(default_factory=dict)
    _names: dict[Path, str] = field(default_factory=dict)
    _includes: int = 0

    def parse(self, path: Path) -> ET.Element:
        """Root of an XML file that is not too large, too deep, or made to grow."""
        text = _read(path, _LARGEST_XML_BYTES)
        if re.search(rb"<!\s*(DOCTYPE|ENTITY)", text, re.IGNORECASE):
            raise InputError(path, "", "a document type or entities are not accepted")
        try:
            root = ET.fromstring(text)
        except ET.ParseError as error:
            raise InputError(path, f"line {error.position[0]}", f"not valid XML: {error}") from None
        except (LookupError, ValueError) as error:  # an encoding that does not exist
            raise InputError(path, "", f"not valid XML: {error}") from None
        layer, depth = [root], 0
        while layer:
            layer, depth = [child for element in layer for child in element], depth + 1
            if depth > _DEEPEST:
                raise InputError(path, "", f"nested deeper than {_DEEPEST} elements")
        return root

    def prepare_mjcf(self, root: ET.Element) -> None:
        """Puts includes in place, names meshes plainly and drops what only serves to draw."""
        self._put_includes(root)
        _drop_drawing(root)
        folder = ""
        for compiler in root.iter("compiler"):
            folder = compiler.attrib.pop("assetdir", folder)
            folder = compiler.attrib.pop("meshdir", folder)
            for unused in ("texturedir", "strippath"):
                compiler.attrib.pop(unused, None)
        for mesh in root.iter("mesh"):
            if "file" in mesh.attrib:
                named = mesh.attrib["file"]
                mesh.attrib.setdefault("name", Path(named).stem)
                mesh.set("file", self._mesh(_joined(folder, named)))
        self._refuse_other_files(root)

    def prepare_urdf(self, root: ET.Element) -> None:
        """Names meshes plainly and asks the compiler to keep fixed links apart."""
        _drop_drawing(root)
        folder = ""
        for extension in root.findall("mujoco"):
            for compiler in extension.iter("compiler"):
                folder = compiler.get("meshdir", folder)
            root.remove(extension)
        for link in root.iter("link"):
            for visual in link.findall("visual"):  # never compiled, and often in formats that MuJoCo lacks
                link.remove(visual)
        for mesh in root.iter("mesh"):
            if "filename" in mesh.attrib:
                mesh.set("filename", self._mesh(self._in_package(mesh.attrib["filename"], folder)))
        ET.SubElement(
            ET.SubElement(root, "mujoco"), "compiler", {"fusestatic": "false", "strippath": "false"}
        )

    def _put_includes(self, element: ET.Element, depth: int = 0) -> None:
        if depth > _DEEPEST:
            raise InputError(self.path, "include", f"nested deeper than {_DEEPEST} elements")
        i = 0
        while i < len(element):
            if element[i].tag == "include":
                self._includes += 1
                if self._includes > _MOST_INCLUDES:
                    raise InputError(self.path, "include", f"more than {_MOST_INCLUDES} includes")
                element[i : i + 1] = list(self.parse(self._below(element[i].get("file", ""))))
            else:
                self._put_includes(element[i], depth + 1)
                i += 1

    def _in_package(self, name: str, folder: str) -> str:
        """A URDF mesh's path from the model's folder; a package is the folder itself or one of that name."""
        for scheme in _SCHEMES:
            if name.startswith(scheme):
                inside = name.removeprefix(scheme)
                return inside if self._below(inside).exists() else inside.partition("/")[2]
        return _joined(folder, name)

    def _mesh(self, name: str) -> str:
        """Reads a mesh file and returns the plain name under which the compiler finds it."""
        path = self._below(name)
        if path not in self._names:
            if path.suffix.lower() not in _MESH_SUFFIXES:
                known = ", ".join(_MESH_SUFFIXES)
                raise InputError(
                    self.path, "mesh", f"{name!r} is none of the kinds that MuJoCo reads: {known}"
                )
            plain = f"mesh_{len(self._names)}{path.suffix.lower()}"
            self._names[path] = plain
            self.meshes[plain] = _read(path, _LARGEST_MESH_BYTES)
        return self._names[path]

    def _below(self, name: str) -> Path:
        """A path that the model names, which must stay below the folder of the hand file."""
        if Path(name).is_absolute() or ":/" in name:
            raise InputError(self.path, "file", f"{name!r} must be a path below the folder of the hand file")
        relative = self.path.parent.relative_to(self.hand_file.resolve().parent) / name
        target = resolve_beside(self.hand_file, str(relative), f"import: {self.path.name}")
        if not name:
            raise InputError(self.path, "file", "the name of a file is missing")
        return target

    def _refuse_other_files(self, root: ET.Element) -> None:
        for element in root.iter():
            other = element.tag != "mesh" and any(name.startswith("file") for name in element.attrib)
            if other or element.tag in ("extension", "attach", "flexcomp"):
                raise InputError(self.path, element.tag, "can't be imported: write the model out without it")


def _joined(folder: str, name: str) -> str:
    """A path inside the folder of meshes that a model names; an absolute path stays as it is."""
    return str(Path(folder) / name)


def _read(path: Path, largest: int) -> bytes:
    try:
        if path.stat().st_size > largest:
            raise InputError(path, "", f"larger than {largest} bytes")
        return path.read_bytes()
    except OSError as error:
        raise InputError(path, "", error.strerror or "can't be read") from None


def _drop_drawing(root: ET.Element) -> None:
    """Removes materials, textures and skins, and the attributes that name them."""
    for element in list(root.iter()):
        element.attrib.pop("material", None)
        for child in list(element):
            if child.tag in _DRAWING:
                element.remove(child)
