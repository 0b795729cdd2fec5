"""The files of one model: where they may lie, and how much they may hold together.

MuJoCo would follow any path that a model names. So each path is checked here, whichever file of the model
names it, and what is included many times is counted each time.
"""

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path
from xml.parsers.expat import ExpatError

from ....base.files.file_paths import folders_open_to, resolve_beside
from ....base.files.input_file import read_input
from ....base.files.xml_file import parse_xml
from ....errors import InputError

__all__ = ["DEEPEST", "ModelFiles"]

_LARGEST_XML_BYTES = 16 * 1024 * 1024
_LARGEST_MESH_BYTES = 128 * 1024 * 1024
# Of all files together.
_LARGEST_MODEL_BYTES = 256 * 1024 * 1024
_MOST_ELEMENTS = 200_000
_MOST_INCLUDES = 100
DEEPEST = 200
"""So many elements may stand in each other."""


@dataclass
class ModelFiles:
    """Reads the files of a model, and of those that it includes or attaches.

    Attributes:
        hand_file: the hand file, or the model itself; paths stay below the folders that are open to it.
    """

    hand_file: Path
    _others: int = 0
    _elements: int = 0
    _size_bytes: int = 0

    def below(self, model: Path, name: str) -> Path:
        """The path that a file of the model names.

        Raises:
            InputError: it leads out of the folders that are open to the hand file.
        """
        if Path(name).is_absolute() or ":/" in name:
            raise InputError(model, "file", f"{name!r} must be a path below the folder of the hand file")
        target = resolve_beside(self.hand_file, name, f"import: {model.name}", beside=model)
        if not name:
            raise InputError(model, "file", "the name of a file is missing")
        return target

    def other(self, model: Path, name: str, tag: str) -> Path:
        """The path of a file that the file `model` includes or attaches; there may not be too many."""
        self._others += 1
        if self._others > _MOST_INCLUDES:
            raise InputError(model, tag, f"more than {_MOST_INCLUDES} files are included or attached")
        return self.below(model, name)

    def open_above(self, model: Path) -> int:
        """How many folders above that of the file `model` may be looked into."""
        folder = model.parent
        within = [open_ for open_ in folders_open_to(self.hand_file) if folder.is_relative_to(open_)]
        return max(len(folder.relative_to(open_).parts) for open_ in within)

    def parse(self, path: Path) -> ET.Element:
        """Root of an XML file that is not too large, too deep, or made to grow."""
        text = read_input(path, _LARGEST_XML_BYTES)
        self._size_bytes += len(text)
        self._elements += text.count(b"<")
        if self._size_bytes > _LARGEST_XML_BYTES or self._elements > _MOST_ELEMENTS:
            raise InputError(
                path,
                "",
                f"the model has more than {_LARGEST_XML_BYTES // 1024**2} MiB or {_MOST_ELEMENTS} elements, "
                "what it includes counted each time",
            )
        if re.search(rb"<!\s*(DOCTYPE|ENTITY)", text, re.IGNORECASE):
            raise InputError(path, "", "a document type or entities are not accepted")
        try:
            root = parse_xml(text.rstrip(b"\0"))  # some exporters end a file as C ends words
        except ExpatError as error:
            raise InputError(path, f"line {error.lineno}", f"not valid XML: {error}") from None
        except (LookupError, ValueError) as error:  # an encoding that does not exist
            raise InputError(path, "", f"not valid XML: {error}") from None
        layer, depth = [root], 0
        while layer:
            layer, depth = [child for element in layer for child in element], depth + 1
            if depth > DEEPEST:
                raise InputError(path, "", f"nested deeper than {DEEPEST} elements")
        return root

    def read_mesh(self, path: Path, model: Path) -> bytes:
        """The bytes of a mesh file that the file `model` names."""
        data = read_input(path, _LARGEST_MESH_BYTES)
        self._size_bytes += len(data)
        if self._size_bytes > _LARGEST_MODEL_BYTES:
            raise InputError(
                model, "mesh", f"the meshes take more than {_LARGEST_MODEL_BYTES // 1024**2} MiB"
            )
        return data
